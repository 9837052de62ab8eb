#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "cli/shared.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "cli/sun_points.h"
#include "geo/format.h"
#include "geo/geodetic.h"
#include "sun/event_time.h"
#include "sun/moon.h"
#include "sun/position.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

struct PositionArguments {
    sun::Body body = sun::Body::Sun;
    std::string at;
    PointsArguments points;
    TimeArguments time;
    RefractionArguments refraction;
    OutputArguments output;
};

/// A figure of a position: its key in JSON and CSV, and how CSV writes it.
struct Figure {
    const char* key;
    double value;
    const char* csv;
};

struct PositionResult {
    sun::Body body;
    geo::Geodetic place;
    sun::ParsedTime when;
    sun::SkyPosition sky;
    sun::Refraction air;
    double apparent_deg = 0;
    std::vector<Figure> more;  ///< what only this body has
    std::string phase;         ///< of the moon
};

std::vector<Figure> figures_of(const sun::MoonPosition& moon, sun::Instant utc) {
    return {{"illuminated_fraction", moon.illuminated_fraction, "{:.6f}"},
            {"phase_angle_deg", degrees(moon.phase_angle_rad), "{:.6f}"},
            {"elongation_deg", degrees(moon.elongation_rad), "{:.6f}"},
            {"bright_limb_deg", degrees(moon.bright_limb_rad), "{:.4f}"},
            {"bright_limb_from_zenith_deg", degrees(moon.bright_limb_from_zenith_rad), "{:.4f}"},
            {"phase_longitude_deg", degrees(moon.phase_longitude_rad), "{:.6f}"},
            {"age_d", sun::moon_age_d(utc), "{:.4f}"}};
}

PositionResult result_of(const PositionArguments& arguments, const geo::PlaceText& at,
                         const sun::ParsedTime& when) {
    PositionResult result{
        arguments.body, at.place, when, {}, arguments.refraction.at(at.place), 0, {}, {}};
    if (arguments.body == sun::Body::Sun) {
        const sun::Position sun = sun::position(when.utc, at.place);
        result.sky = sun;
        result.more = {{"equation_of_time_min", sun.equation_of_time_s / 60, "{:.5f}"}};
    } else {
        const sun::MoonPosition moon = sun::moon_position(when.utc, at.place);
        result.sky = moon;
        result.more = figures_of(moon, when.utc);
        result.phase = sun::phase_name(moon.phase_longitude_rad);
    }
    result.apparent_deg = degrees(result.air.apparent_rad(result.sky.elevation_rad));
    return result;
}

/// In the unit that the body's distance is usually given in.
Figure distance_of(const PositionResult& result) {
    constexpr double kAu_km = 149'597'870.7;
    if (result.body == sun::Body::Sun) return {"distance_au", result.sky.distance_au, "{:.9f}"};
    return {"distance_km", result.sky.distance_au * kAu_km, "{:.3f}"};
}

ordered_json json_of(const PositionResult& result) {
    const sun::SkyPosition& sky = result.sky;
    const Figure distance = distance_of(result);
    ordered_json json = {{"utc", sun::to_iso(result.when.utc, 3)},
                         {"azimuth_deg", degrees(sky.azimuth_rad)},
                         {"elevation_deg", degrees(sky.elevation_rad)},
                         {"apparent_elevation_deg", result.apparent_deg},
                         {"refraction", result.air.description()},
                         {distance.key, distance.value},
                         {"declination_deg", degrees(sky.declination_rad)},
                         {"right_ascension_deg", degrees(sky.right_ascension_rad)},
                         {"semidiameter_deg", degrees(sky.semidiameter_rad)}};
    for (const Figure& figure : result.more)
        json[figure.key] = figure.value;
    if (!result.phase.empty()) json["phase"] = result.phase;
    add_assumption(json, result.when.assumption);
    return json;
}

std::string position_columns(sun::Body body) {
    constexpr const char* kColumns =
        "time,azimuth_deg,elevation_deg,apparent_elevation_deg,{},declination_deg,"
        "right_ascension_deg,semidiameter_deg,{}";
    if (body == sun::Body::Sun) return fmt::format(kColumns, "distance_au", "equation_of_time_min");
    return fmt::format(kColumns, "distance_km",
                       "illuminated_fraction,phase_angle_deg,elongation_deg,bright_limb_deg,"
                       "bright_limb_from_zenith_deg,phase_longitude_deg,age_d,phase");
}

std::string definition_of(sun::Body body) {
    const std::string centre = fmt::format(
        "azimuth of the {}'s centre clockwise from true north; elevation without air, apparent "
        "elevation as seen",
        name_of(body));
    if (body == sun::Body::Sun) return centre;
    return centre +
           "; bright limb: direction of its middle, from celestial north through east, and from "
           "the zenith to the left; libration is not modelled";
}

std::string row_of(const PositionResult& result) {
    const sun::SkyPosition& sky = result.sky;
    const Figure distance = distance_of(result);
    std::string row = fmt::format(
        "{},{:.6f},{:.6f},{:.6f},{},{:.6f},{:.6f},{:.6f}",
        sun::to_iso(result.when.utc, result.when.zone), degrees(sky.azimuth_rad),
        degrees(sky.elevation_rad), result.apparent_deg,
        fmt::format(fmt::runtime(distance.csv), distance.value), degrees(sky.declination_rad),
        degrees(sky.right_ascension_rad), degrees(sky.semidiameter_rad));
    for (const Figure& figure : result.more)
        row += "," + fmt::format(fmt::runtime(figure.csv), figure.value);
    return result.phase.empty() ? row : row + "," + result.phase;
}

void print_text(const PositionResult& result) {
    const sun::SkyPosition& sky = result.sky;
    const double azimuth_deg = degrees(sky.azimuth_rad);
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    fmt::print("time                {}  ({})\n", sun::to_iso(result.when.utc, result.when.zone),
               sun::to_iso(result.when.utc));
    fmt::print("azimuth             {:9.4f} deg  {}\n", azimuth_deg, compass_point(azimuth_deg));
    fmt::print("elevation           {:9.4f} deg  geometric, without air\n",
               degrees(sky.elevation_rad));
    fmt::print("apparent elevation  {:9.4f} deg  {}\n", result.apparent_deg,
               result.air.description());
    if (result.body == sun::Body::Sun) {
        fmt::print("distance            {:9.6f} au\n", sky.distance_au);
        fmt::print("declination         {:9.4f} deg\n", degrees(sky.declination_rad));
        fmt::print("equation of time    {:9.3f} min\n", result.more.front().value);
        return;
    }
    const auto figure = [&](const char* key) {
        return std::ranges::find_if(result.more,
                                    [&](const Figure& f) { return std::string_view(f.key) == key; })
            ->value;
    };
    fmt::print("distance            {:9.0f} km\n", distance_of(result).value);
    fmt::print("declination         {:9.4f} deg\n", degrees(sky.declination_rad));
    fmt::print("phase               {}, {:.1f} days old\n", result.phase, figure("age_d"));
    fmt::print("illuminated         {:9.2f} %\n", 100 * figure("illuminated_fraction"));
    fmt::print("bright limb         {:9.2f} deg  from the zenith to the left\n",
               figure("bright_limb_from_zenith_deg"));
}

void check_height(const geo::PlaceText& at) {
    if (at.above_ground)
        bad_usage("--at: a height above the ground needs a DEM; give one above sea level");
}

void run_points(const PositionArguments& arguments, FilesInUse& files, OutputFile* file) {
    const auto points = arguments.points.read(files, arguments.output);
    const scene::TimeSpec spec = arguments.time.spec();
    session::needs_dem(spec);  // reports invalid words before any work
    const bool zone_by_place = sun::is_zone_by_place(spec.zone) && !sun::is_solar_zone(spec.zone) &&
                               (sun::is_event_time(spec.at) || sun::is_wall_time(spec.at));
    const PointsJob job{.columns = position_columns(arguments.body),
                        .remarks = {definition_of(arguments.body)},
                        .forms = [&](const dem::NamedPlace& point) {
                            const geo::PlaceText& at = point.at;
                            check_height(at);
                            const auto result = std::make_shared<PositionResult>(
                                result_of(arguments, at, session::parse_quietly(spec, {}, at)));
                            return PointForms{.rows = [=] { return std::vector{row_of(*result)}; },
                                              .json = [=] { return json_of(*result); },
                                              .doubt = {}};
                        }};
    deliver_points(arguments.points, points, job, arguments.output, file, zone_by_place);
}

void run_position(const PositionArguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.output.open(files, {});
    if (arguments.points.given()) return run_points(arguments, files, file);
    const geo::PlaceText at = geo::parse_place(arguments.at, "--at");
    check_height(at);
    const PositionResult result =
        result_of(arguments, at, session::parse(arguments.time.spec(), {}, at));
    arguments.output.deliver(
        {.drawing = {},
         .csv =
             [&] {
                 return csv_remarks({definition_of(result.body), result.air.description()}) +
                        position_columns(result.body) + "\n" + row_of(result) + "\n";
             },
         .json = [&] { return json_of(result); },
         .print = [&] { print_text(result); }},
        file);
}

}  // namespace

void add_position(Verb parent, sun::Body body) {
    const auto arguments = std::make_shared<PositionArguments>();
    arguments->body = body;
    const Verb verb = parent.add_verb(
        "position", body == sun::Body::Sun ? "Position of the sun"
                                           : "Position of the moon, its phase and bright limb");
    verb.add_option("--at", arguments->at, "Place: LAT,LON[,H]");
    arguments->points.add_to(verb);
    arguments->time.add_to(verb);
    verb.option("--time").required();
    arguments->refraction.add_to(verb, body);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_position(*arguments); });
}

}  // namespace relevo::cli
