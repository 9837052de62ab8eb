#include "cli/scene_arguments.h"

namespace relevo::cli {

void SceneArguments::add_to(CLI::App& verb, bool with_file) {
    dem.add_to(verb);
    verb.add_option("--size", size, "Width and height in pixels, 1280x1024");
    if (with_file)
        verb.add_option_function<std::string>(
            "--scene",
            [this](const std::string& path) {
                file = path;
                dem.dem_option->required(false);
            },
            "Scene to draw, a file of --save-scene; other options replace what it says");
    time.add_to(verb);
    refraction.add_to(verb);
    view.add_to(verb);
    effects.add_to(verb);
    verb.add_option("--exposure", exposure_ev, "Stops brighter than natural, EV")
        ->check(in_range(-20.0, 20.0));
    verb.add_option("--pixel-error", pixel_error,
                    "Largest error of the ground's shape in the picture, pixels; 0 draws every "
                    "post")
        ->check(in_range(0.0, 100.0));
}

scene::Scene SceneArguments::scene() const {
    scene::Scene result;
    if (!file.empty()) result = scene::read_scene(file);
    apply_to(result);
    return result;
}

void SceneArguments::apply_to(scene::Scene& result) const {
    dem.apply_to(result);
    if (time.given()) result.moment = time.moment();
    if (refraction.given()) result.refraction = refraction.name();
    view.apply_to(result);
    effects.apply_to(result.effects);
    if (!size.empty()) {
        const glm::ivec2 sides = parse_size(size);
        result.width_px = sides.x;
        result.height_px = sides.y;
    }
    if (exposure_ev) result.exposure_ev = *exposure_ev;
    if (pixel_error) result.pixel_error = *pixel_error;
}

}  // namespace relevo::cli
