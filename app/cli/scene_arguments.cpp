#include "cli/scene_arguments.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/panorama.h"

namespace relevo::cli {

void OverlayArguments::add_to(Verb verb) {
    verb.add_option("--overlay", file,
                    "Raster to show on the ground: figures with a legend, from relevo sun or any "
                    "raster that GDAL reads; an image of red, green and blue in its own colours")
        .group("Overlay");
    verb.add_option(
            "--overlay-colours", colours,
            "Colours of the overlay: sun, shade, steel, viridis, inferno, grey, or the path of a "
            "gdaldem colour file (with a slash or a dot); default: by the kind of band")
        .group("Overlay");
    verb.add_option(
            "--overlay-range", range,
            "Values of the first and the last colour, LOW,HIGH; default: the raster's range")
        .group("Overlay");
}

void OverlayArguments::apply_to(scene::Scene& scene, bool more) const {
    if (!file.empty()) scene.overlay = scene::Overlay{.file = file};
    if ((more || !colours.empty() || !range.empty()) && !scene.overlay)
        bad_usage("--overlay: missing; its colours, range, band, opacity, light and title need it");
    if (!colours.empty()) scene.overlay->colours = colours;
    if (range.empty()) return;
    const std::vector<std::string> ends = split(range, ',');
    const std::optional<double> low = ends.size() == 2 ? parse_number(ends[0]) : std::nullopt,
                                high = ends.size() == 2 ? parse_number(ends[1]) : std::nullopt;
    if (!low || !high || !(*high > *low))
        bad_usage(
            fmt::format("--overlay-range: {}: expected LOW,HIGH with LOW below HIGH, such as 0,14",
                        printable(range)));
    scene.overlay->range = {*low, *high};
}

void SceneArguments::add_to(Verb verb, bool with_file) {
    dem.add_to(verb);
    verb.add_option("--size", size, "Width and height in pixels, 1280x720");
    if (with_file)
        verb.add_option_function(
            "--scene",
            [this](const std::string& path) {
                file = path;
                dem.dem_option.required(false);
            },
            "Scene to draw, a file of --save-scene; other options override it");
    verb.add_flag("--trust", trust,
                  "Use plugin folders, names on the net and outputs elsewhere that a scene, job or "
                  "picture names");
    time.add_to(verb);
    refraction.add_to(verb);
    view.add_to(verb);
    effects.add_to(verb);
    overlay.add_to(verb);
    verb.add_option("--stamp", stamps,
                    "Annotations: a list of title, scale, north, graticule, date, sun, "
                    "exaggeration, attribution; or all, none")
        .group("Stamps");
    // The others have added theirs.
    for (const scene::Option& option : scene::options())
        if (!verb.has_option(std::string(option.flag))) values.add_to(verb, option);
}

session::Named SceneArguments::named() const {
    return {.all = trust, .plugin_folders = effects.plugin_path};
}

scene::Scene SceneArguments::scene() const {
    scene::Scene result;
    if (!file.empty()) result = scene::read_scene(file);
    apply_to(result);
    session::Trust trusted(named(), "scene: " + printable(file), session::NamedBy::File);
    trusted.check_names(result);
    trusted.keep_folders(result.effects);
    trusted.tell();
    return result;
}

void SceneArguments::apply_to(scene::Scene& result) const {
    effects.check_files(dem.paths);
    dem.apply_to(result);
    if (time.given()) result.time = time.spec();
    if (refraction.given()) result.refraction = refraction.name();
    view.apply_to(result);
    effects.apply_to(result.effects);
    overlay.apply_to(result, values.has_any("overlay"));
    if (values.has("--fov") && values.has("--focal-length"))
        bad_usage("--fov and --focal-length exclude each other; use one");
    values.apply_to(result);
    check_map(result);
    apply_stamps_to(result.stamps);
    apply_size_to(result);
}

void SceneArguments::apply_size_to(scene::Scene& result) const {
    const bool panorama = result.view.panorama != scene::Panorama::None;
    const bool lens = values.has("--fov") || values.has("--focal-length");
    if (panorama && lens && !size.empty())
        bad_usage(
            "--fov and --size: a panorama has square pixels, so use one; --hfov is its width");
    glm::ivec2 sides(result.width_px, result.height_px);
    if (!size.empty()) {
        result.resolution = 0;
        sides = parse_size(size);
    } else if (panorama && (lens || values.has("--panorama") || values.has("--hfov"))) {
        sides = scene::default_panorama_px(result.view);
    }
    result.width_px = sides.x;
    result.height_px = sides.y;
}

void SceneArguments::check_map(const scene::Scene& result) const {
    if (values.has("--resolution") && !size.empty())
        bad_usage("--resolution and --size exclude each other; use one");
    if (values.has("--sheet") && !size.empty())
        bad_usage("--sheet and --size exclude each other; --dpi sets the pixels of a sheet");
    if (result.sheet.is_on() && view.any() && !scene::is_from_above(result.view))
        bad_usage("--sheet: a map is seen from straight above; use --view top, or none");
    if (result.ortho && !result.sheet.is_on() && view.any())
        bad_usage(
            "--ortho and the camera of --view, --eye, --look-at, --heading or --pitch exclude each "
            "other; --view top is a picture from above that has a camera");
}

void SceneArguments::apply_stamps_to(scene::Stamps& result) const {
    const std::string shown = stamps.empty() && values.has("--sheet") ? "all" : stamps;
    if (!shown.empty()) {
        try {
            scene::show_stamps(split(shown, ','), "--stamp", result);
        } catch (const Error& error) {
            bad_usage(error.what());
        }
    }
    if (values.has("--title")) result.title = true;
    if (values.has("--attribution")) result.attribution = true;
    if (result.attribution && result.attribution_text.empty())
        bad_usage("--stamp: attribution: its text is missing; add --attribution TEXT");
}

}  // namespace relevo::cli
