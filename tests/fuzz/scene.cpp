#include "scene/scene.h"

#include <stdexcept>
#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kScene("scene", [](std::string_view bytes) {
    const scene::Scene scene = scene::read_scene_text(std::string(bytes), "scene.json", folder());
    const std::string written = scene::scene_text(scene, folder());
    try {
        scene::read_scene_text(written, "scene.json", folder());
    } catch (const Error& error) {
        throw std::logic_error("a scene as it was written cannot be read: " +
                               std::string(error.what()));
    }
});

}  // namespace relevo::fuzz
