#include "scene/options.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "base/units.h"
#include "scene/scene_words.h"
#include "weather/metar.h"

namespace relevo::scene {
namespace {

using json::Value;
using Kind = Option::Kind;

// In the order of dem::Encoding, dem::Holes, Backdrop, Panorama and Stereo.
constexpr std::array<std::string_view, 3> kEncodings = {"none", "terrain-rgb", "terrarium"};
constexpr std::array<std::string_view, 3> kHoles = {"fill", "cut", "mark"};
constexpr std::array<std::string_view, 3> kBackdrops = {"auto", "horizon", "studio"};
constexpr std::array<std::string_view, 3> kRefractions = {"standard", "saemundsson", "none"};
constexpr std::array<std::string_view, 2> kLights = {"flat", "lit"};
constexpr std::array<std::string_view, 3> kPanoramas = {"none", "cylindrical", "equirectangular"};
constexpr std::array<std::string_view, 4> kStereos = {"none", "parallel", "cross-eyed", "anaglyph"};
constexpr std::array<std::string_view, 16> kSheets = {
    "none",         "a4", "a4-portrait", "a4-landscape", "a3", "a3-portrait",
    "a3-landscape", "a2", "a2-portrait", "a2-landscape", "a1", "a1-portrait",
    "a1-landscape", "a0", "a0-portrait", "a0-landscape"};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // in no range
constexpr double kMaxInt = std::numeric_limits<int>::max();

Value number(double value) {
    return {.kind = Value::Kind::Number, .number = value};
}
Value text(std::string_view value) {
    return {.kind = Value::Kind::String, .text = std::string(value)};
}
Value flag(bool value) {
    return {.kind = Value::Kind::Bool, .boolean = value};
}

int index_of(std::span<const std::string_view> words, const Value& word) {
    return static_cast<int>(std::ranges::find(words, word.text) - words.begin());
}

Overlay overlay_of(const Scene& scene) {
    return scene.overlay.value_or(Overlay{});
}

/// One of them is 0.
void set_lens(Scene& scene, double fov_y_rad, double focal_length_mm) {
    scene.view.fov_y_rad = fov_y_rad;
    scene.view.focal_length_mm = focal_length_mm;
}

// clang-format off
constexpr Option kOptions[] = {
    {"dem", "crs", "--crs", "DEM",
     "Coordinate reference system instead of the file's (EPSG:n, WKT)", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.dem.crs); },
     [](Scene& s, const Value& v) { s.dem.crs = v.text; }},
    {"dem", "band", "--band", "DEM",
     "Band that holds the heights, from 1", Kind::Whole, 1, kMaxInt, {},
     [](const Scene& s) { return number(s.dem.band); },
     [](Scene& s, const Value& v) { s.dem.band = static_cast<int>(v.number); }},
    {"dem", "unit", "--unit", "DEM",
     "Unit of the heights: m, ft, us-ft, cm, mm, dm, km", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.dem.unit); },
     [](Scene& s, const Value& v) { s.dem.unit = v.text; }},
    {"dem", "crop", "--crop", "DEM",
     "Only the part of the DEM within W,S,E,N in degrees", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.dem.crop); },
     [](Scene& s, const Value& v) { s.dem.crop = v.text; }},
    {"dem", "encoding", "--encoding", "DEM",
     "Heights encoded as colours", Kind::Word, 0, 0, kEncodings,
     [](const Scene& s) { return text(dem::name_of(s.dem.encoding)); },
     [](Scene& s, const Value& v) { s.dem.encoding = dem::Encoding{index_of(kEncodings, v)}; }},
    {"dem", "memory_mib", "--memory", "DEM",
     "MiB of memory above what the program takes itself (3072); a larger DEM is averaged in memory "
     "and read from the file near the camera", Kind::Whole, 1, 1 << 20, {},
     [](const Scene& s) { return number(static_cast<double>(s.dem.memory.mib())); },
     [](Scene& s, const Value& v) { s.dem.memory = MemoryBudget::of_mib(std::lround(v.number)); }},
    {"dem", "holes", "--holes", "Options",
     "How voids in the DEM are drawn: fill (filled, wide ones covered in grey, those at the edge "
     "cut out), cut (all cut out), mark (filled and painted)", Kind::Word, 0, 0, kHoles,
     [](const Scene& s) { return text(kHoles[static_cast<std::size_t>(s.holes)]); },
     [](Scene& s, const Value& v) { s.holes = dem::Holes{index_of(kHoles, v)}; }},
    {"", "land_cover", "--land-cover", "Options",
     "Map of land cover, a raster of classes: what grows where. none: the climate alone says it, and "
     "not shares of 0.05 degrees, which are the default", Kind::Text, 0, 0, {},
     [](const Scene& s) {
         return s.land_cover.climate_alone ? Value{.text = "none"} : text(s.land_cover.file);
     },
     [](Scene& s, const Value& v) {
         s.land_cover.climate_alone = v.text == "none";
         s.land_cover.file = s.land_cover.climate_alone ? "" : v.text;
     }},
    {"", "land_cover_classes", "--land-cover-classes", "Options",
     "Classes of the land cover: worldcover, nlcd, corine, or a table, CLASS,TREES,PLANTS,ICE",
     Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.land_cover.classes); },
     [](Scene& s, const Value& v) { s.land_cover.classes = v.text; }},
    {"", "surface", "--surface", "Options",
     "Heights of a surface model, posts at most 4 m apart: pictures show its roofs, walls, streets "
     "and trees, which are found by their shape", Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(s.land_cover.surface); },
     [](Scene& s, const Value& v) { s.land_cover.surface = v.boolean; }},
    {"", "refraction", "--refraction", "Options",
     "Refraction of the sun: standard (integrated ICAO atmosphere), saemundsson (as JPL Horizons), "
     "none", Kind::Word, 0, 0, kRefractions,
     [](const Scene& s) { return text(s.refraction); },
     [](Scene& s, const Value& v) { s.refraction = v.text; }},
    {"", "weather", "--weather", "Options",
     "Weather of a METAR, as text or in a file: clouds, fog, rain, snow, wind, visibility, and the air "
     "of the sun's refraction. Or a GRIB or NetCDF file with cloud cover at the picture's time",
     Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.weather.empty() ? s.forecast : s.weather); },
     [](Scene& s, const Value& v) {
         s.forecast = weather::is_forecast_file(v.text) ? v.text : "";
         s.weather = v.text.empty() || !s.forecast.empty() ? "" : weather::report_of(v.text);
         s.weather_file = s.weather.empty() || s.weather == v.text ? "" : v.text;
     }},
    {"", "station_height", "--station-height", "Options",
     "Height of the weather's station above sea level, metres, from which bases of clouds count; "
     "default: the ground in the middle of the DEM", Kind::Number, -500, 9000, {},
     [](const Scene& s) { return number(s.station_height_m.value_or(kNone)); },
     [](Scene& s, const Value& v) { s.station_height_m = v.number; }},
    {"camera", "fov", "--fov", "View",
     "Vertical field of view, degrees; 40 without it, 50 of aerial views", Kind::Number, 0.1, 170, {},
     [](const Scene& s) { return number(written_deg(s.view.fov_y_rad)); },
     [](Scene& s, const Value& v) { set_lens(s, radians(v.number), 0); }},
    {"camera", "focal_length", "--focal-length", "View",
     "Focal length instead of the field of view, mm on 35 mm film", Kind::Number, 1, 10000, {},
     [](const Scene& s) { return number(s.view.fov_y_rad > 0 ? 0 : s.view.focal_length_mm); },
     [](Scene& s, const Value& v) { set_lens(s, 0, v.number); }},
    {"camera", "backdrop", "--backdrop", "View",
     "Behind the DEM: horizon (sky and air), studio (from outside the DEM is a block on a plain backdrop), "
     "auto (horizon in aerial views, else studio)",
     Kind::Word, 0, 0, kBackdrops,
     [](const Scene& s) { return text(kBackdrops[static_cast<std::size_t>(s.backdrop)]); },
     [](Scene& s, const Value& v) { s.backdrop = static_cast<Backdrop>(index_of(kBackdrops, v)); }},
    {"camera", "panorama", "--panorama", "View",
     "Picture all around the eye: none, cylindrical, equirectangular; needs --eye", Kind::Word, 0, 0,
     kPanoramas,
     [](const Scene& s) { return text(kPanoramas[static_cast<std::size_t>(s.view.panorama)]); },
     [](Scene& s, const Value& v) { s.view.panorama = Panorama{index_of(kPanoramas, v)}; }},
    {"camera", "hfov", "--hfov", "View",
     "Horizontal field of view of a panorama, degrees", Kind::Number, 1, 360, {},
     [](const Scene& s) { return number(written_deg(s.view.hfov_rad)); },
     [](Scene& s, const Value& v) { s.view.hfov_rad = radians(v.number); }},
    {"camera", "stereo", "--stereo", "View",
     "Pair for two eyes: none, parallel or cross-eyed (side by side), anaglyph (red and cyan)",
     Kind::Word, 0, 0, kStereos,
     [](const Scene& s) { return text(kStereos[static_cast<std::size_t>(s.view.stereo)]); },
     [](Scene& s, const Value& v) { s.view.stereo = Stereo{index_of(kStereos, v)}; }},
    {"camera", "eye_distance", "--eye-distance", "View",
     "Distance between the eyes of a stereo pair, metres; default: 1/30 of that of the near ground",
     Kind::Number, 0.001, 1e6, {},
     [](const Scene& s) { return number(s.view.eye_distance_m); },
     [](Scene& s, const Value& v) { s.view.eye_distance_m = v.number; }},
    {"", "exaggeration", "--exaggerate", "View",
     "Vertical exaggeration", Kind::Number, 0.01, 1000, {},
     [](const Scene& s) { return number(s.exaggeration); },
     [](Scene& s, const Value& v) { s.exaggeration = v.number; }},
    {"overlay", "band", "--overlay-band", "Overlay",
     "Band of the overlay, from 1", Kind::Whole, 1, kMaxInt, {},
     [](const Scene& s) { return number(overlay_of(s).band); },
     [](Scene& s, const Value& v) { s.overlay->band = static_cast<int>(v.number); }},
    {"overlay", "opacity", "--overlay-opacity", "Overlay",
     "Opacity of the overlay, 0 to 1", Kind::Number, 0, 1, {},
     [](const Scene& s) { return number(overlay_of(s).opacity); },
     [](Scene& s, const Value& v) { s.overlay->opacity = v.number; }},
    {"overlay", "light", "--overlay-light", "Overlay",
     "Light of the overlay: flat (its own colours), lit (shaded by the scene's sun)", Kind::Word, 0,
     0, kLights,
     [](const Scene& s) { return text(kLights[overlay_of(s).lit ? 1 : 0]); },
     [](Scene& s, const Value& v) { s.overlay->lit = v.text == "lit"; }},
    {"overlay", "cast_shadows", "--overlay-shadows", "Overlay",
     "Cast shadows of the scene's sun also where the overlay shows sunlight of its own time",
     Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(overlay_of(s).shadows); },
     [](Scene& s, const Value& v) { s.overlay->shadows = v.boolean; }},
    {"overlay", "title", "--overlay-title", "Overlay",
     "Title of the legend; default: the band's name", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(overlay_of(s).title); },
     [](Scene& s, const Value& v) { s.overlay->title = printable(v.text); }},
    {"stamps", "legend", "--no-legend", "Stamps",
     "Legends of overlays and of coloured ground; --no-legend omits them", Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(s.stamps.legend); },
     [](Scene& s, const Value& v) { s.stamps.legend = v.boolean; }},
    {"stamps", "title", "--title", "Stamps",
     "Title on the picture; default: the largest place and the highest summit on the DEM", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.stamps.title_text); },
     [](Scene& s, const Value& v) { s.stamps.title_text = printable(v.text); }},
    {"stamps", "attribution", "--attribution", "Stamps",
     "Attribution of the data on the picture", Kind::Text, 0, 0, {},
     [](const Scene& s) { return text(s.stamps.attribution_text); },
     [](Scene& s, const Value& v) { s.stamps.attribution_text = printable(v.text); }},
    {"stamps", "margin", "--margin", "Stamps",
     "White border around the view in which legends and stamps stand, so that nothing lies on it; part "
     "of --size", Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(s.stamps.margin); },
     [](Scene& s, const Value& v) { s.stamps.margin = v.boolean; }},
    {"picture", "exposure", "--exposure", "Options",
     "Brighter than the default by this many stops, EV", Kind::Number, -20, 20, {},
     [](const Scene& s) { return number(s.exposure_ev); },
     [](Scene& s, const Value& v) { s.exposure_ev = v.number; }},
    {"picture", "ev100", "--ev100", "Options",
     "Exposure value of a camera at ISO 100, instead of one by the sun's elevation: 15 suits a sunny "
     "noon, -3 a full moon", Kind::Number, -20, 24, {},
     [](const Scene& s) { return number(s.ev100.value_or(kNone)); },
     [](Scene& s, const Value& v) { s.ev100 = v.number; }},
    {"picture", "seconds", "--seconds", "Options",
     "Time of effects that move, such as snowfall, in seconds", Kind::Number, 0, kMaxSeconds, {},
     [](const Scene& s) { return number(s.seconds); },
     [](Scene& s, const Value& v) { s.seconds = v.number; }},
    {"picture", "pixel_error", "--pixel-error", "Options",
     "Largest error of the drawn surface, pixels; 0 draws every post", Kind::Number, 0, 100, {},
     [](const Scene& s) { return number(s.pixel_error); },
     [](Scene& s, const Value& v) { s.pixel_error = v.number; }},
    {"picture", "samples", "--samples", "Options",
     "Samples of each pixel: smoother edges and fine detail in as many times the time; not in the "
     "window", Kind::Whole, 1, kMaxSamples, {},
     [](const Scene& s) { return number(s.samples); },
     [](Scene& s, const Value& v) { s.samples = static_cast<int>(v.number); }},
    {"picture", "transparent", "--transparent", "Options",
     "Sky and surroundings of the DEM are transparent; at least 8 samples of each pixel; png, webp, "
     "avif, tif, exr", Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(s.transparent); },
     [](Scene& s, const Value& v) { s.transparent = v.boolean; }},
    {"picture", "ortho", "--ortho", "Options",
     "Orthographic top view of all of the DEM that lies on its CRS: tif as GeoTIFF, the others with "
     "a world file; --size is the most that it may have; not in the window", Kind::Flag, 0, 0, {},
     [](const Scene& s) { return flag(s.ortho); },
     [](Scene& s, const Value& v) { s.ortho = v.boolean; }},
    {"picture", "resolution", "--resolution", "Options",
     "Side of a pixel of --ortho in units of the DEM's CRS, instead of --size", Kind::Number, 1e-9,
     1e9, {},
     [](const Scene& s) { return number(s.resolution); },
     [](Scene& s, const Value& v) { s.resolution = v.number; }},
    {"picture", "sheet", "--sheet", "Map sheet",
     "Map on paper with stamps around it, instead of --size: a4 to a0, which lies or stands as the DEM "
     "does, or a4-portrait, a4-landscape, ...; png, tif and jpg say its dpi; pdf has text as text", Kind::Word, 0, 0, kSheets,
     [](const Scene& s) { return text(s.sheet.is_on() ? s.sheet.paper : "none"); },
     [](Scene& s, const Value& v) {
         s.sheet.paper = v.text == "none" ? "" : v.text;
         if (s.sheet.is_on()) s.ortho = s.stamps.margin = true;
     }},
    {"picture", "map_scale", "--map-scale", "Map sheet",
     "n of the sheet's scale 1 : n at the middle of the map, 25000; cut about the middle of the DEM; "
     "default: the roundest at which all of the DEM fits", Kind::Number, 1, 1e9, {},
     [](const Scene& s) { return number(s.sheet.scale); },
     [](Scene& s, const Value& v) { s.sheet.scale = v.number; }},
    {"picture", "dpi", "--dpi", "Map sheet",
     "Pixels per inch of the sheet", Kind::Number, 20, 2400, {},
     [](const Scene& s) { return number(s.sheet.dpi); },
     [](Scene& s, const Value& v) { s.sheet.dpi = v.number; }},
};
// clang-format on

}  // namespace

std::span<const Option> options() {
    return kOptions;
}

const Option& option(std::string_view flag) {
    const auto* const found = std::ranges::find(kOptions, flag, &Option::flag);
    assert(found != std::end(kOptions));
    return *found;
}

Value value_of(const Option& option, const std::string& word) {
    const bool is_number = option.kind == Kind::Number || option.kind == Kind::Whole;
    const std::optional<double> value = is_number ? parse_number(word) : std::nullopt;
    return value ? number(*value) : text(word);
}

std::string fault_of(const Option& option, const Value& value) {
    if (option.kind == Kind::Word) {
        if (value.kind == Value::Kind::String && std::ranges::count(option.words, value.text) > 0)
            return {};
        const std::vector<std::string> words(option.words.begin(), option.words.end());
        const std::optional<std::string> near = nearest(value.text, words);
        return fmt::format("expected one of {} but got {}{}", fmt::join(words, ", "),
                           json::describe(value),
                           near ? fmt::format("; did you mean {}?", *near) : "");
    }
    if (option.kind != Kind::Number && option.kind != Kind::Whole) return {};
    const bool whole = option.kind == Kind::Whole;
    const double n = value.number;
    if (value.kind == Value::Kind::Number && n >= option.min && n <= option.max &&
        (!whole || n == std::floor(n)))
        return {};
    return fmt::format("expected a {}number in [{}, {}] but got {}", whole ? "whole " : "",
                       option.min, option.max, json::describe(value));
}

std::string text_of(const Option& option, const Scene& scene) {
    const Value value = option.get(scene);
    if (option.kind == Kind::Flag) return value.boolean ? "true" : "false";
    if (option.kind == Kind::Text || option.kind == Kind::Word) return value.text;
    return fault_of(option, value).empty() ? fmt::format("{}", value.number) : "";
}

bool is_default(const Option& option, const Scene& scene) {
    static const Scene kDefault;
    return text_of(option, scene) == text_of(option, kDefault);
}

}  // namespace relevo::scene
