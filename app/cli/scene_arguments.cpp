#include "cli/scene_arguments.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/trust.h"

namespace relevo::cli {

void OverlayArguments::add_to(CLI::App& verb) {
    verb.add_option("--overlay", file,
                    "Raster to show on the ground in true colours, with a legend: from relevo sun, "
                    "or any that GDAL reads")
        ->group("Overlay");
    verb.add_option("--overlay-band", band, "Band of the overlay, from 1")
        ->check(whole_number())
        ->check(CLI::PositiveNumber)
        ->group("Overlay");
    verb.add_option(
            "--overlay-colours", colours,
            "Colours of the overlay: sun, shade, steel, viridis, inferno, grey, or the path of a "
            "gdaldem colour file (with a slash or a dot); default: by the kind of band")
        ->group("Overlay");
    verb.add_option(
            "--overlay-range", range,
            "Values of the first and the last colour, LOW,HIGH; default: the raster's range")
        ->group("Overlay");
    verb.add_option("--overlay-opacity", opacity, "Opacity of the overlay, 0 to 1 (1)")
        ->check(in_range(0.0, 1.0))
        ->group("Overlay");
    verb.add_option("--overlay-title", title, "Title of the legend; default: the band's name")
        ->group("Overlay");
}

void OverlayArguments::apply_to(scene::Scene& scene) const {
    if (!file.empty()) scene.overlay = scene::Overlay{.file = file};
    const bool more = band || opacity || !colours.empty() || !range.empty() || !title.empty();
    if (more && !scene.overlay)
        bad_usage("--overlay: missing; its colours, range, band, opacity and title need it");
    if (band) scene.overlay->band = *band;
    if (opacity) scene.overlay->opacity = *opacity;
    if (!colours.empty()) scene.overlay->colours = colours;
    if (!title.empty()) scene.overlay->title = printable(title);
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

void StampArguments::add_to(CLI::App& verb) {
    verb.add_option("--stamp", stamps,
                    "Annotations: a list of title, scale, north, graticule, date, sun, "
                    "attribution; or all, none")
        ->group("Stamps");
    verb.add_option("--title", title, "Title on the picture; default: the DEM's name")
        ->group("Stamps");
    verb.add_option("--attribution", attribution, "Attribution of the data on the picture")
        ->group("Stamps");
    verb.add_flag("--no-legend", no_legend, "Draw no legend")->group("Stamps");
}

void StampArguments::apply_to(scene::Stamps& result) const {
    if (!title.empty()) result.title_text = printable(title);
    if (!attribution.empty()) result.attribution_text = printable(attribution);
    if (!stamps.empty()) {
        try {
            scene::show_stamps(split(stamps, ','), "--stamp", result);
        } catch (const Error& error) {
            bad_usage(error.what());
        }
    }
    if (!title.empty()) result.title = true;
    if (!attribution.empty()) result.attribution = true;
    if (no_legend) result.legend = false;
    if (result.attribution && result.attribution_text.empty())
        bad_usage("--stamp: attribution: its text is missing; add --attribution TEXT");
}

void SceneArguments::add_to(CLI::App& verb, bool with_file) {
    dem.add_to(verb);
    verb.add_option(
            "--holes", holes,
            "How voids in the DEM are drawn: fill (filled, wide ones covered in grey, those "
            "at the edge cut out), cut (all cut out), mark (filled and painted) (fill)")
        ->check(CLI::IsMember({"fill", "cut", "mark"}));
    verb.add_option("--size", size, "Width and height in pixels, 1280x1024");
    if (with_file)
        verb.add_option_function<std::string>(
            "--scene",
            [this](const std::string& path) {
                file = path;
                dem.dem_option->required(false);
            },
            "Scene to draw, a file of --save-scene; other options override it");
    verb.add_flag("--trust", trust,
                  "Use plugin folders and names on the net that a scene, job or picture names");
    time.add_to(verb);
    refraction.add_to(verb);
    view.add_to(verb);
    effects.add_to(verb);
    overlay.add_to(verb);
    stamps.add_to(verb);
    verb.add_option("--exposure", exposure_ev, "Brighter than the default by this many stops, EV")
        ->check(in_range(-20.0, 20.0));
    verb.add_option("--pixel-error", pixel_error,
                    "Largest error of the drawn surface, pixels; 0 draws every post")
        ->check(in_range(0.0, 100.0));
}

scene::Scene SceneArguments::scene() const {
    scene::Scene result;
    if (!file.empty()) result = scene::read_scene(file);
    apply_to(result);
    Trust trusted(*this, "scene: " + printable(file), NamedBy::File);
    trusted.check_names(result);
    trusted.keep_folders(result.effects);
    trusted.tell();
    return result;
}

void SceneArguments::apply_to(scene::Scene& result) const {
    dem.apply_to(result);
    if (time.given()) result.moment = time.moment();
    if (refraction.given()) result.refraction = refraction.name();
    view.apply_to(result);
    effects.apply_to(result.effects);
    overlay.apply_to(result);
    stamps.apply_to(result.stamps);
    if (!holes.empty()) result.holes = dem::parse_holes(holes, "--holes");
    if (!size.empty()) {
        const glm::ivec2 sides = parse_size(size);
        result.width_px = sides.x;
        result.height_px = sides.y;
    }
    if (exposure_ev) result.exposure_ev = *exposure_ev;
    if (pixel_error) result.pixel_error = *pixel_error;
}

}  // namespace relevo::cli
