#include "cli/shared.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "dem/files_of.h"
#include "geo/geodetic.h"

namespace relevo::cli {

std::string ResultArguments::ending() const {
    const std::string ending = lower(std::filesystem::path(path).extension().string());
    return ending.empty() ? ending : ending.substr(1);
}

void ResultArguments::check_ending() const {
    if (!contains(endings, ending()))
        bad_usage(
            fmt::format("-o: {}: no format that this command writes, expected a name that "
                        "ends in {}",
                        path, fmt::join(endings, ", ")));
}

void OptionArguments::add_to(Verb verb, const scene::Option& option) {
    using Kind = scene::Option::Kind;
    const std::string flag(option.flag), help(option.help), group(option.group);
    const scene::Scene usual;
    const auto give = [this, &option](const json::Value& value) {
        given_.emplace_back(&option, value);
    };
    if (option.kind == Kind::Flag) {
        json::Value other = option.get(usual);
        other.boolean = !other.boolean;
        verb.add_flag_callback(
                flag, [give, other] { give(other); }, help)
            .group(group);
        return;
    }
    const std::string otherwise = scene::text_of(option, usual);
    const Option added = verb.add_option_function(
        flag, [give, &option](const std::string& word) { give(scene::value_of(option, word)); },
        otherwise.empty() ? help : fmt::format("{} ({})", help, otherwise));
    added.group(group);
    if (option.kind == Kind::Text) return;
    added.type_name(option.kind == Kind::Number  ? "FLOAT"
                    : option.kind == Kind::Whole ? "INT"
                                                 : "TEXT");
    added.check({[&option](const std::string& word) {
                     return scene::fault_of(option, scene::value_of(option, word));
                 },
                 option.kind == Kind::Word ? fmt::format("{{{}}}", fmt::join(option.words, ","))
                                           : fmt::format("{} to {}", option.min, option.max)});
}

bool OptionArguments::has(std::string_view flag) const {
    return std::ranges::any_of(given_, [&](const auto& one) { return one.first->flag == flag; });
}

std::string OptionArguments::text(std::string_view flag) const {
    const auto given =
        std::ranges::find(given_, flag, [](const auto& one) { return one.first->flag; });
    return given == given_.end() ? std::string() : given->second.text;
}

bool OptionArguments::has_any(std::string_view object) const {
    return std::ranges::any_of(given_,
                               [&](const auto& one) { return one.first->object == object; });
}

void OptionArguments::apply_to(scene::Scene& scene) const {
    for (const auto& [option, value] : given_)
        option->set(scene, value);
}

void DemArguments::add_to(Verb verb) {
    dem_option = verb.add_option("DEM", paths,
                                 "Elevation rasters that GDAL opens; several files are one DEM");
    dem_option.required();
    for (const scene::Option& option : scene::options())
        if (option.group == "DEM") values.add_to(verb, option);
    verb.add_option_function(
            "--nodata",
            [this](const std::string& text) {
                nodata = parse_number(text);
                no_nodata = text == "none" || text == "nan";  // NaN is a hole always
                if (!nodata && !no_nodata)
                    bad_usage(
                        fmt::format("--nodata: expected a number or none but got \"{}\"", text));
            },
            "Stored value that marks voids; none: no value does")
        .group("DEM");
    verb.add_option_function(
            "--bounds",
            [this](const std::string& text) { bounds = dem::parse_bounds(text, "--bounds"); },
            "Edges of the raster, W,S,E,N in degrees, instead of its georeference")
        .group("DEM");
    verb.add_flag("--no-cache", no_cache,
                  "Neither use nor keep averaged levels of a large DEM (relevo cache)")
        .group("DEM");
}

void DemArguments::add_surroundings_to(Verb verb) {
    verb.add_option("--surroundings", surroundings,
                    "Wider, coarser DEM in which this one lies: its ground shades, too; may be "
                    "repeated, several are one DEM")
        .one_word()
        .needs(dem_option)
        .group("DEM");
}

void DemArguments::add_named(FilesInUse& files) const {
    dem::add_named(paths, files);
    dem::add_named(surroundings, files, "the surroundings");
}

void DemArguments::add_all(FilesInUse& files) const {
    dem::add_all(paths, files);
    dem::add_all(surroundings, files, "the surroundings");
}

void DemArguments::apply_to(scene::Scene& scene) const {
    if (!paths.empty()) scene.dems = paths;
    values.apply_to(scene);
    if (nodata || no_nodata) {
        scene.dem.nodata = nodata;
        scene.dem.no_nodata = no_nodata;
    }
    if (bounds) scene.dem.bounds = bounds;
    scene.dem.cached = !no_cache;
    scene.dem.memory.return_what_is_freed();
}

dem::LoadOptions DemArguments::options() const {
    scene::Scene scene;
    apply_to(scene);
    scene.dem.surroundings = surroundings;
    return scene.dem;
}

void TimeArguments::add_to(Verb verb) {
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

void RefractionArguments::add_to(Verb verb, sun::Body body) {
    model.add_to(verb, scene::option("--refraction"));
    if (body == sun::Body::Moon)
        verb.option("--refraction")
            .description(
                "Refraction of the moon: standard (integrated ICAO atmosphere), saemundsson (as "
                "JPL Horizons), none (standard)");
    verb.add_flag("--no-refraction", off, "Same as --refraction none");
}

std::string RefractionArguments::name() const {
    scene::Scene scene;
    model.apply_to(scene);
    return off ? "none" : scene.refraction;
}

void ViewArguments::add_to(Verb verb) {
    verb.add_option(
            "--view", view,
            "Camera as seen from the DEM's centre: az=210,el=30,zoom=1, or whole, top, north, "
            "north-east, ...; default: from the air, where relief shows best")
        .group("View");
    verb.add_option("--eye", eye,
                    "Camera at LAT,LON[,H]; H in metres, with suffix agl above the ground")
        .group("View");
    verb.add_option("--look-at", look_at, "Place at the centre of the picture, LAT,LON[,H]")
        .group("View");
    verb.add_option("--heading", heading_deg,
                    "Viewing direction from --eye, degrees clockwise from true north")
        .check(any_number())
        .group("View");
    verb.add_option("--pitch", pitch_deg, "Viewing direction above the horizontal, degrees")
        .check(in_range(-90.0, 90.0))
        .group("View");
}

bool ViewArguments::any() const {
    return !view.empty() || !eye.empty() || !look_at.empty() || heading_deg || pitch_deg;
}

void ViewArguments::apply_to(scene::Scene& scene) const {
    scene::View& result = scene.view;
    if (!view.empty() && !eye.empty()) bad_usage("--view and --eye exclude each other; use one");
    if (eye.empty() && !scene.view.eye && (!look_at.empty() || heading_deg || pitch_deg))
        bad_usage("--look-at, --heading and --pitch need --eye");
    if (!look_at.empty() && (heading_deg || pitch_deg))
        bad_usage("--look-at and --heading or --pitch exclude each other; use one");
    if (!view.empty() || !eye.empty()) {
        const scene::View before = result;
        result = {};
        result.take_lens_of(before);
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
}

Check in_range(double min, double max) {
    return {[min, max](const std::string& text) {
                const std::optional<double> value = parse_number(text);
                return value && *value >= min && *value <= max
                           ? std::string()
                           : fmt::format("expected {:.10g} to {:.10g} but got {}", min, max, text);
            },
            fmt::format("{:.10g} to {:.10g}", min, max)};
}

Check any_number() {
    return {[](const std::string& text) {
                return parse_number(text) ? std::string()
                                          : fmt::format("expected a number but got {}", text);
            },
            ""};
}

Check whole_number() {
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

std::string schema_of(const Verb& verb) {
    std::string name = verb.command();
    std::ranges::replace(name, ' ', '-');
    return fmt::format("relevo-{}-1", name);
}

nlohmann::ordered_json with_schema(const std::string& schema, const nlohmann::ordered_json& json) {
    if (json.contains("schema")) return json;
    nlohmann::ordered_json all{{"schema", schema}};
    all.update(json);
    return all;
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
    bad_usage(
        fmt::format("--size: expected WIDTHxHEIGHT such as 1920x1080, each 1 to {}, but got \"{}\"",
                    scene::kMaxSide_px, text));
}

}  // namespace relevo::cli
