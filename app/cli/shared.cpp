#include "cli/shared.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/geodetic.h"

namespace relevo::cli {

void DemArguments::add_to(CLI::App& verb) {
    dem_option = verb.add_option("DEM", paths,
                                 "Elevation rasters that GDAL opens; several files are one DEM");
    dem_option->required();
    verb.add_option("--crs", options.crs,
                    "Coordinate reference system instead of the file's (EPSG:n, WKT)")
        ->group("DEM");
    verb.add_option("--band", options.band, "Band that holds the heights, from 1")
        ->check(whole_number())
        ->check(in_range(1, std::numeric_limits<int>::max()))
        ->group("DEM");
    verb.add_option("--unit", options.unit, "Unit of the heights: m, ft, us-ft, cm, mm, dm, km")
        ->group("DEM");
    verb.add_option_function<std::string>(
            "--nodata",
            [this](const std::string& text) {
                const std::optional<double> value = parse_number(text);
                options.no_nodata = text == "none" || text == "nan";  // NaN is a hole always
                if (!value && !options.no_nodata)
                    bad_usage(
                        fmt::format("--nodata: expected a number or none but got \"{}\"", text));
                options.nodata = value;
            },
            "Stored value that marks voids; none: no value does")
        ->group("DEM");
    verb.add_option_function<std::string>(
            "--encoding",
            [this](const std::string& text) {
                options.encoding = dem::parse_encoding(text, "--encoding");
            },
            "Heights encoded as colours: terrain-rgb, terrarium")
        ->group("DEM");
    verb.add_option_function<std::string>(
            "--bounds",
            [this](const std::string& text) {
                options.bounds = dem::parse_bounds(text, "--bounds");
            },
            "Edges of the raster, W,S,E,N in degrees, instead of its georeference")
        ->group("DEM");
    verb.add_option_function<int>(
            "--memory", [this](int mib) { options.max_posts = dem::posts_in_mib(mib); },
            "MiB of heights in memory; a larger DEM is averaged in memory and read from the file "
            "near the camera (1024)")
        ->check(whole_number())
        ->check(in_range(1, 1 << 20))
        ->group("DEM");
}

void DemArguments::apply_to(scene::Scene& scene) const {
    if (!paths.empty()) scene.dems = paths;
    const dem::LoadOptions otherwise;
    dem::LoadOptions& to = scene.dem;
    if (!options.crs.empty()) to.crs = options.crs;
    if (options.band > 0) to.band = options.band;
    if (!options.unit.empty()) to.unit = options.unit;
    if (options.nodata || options.no_nodata) {
        to.nodata = options.nodata;
        to.no_nodata = options.no_nodata;
    }
    if (options.encoding != otherwise.encoding) to.encoding = options.encoding;
    if (options.bounds) to.bounds = options.bounds;
    if (options.max_posts != otherwise.max_posts) to.max_posts = options.max_posts;
}

void TimeArguments::add_to(CLI::App& verb) {
    verb.add_option("--time", time,
                    "Time: 2026-06-21T18:30+02:00, or without offset, in --tz; or an event with "
                    "--date: sunset-30min, sunrise@46.55,8.56");
    verb.add_option("--date", date, "Day of the event in --time: 2026-06-21");
    verb.add_option("--tz", zone,
                    "Time zone: Europe/Zurich, +05:30, solar, or auto, that of the place (auto)");
}

bool TimeArguments::given() const {
    if (time.empty() && !date.empty())
        bad_usage(
            fmt::format("--date: needs an event in --time, such as sunrise@46.55,8.56; write a "
                        "time of day as --time {}T18:30",
                        date));
    if (time.empty() && !zone.empty())
        bad_usage("--tz: needs --time, such as --time 2026-06-21T18:30");
    return !time.empty();
}

void RefractionArguments::add_to(CLI::App& verb) {
    option = verb.add_option("--refraction", model,
                             "Refraction of the sun: standard (integrated ICAO atmosphere), "
                             "saemundsson (as JPL Horizons), none")
                 ->check(CLI::IsMember({"standard", "saemundsson", "none"}));
    verb.add_flag("--no-refraction", off, "Same as --refraction none");
}

void ViewArguments::add_to(CLI::App& verb) {
    verb.add_option("--view", view,
                    "Camera as seen from the DEM's centre: az=210,el=30,zoom=1, or top, north, "
                    "north-east, ...; default: where relief shows best")
        ->group("View");
    verb.add_option("--eye", eye,
                    "Camera at LAT,LON[,H]; H in metres, with suffix agl above the ground")
        ->group("View");
    verb.add_option("--look-at", look_at, "Place at the centre of the picture, LAT,LON[,H]")
        ->group("View");
    verb.add_option("--heading", heading_deg,
                    "Viewing direction from --eye, degrees clockwise from true north")
        ->check(any_number())
        ->group("View");
    verb.add_option("--pitch", pitch_deg, "Viewing direction above the horizontal, degrees")
        ->check(in_range(-90.0, 90.0))
        ->group("View");
    verb.add_option("--fov", fov_deg, "Vertical field of view, degrees (40)")
        ->check(in_range(0.1, 170.0))
        ->group("View");
    verb.add_option("--focal-length", focal_length_mm,
                    "Focal length instead of --fov, mm on 35 mm film")
        ->check(in_range(1.0, 10000.0))
        ->group("View");
    verb.add_option("--exaggerate", exaggeration, "Vertical exaggeration")
        ->check(in_range(0.01, 1000.0))
        ->group("View");
}

void ViewArguments::apply_to(scene::Scene& scene) const {
    scene::View& result = scene.view;
    if (!view.empty() && !eye.empty()) bad_usage("--view and --eye exclude each other; use one");
    if (eye.empty() && !scene.view.eye && (!look_at.empty() || heading_deg || pitch_deg))
        bad_usage("--look-at, --heading and --pitch need --eye");
    if (!look_at.empty() && (heading_deg || pitch_deg))
        bad_usage("--look-at and --heading or --pitch exclude each other; use one");
    if (fov_deg && focal_length_mm)
        bad_usage("--fov and --focal-length exclude each other; use one");
    if (!view.empty() || !eye.empty()) {
        const scene::View before = result;
        result = {};
        result.fov_y_rad = before.fov_y_rad;
        result.focal_length_mm = before.focal_length_mm;
    }
    if (!view.empty()) {
        const scene::View asked = scene::parse_view(view);
        result.orbit = asked.orbit;
        // A scene's own lens stays.
        if (result.fov_y_rad == 0 && result.focal_length_mm == 0)
            result.fov_y_rad = asked.fov_y_rad;
    }
    const auto standpoint = [](const std::string& text, const char* option, double height_agl_m) {
        const geo::PlaceText parsed = geo::parse_place(text, option);
        scene::Standpoint at{parsed.place, parsed.above_ground};
        if (!parsed.has_height) {
            at.place.height_m = height_agl_m;
            at.above_ground = true;
        }
        return at;
    };
    if (!eye.empty()) result.eye = standpoint(eye, "--eye", scene::kEyeHeight_m);
    if (!look_at.empty()) result.look_at = standpoint(look_at, "--look-at", 0);
    if (heading_deg || pitch_deg) result.look_at.reset();
    if (heading_deg) result.heading_deg = scene::within_a_turn_deg(*heading_deg);
    if (pitch_deg) result.pitch_deg = *pitch_deg;
    if (fov_deg || focal_length_mm) {
        result.fov_y_rad = radians(fov_deg.value_or(0));
        result.focal_length_mm = focal_length_mm.value_or(0);
    }
    if (exaggeration) scene.exaggeration = *exaggeration;
}

CLI::Validator in_range(double min, double max) {
    return {[min, max](const std::string& text) {
                const std::optional<double> value = parse_number(text);
                return value && *value >= min && *value <= max
                           ? std::string()
                           : fmt::format("expected {:.10g} to {:.10g} but got {}", min, max, text);
            },
            fmt::format("{:.10g} to {:.10g}", min, max)};
}

CLI::Validator any_number() {
    return {[](const std::string& text) {
                return parse_number(text) ? std::string()
                                          : fmt::format("expected a number but got {}", text);
            },
            ""};
}

CLI::Validator whole_number() {
    return {[](const std::string& text) {
                int value = 0;
                const char* const end = text.data() + text.size();
                const auto [last, error] = std::from_chars(text.data(), end, value);
                return error == std::errc{} && last == end
                           ? std::string()
                           : fmt::format("expected a whole number{} but got {}",
                                         error == std::errc::result_out_of_range && last == end
                                             ? fmt::format(" of at most {}",
                                                           std::numeric_limits<int>::max())
                                             : "",
                                         text);
            },
            ""};
}

std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

glm::ivec2 parse_size(const std::string& text) {
    const std::vector<std::string> pieces = split(text, 'x');
    if (pieces.size() == 2) {
        const auto width = parse_number(pieces[0]), height = parse_number(pieces[1]);
        if (width && height && *width == std::floor(*width) && *height == std::floor(*height) &&
            *width >= 1 && *height >= 1 && *width <= scene::kMaxSide_px &&
            *height <= scene::kMaxSide_px)
            return {static_cast<int>(*width), static_cast<int>(*height)};
    }
    bad_usage(fmt::format(
        "--size: expected WIDTHxHEIGHT such as 1920x1080, each 1 to 16384, but got \"{}\"", text));
}

}  // namespace relevo::cli
