#include "session/picture_file.h"

namespace relevo::session {

void write_picture(Session& session, const std::optional<image::Picture>& picture, OutputFile& file,
                   const image::Metadata& metadata, const image::Encoding& encoding) {
    if (picture) return image::write(file, *picture, metadata, encoding);
    const scene::Scene& scene = session.scene();
    image::BandWriter writer(
        file,
        {.width_px = scene.width_px, .height_px = scene.height_px, .alpha = scene.transparent},
        metadata, encoding);
    session.make_bands([&](const image::Picture& band) { writer.write(band); });
    writer.end();
}

}  // namespace relevo::session
