#include "session/picture_file.h"

#include <system_error>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "scene/map_view.h"
#include "scene/sheet.h"

namespace relevo::session {

std::optional<output::Georeference> georeference_of(const Session& session) {
    const auto& map = session.camera().map;
    if (!map) return std::nullopt;
    scene::MapArea area = map->area();
    const glm::dvec2 margin(session.map_corner_px());
    area.left -= margin.x * area.pixel_x;
    area.top += margin.y * area.pixel_y;
    return output::Georeference{area.geotransform(), map->grid().crs().text()};
}

FileParts file_parts_of(const Session& session) {
    return {georeference_of(session), session.paper_sheet()};
}

std::vector<std::filesystem::path> files_beside(const scene::Scene& scene,
                                                const std::filesystem::path& picture) {
    if (!scene.ortho || scene::is_pdf(picture)) return {};
    return output::georeference_files(picture);
}

void warn_of_files_beside(const scene::Scene& scene, const std::filesystem::path& picture) {
    if (scene.ortho) return;
    for (const std::filesystem::path& path : output::georeference_files(picture)) {
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) continue;
        return log::warning(
            fmt::format("{}: belongs to another picture, and this one is no map; delete it, or GIS "
                        "programs place this one by it",
                        printable(path.string())));
    }
}

void write_picture(OutputFile& file, const image::Picture& picture, const image::Metadata& metadata,
                   const image::Encoding& encoding, const FileParts& parts) {
    if (parts.paper) {
        chart::PaperSheet paper = *parts.paper;
        if (const auto software = metadata.find("Software"); software != metadata.end())
            paper.creator = software->second;
        return chart::write_pdf(paper, image::encoded(file.path(), picture, metadata, encoding),
                                file);
    }
    const std::optional<output::Georeference>& where = parts.where;
    const bool is_tiff = encoding.format.empty()
                             ? output::holds_georeference(file.path())
                             : output::holds_georeference("picture." + encoding.format);
    if (!where || !is_tiff) return image::write(file, picture, metadata, encoding);
    output::write_geotiff(file, image::encoded(file.path(), picture, metadata, encoding), *where);
}

void write_picture(Session& session, const std::optional<image::Picture>& picture, OutputFile& file,
                   const image::Metadata& metadata, const image::Encoding& encoding) {
    if (picture) return write_picture(file, *picture, metadata, encoding, file_parts_of(session));
    const scene::Scene& scene = session.scene();
    image::BandWriter writer(
        file,
        {.width_px = scene.width_px, .height_px = scene.height_px, .alpha = scene.transparent},
        metadata, encoding);
    session.make_bands([&](const image::Picture& band) { writer.write(band); });
    writer.end();
}

void write_beside(const std::vector<OutputFile*>& beside, const output::Georeference& where) {
    if (beside.empty()) return;
    const std::vector<std::string> texts = output::georeference_texts(where);
    for (std::size_t i = 0; i < beside.size(); ++i)
        beside[i]->write(texts[i]);
}

}  // namespace relevo::session
