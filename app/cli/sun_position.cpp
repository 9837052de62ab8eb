#include <memory>

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
#include "sun/position.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
    std::string at;
    PointsArguments points;
    TimeArguments time;
    RefractionArguments refraction;
    OutputArguments output;
};

struct Result {
    geo::Geodetic place;
    sun::ParsedTime when;
    sun::Position position;
    sun::Refraction air;
    double apparent_deg = 0;
};

Result result_of(const Arguments& arguments, const geo::PlaceText& at,
                 const sun::ParsedTime& when) {
    const sun::Position position = sun::position(when.utc, at.place);
    const sun::Refraction air = arguments.refraction.at(at.place);
    return {at.place, when, position, air, degrees(air.apparent_rad(position.elevation_rad))};
}

ordered_json json_of(const Result& result) {
    const sun::Position& position = result.position;
    ordered_json json = {{"utc", sun::to_iso(result.when.utc, 3)},
                         {"azimuth_deg", degrees(position.azimuth_rad)},
                         {"elevation_deg", degrees(position.elevation_rad)},
                         {"apparent_elevation_deg", result.apparent_deg},
                         {"refraction", result.air.description()},
                         {"distance_au", position.distance_au},
                         {"declination_deg", degrees(position.declination_rad)},
                         {"right_ascension_deg", degrees(position.right_ascension_rad)},
                         {"semidiameter_deg", degrees(position.semidiameter_rad)},
                         {"equation_of_time_min", position.equation_of_time_s / 60}};
    add_assumption(json, result.when.assumption);
    return json;
}

constexpr const char* kColumns =
    "time,azimuth_deg,elevation_deg,apparent_elevation_deg,distance_au,declination_deg,"
    "right_ascension_deg,semidiameter_deg,equation_of_time_min";
constexpr const char* kDefinition =
    "azimuth of the sun's centre clockwise from true north; elevation without air, apparent "
    "elevation as seen";

std::string row_of(const Result& result) {
    const sun::Position& position = result.position;
    return fmt::format("{},{:.6f},{:.6f},{:.6f},{:.9f},{:.6f},{:.6f},{:.6f},{:.5f}",
                       sun::to_iso(result.when.utc, result.when.zone),
                       degrees(position.azimuth_rad), degrees(position.elevation_rad),
                       result.apparent_deg, position.distance_au, degrees(position.declination_rad),
                       degrees(position.right_ascension_rad), degrees(position.semidiameter_rad),
                       position.equation_of_time_s / 60);
}

void print_text(const Result& result) {
    const sun::Position& position = result.position;
    const double azimuth_deg = degrees(position.azimuth_rad);
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    fmt::print("time                {}  ({})\n", sun::to_iso(result.when.utc, result.when.zone),
               sun::to_iso(result.when.utc));
    fmt::print("azimuth             {:9.4f} deg  {}\n", azimuth_deg, compass_point(azimuth_deg));
    fmt::print("elevation           {:9.4f} deg  geometric, without air\n",
               degrees(position.elevation_rad));
    fmt::print("apparent elevation  {:9.4f} deg  {}\n", result.apparent_deg,
               result.air.description());
    fmt::print("distance            {:9.6f} au\n", position.distance_au);
    fmt::print("declination         {:9.4f} deg\n", degrees(position.declination_rad));
    fmt::print("equation of time    {:9.3f} min\n", position.equation_of_time_s / 60);
}

void check_height(const geo::PlaceText& at) {
    if (at.above_ground)
        bad_usage("--at: a height above the ground needs a DEM; give one above sea level");
}

void run_points(const Arguments& arguments, FilesInUse& files, OutputFile* file) {
    const auto points = arguments.points.read(files, arguments.output);
    const scene::TimeSpec spec = arguments.time.spec();
    session::needs_dem(spec);  // reports invalid words before any work
    const bool zone_by_place = sun::is_zone_by_place(spec.zone) && !sun::is_solar_zone(spec.zone) &&
                               (sun::is_event_time(spec.at) || sun::is_wall_time(spec.at));
    const PointsJob job{
        .columns = kColumns, .remarks = {kDefinition}, .forms = [&](const geo::PlaceText& at) {
            check_height(at);
            const auto result = std::make_shared<Result>(
                result_of(arguments, at, session::parse_quietly(spec, {}, at)));
            return PointForms{.rows = [=] { return std::vector{row_of(*result)}; },
                              .json = [=] { return json_of(*result); },
                              .doubt = {}};
        }};
    deliver_points(arguments.points, points, job, arguments.output, file, zone_by_place);
}

void run(const Arguments& arguments) {
    FilesInUse files;
    OutputFile* const file = arguments.output.open(files, {});
    if (arguments.points.given()) return run_points(arguments, files, file);
    const geo::PlaceText at = geo::parse_place(arguments.at, "--at");
    check_height(at);
    const Result result = result_of(arguments, at, session::parse(arguments.time.spec(), {}, at));
    arguments.output.deliver({.drawing = {},
                              .csv =
                                  [&] {
                                      return csv_remarks({kDefinition, result.air.description()}) +
                                             kColumns + "\n" + row_of(result) + "\n";
                                  },
                              .json = [&] { return json_of(result); },
                              .print = [&] { print_text(result); }},
                             file);
}

}  // namespace

void add_sun_position(Verb sun_verb) {
    const auto arguments = std::make_shared<Arguments>();
    const Verb verb = sun_verb.add_verb("position", "Position of the sun");
    verb.add_option("--at", arguments->at, "Place: LAT,LON[,H]");
    arguments->points.add_to(verb);
    arguments->time.add_to(verb);
    verb.option("--time").required();
    arguments->refraction.add_to(verb);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run(*arguments); });
}

}  // namespace relevo::cli
