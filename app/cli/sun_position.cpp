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
#include "report/position.h"
#include "sun/event_time.h"
#include "sun/moon.h"
#include "sun/position.h"

namespace relevo::cli {
namespace {

using report::BodyPosition;

struct PositionArguments {
    sun::Body body = sun::Body::Sun;
    PlaceArguments place;
    PointsArguments points;
    TimeArguments time;
    RefractionArguments refraction;
    OutputArguments output;
};

BodyPosition result_of(const PositionArguments& arguments, const geo::PlaceText& at,
                       const sun::ParsedTime& when) {
    BodyPosition result =
        report::position(arguments.body, arguments.refraction.at(at.place), at.place, when);
    if (arguments.body == sun::Body::Moon)
        result.more.push_back({"age_d", sun::moon_age_d(when.utc), "{:.4f}"});
    return result;
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

std::string row_of(const BodyPosition& result) {
    const sun::SkyPosition& sky = result.sky;
    const report::Number distance = result.distance();
    std::string row = fmt::format(
        "{},{:.6f},{:.6f},{:.6f},{},{:.6f},{:.6f},{:.6f}",
        sun::to_iso(result.when.utc, result.when.zone), degrees(sky.azimuth_rad),
        degrees(sky.elevation_rad), result.apparent_deg,
        fmt::format(fmt::runtime(distance.format), distance.value), degrees(sky.declination_rad),
        degrees(sky.right_ascension_rad), degrees(sky.semidiameter_rad));
    for (const report::Number& figure : result.more)
        row += "," + fmt::format(fmt::runtime(figure.format), figure.value);
    return result.phase.empty() ? row : row + "," + result.phase;
}

void print_text(const BodyPosition& result) {
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
        return std::ranges::find_if(
                   result.more,
                   [&](const report::Number& f) { return std::string_view(f.key) == key; })
            ->value;
    };
    fmt::print("distance            {:9.0f} km\n", result.distance().value);
    fmt::print("declination         {:9.4f} deg\n", degrees(sky.declination_rad));
    fmt::print("phase               {}, {:.1f} days old\n", result.phase, figure("age_d"));
    fmt::print("illuminated         {:9.2f} %\n", 100 * figure("illuminated_fraction"));
    fmt::print("bright limb         {:9.2f} deg  from the zenith to the left\n",
               figure("bright_limb_from_zenith_deg"));
}

void run_points(const PositionArguments& arguments, FilesInUse& files, const OpenResults& results) {
    const auto points = arguments.points.read(files, arguments.output);
    const scene::TimeSpec spec = arguments.time.spec();
    session::needs_dem(spec);  // reports invalid words before any work
    const bool zone_by_place = sun::is_zone_by_place(spec.zone) && !sun::is_solar_zone(spec.zone) &&
                               (sun::is_event_time(spec.at) || sun::is_wall_time(spec.at));
    const PointsJob job{
        .columns = position_columns(arguments.body),
        .remarks = {definition_of(arguments.body)},
        .forms = [&](const dem::NamedPlace& point) {
            const geo::PlaceText& at = point.at;
            report::check_has_ground(at);
            const auto result = std::make_shared<BodyPosition>(
                result_of(arguments, at, session::parse_quietly(spec, {}, at)));
            return PointForms{
                .rows = [=] { return std::vector{row_of(*result)}; },
                .json = [=] { return nlohmann::ordered_json::parse(json_of(*result)); },
                .doubt = {}};
        }};
    deliver_points(arguments.points, points, job, arguments.output, results, zone_by_place);
}

void run_position(const PositionArguments& arguments) {
    FilesInUse files;
    const OpenResults results = arguments.output.open(files, {});
    if (arguments.points.given()) return run_points(arguments, files, results);
    const geo::PlaceText at = arguments.place.parse();
    report::check_has_ground(at);
    const BodyPosition result =
        result_of(arguments, at, session::parse(arguments.time.spec(), {}, at));
    arguments.output.deliver(
        {.drawing = {},
         .csv =
             [&] {
                 return csv_remarks({definition_of(result.body), result.air.description()}) +
                        position_columns(result.body) + "\n" + row_of(result) + "\n";
             },
         .json = [&] { return nlohmann::ordered_json::parse(json_of(result)); },
         .print = [&] { print_text(result); }},
        results);
}

}  // namespace

void add_position(Verb parent, sun::Body body) {
    const auto arguments = std::make_shared<PositionArguments>();
    arguments->body = body;
    const Verb verb = parent.add_verb(
        "position", body == sun::Body::Sun ? "Position of the sun"
                                           : "Position of the moon, its phase and bright limb");
    verb.add_option("--at", arguments->place.at, "Place: LAT,LON[,H]");
    verb.add_option("--at-crs", arguments->place.crs, "CRS of --at, which is then X,Y[,H]: EPSG:n");
    arguments->points.add_to(verb);
    arguments->time.add_to(verb);
    verb.option("--time").required();
    arguments->refraction.add_to(verb, body);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_position(*arguments); });
}

}  // namespace relevo::cli
