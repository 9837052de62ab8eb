#include "viewer/take_away.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "image/image.h"
#include "session/overlay.h"
#include "session/record.h"
#include "viewer/settings.h"

namespace relevo::viewer {
std::string write_under_free_name(const std::string& ending,
                                  const std::function<void(OutputFile&)>& write) {
    for (int n = 1;; ++n) {
        const std::string name = fmt::format("relevo-{}.{}", n, ending);
        const auto is_taken = [&] {
            std::error_code ignored;
            return std::filesystem::exists(std::filesystem::symlink_status(name, ignored));
        };
        if (is_taken()) continue;
        try {
            OutputFile file(name, /*overwrite=*/false, "view");
            write(file);
            return name;
        } catch (const Error&) {
            // Another window may have taken the name meanwhile.
            if (!is_taken()) throw;
        }
    }
}

scene::Scene whole_scene(const Document& document, const Land& land, glm::ivec2 size_px) {
    scene::Scene scene = document.whole(land);
    scene.width_px = size_px.x;
    scene.height_px = size_px.y;
    scene.dems = absolute_names(std::move(scene.dems));
    return scene;
}

std::string save_scene(const scene::Scene& scene) {
    const std::string text = scene::scene_text(scene, "");
    const std::string name = write_under_free_name("json", [&](OutputFile& file) {
        file.write(text);
        file.finish();
    });
    return name + " has the scene; relevo view --scene opens it";
}

std::string save_picture(const Picture& picture, const scene::Scene& scene,
                         const chart::Legend* legend) {
    image::Image8 image = image::from_device(picture.width_px, picture.height_px, picture.rgba);
    if (legend) session::add_legend(*legend, image);
    const image::Metadata metadata{{"Software", "Relevo"},
                                   {"Description", capture_command(scene, "picture.png")},
                                   {session::kSceneKeyword, scene::scene_line(scene)}};
    const std::string name = write_under_free_name("png", [&](OutputFile& file) {
        image::write(file, image, metadata);
        file.finish();
    });
    return name + " has the picture";
}

}  // namespace relevo::viewer
