#include "viewer/take_away.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/output_file.h"
#include "image/image.h"
#include "viewer/settings.h"

namespace relevo::viewer {
namespace {

/// A name in the working folder that no file has: relevo-1.png.
std::string free_name(const std::string& ending) {
    for (int n = 1;; ++n) {
        const std::string name = fmt::format("relevo-{}.{}", n, ending);
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored)) return name;
    }
}

}  // namespace

scene::Scene whole_scene(const Document& document, const Land& land, glm::ivec2 size_px) {
    scene::Scene scene = document.whole(land);
    scene.width_px = size_px.x;
    scene.height_px = size_px.y;
    scene.dems = absolute_names(std::move(scene.dems));
    return scene;
}

std::string save_scene(const scene::Scene& scene) {
    const std::string name = free_name("json");
    write_text(name, scene::scene_text(scene, ""), /*overwrite=*/false, "view");
    return name + " has the scene; relevo view --scene opens it";
}

std::string save_picture(const Picture& picture, const scene::Scene& scene) {
    const std::string name = free_name("png");
    OutputFile file(name, /*overwrite=*/false, "view");
    image::write(file, image::from_device(picture.width_px, picture.height_px, picture.rgba),
                 {{"Software", "Relevo"}, {"Description", capture_command(scene, "picture.png")}});
    return name + " has the picture";
}

}  // namespace relevo::viewer
