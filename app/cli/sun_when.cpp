#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/log.h"
#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "cli/sun_points.h"
#include "geo/format.h"
#include "light/point/alignment.h"
#include "light/point/doubt.h"
#include "light/point/ground_at.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

struct WhenArguments {
    TerrainArguments terrain;
    PlaceArguments place;
    PointsArguments points;
    std::string over;
    DaysArguments days;
    RefractionArguments refraction;
    double tolerance_deg = 0.5, summit_radius_m = 100;
    OutputArguments output;
};

ordered_json json_of(const light::Alignments& found, const light::TerrainHorizon& horizon,
                     const DaysArguments::Days& asked) {
    const sun::Zone& zone = asked.zone;
    ordered_json json;
    json["place"] = place_json(horizon.place());
    json["eye_m"] = horizon.eye_m();
    json["target"] = place_json(found.target);
    json["sight"] = {{"azimuth_deg", angle_deg(found.sight.azimuth_rad)},
                     {"elevation_deg", angle_deg(found.sight.elevation_rad)},
                     {"distance_m", found.sight.distance_m},
                     {"visible", found.sight.visible},
                     {"hidden_by_deg", angle_deg(found.sight.hidden_by_rad)}};
    if (found.sight.hole) json["sight"]["hole"] = true;
    json["zone"] = zone.name();
    add_assumption(json, asked.assumption);
    json["definition"] = found.definition;
    ordered_json& passages = json["passages"] = ordered_json::array();
    for (const light::Alignment& p : found.passages) {
        passages.push_back({{"utc", utc_json(p.utc)},
                            {"local", sun::to_iso(p.utc, zone)},
                            {"date", sun::to_string(p.date)},
                            {"separation_deg", angle_deg(p.separation_rad)},
                            {"right_deg", angle_deg(p.right_rad)},
                            {"above_deg", angle_deg(p.above_rad)},
                            {"azimuth_deg", angle_deg(p.azimuth_rad)},
                            {"apparent_elevation_deg", angle_deg(p.elevation_rad)},
                            {"sun_visible", p.sun_visible}});
        if (p.hole) passages.back()["hole"] = true;
    }
    return json;
}

constexpr const char* kWhenColumns =
    "time,separation_deg,right_deg,above_deg,azimuth_deg,apparent_elevation_deg,sun_visible";

constexpr const char* kDirections =
    "right_deg and above_deg: of the sun's centre from the summit; --json has the summit, the line "
    "of sight and the definition of each point";

std::string target_text(const light::Alignments& found) {
    return fmt::format("target {}, {:.1f} m", geo::degrees_text(found.target),
                       found.target.height_m);
}

std::vector<std::string> rows_of(const light::Alignments& found, const sun::Zone& zone) {
    std::vector<std::string> rows;
    for (const light::Alignment& p : found.passages)
        rows.push_back(
            fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{}", sun::to_iso(p.utc, zone),
                        degrees(p.separation_rad), degrees(p.right_rad), degrees(p.above_rad),
                        degrees(p.azimuth_rad), degrees(p.elevation_rad), p.sun_visible));
    return rows;
}

std::string csv_of(const light::Alignments& found, const sun::Zone& zone) {
    std::string text = csv_remarks({target_text(found), found.definition}) + kWhenColumns + "\n";
    for (const std::string& row : rows_of(found, zone))
        text += row + "\n";
    return text;
}

void print_text(const light::Alignments& found, const light::TerrainHorizon& horizon,
                const sun::Zone& zone) {
    const double azimuth_deg = degrees(found.sight.azimuth_rad);
    fmt::print("place               {}, {:.1f} m, eye at {:.1f} m\n",
               geo::degrees_text(horizon.place()), horizon.place().height_m, horizon.eye_m());
    fmt::print("target              {}, {:.1f} m\n", geo::degrees_text(found.target),
               found.target.height_m);
    fmt::print(
        "in the sky          azimuth {:.3f} deg ({}), elevation {:.3f} deg, {:.2f} km away\n",
        azimuth_deg, compass_point(azimuth_deg), degrees(found.sight.elevation_rad),
        found.sight.distance_m / 1000);
    if (!found.sight.visible)
        fmt::print("not seen            ground before it stands {:.3f} deg higher\n",
                   degrees(found.sight.hidden_by_rad));
    if (found.sight.hole)
        fmt::print("not known           whether it is visible, through a void of the DEM\n");
    if (found.passages.empty())
        fmt::print("\nthe sun does not come that near on these days\n");
    else
        fmt::print("\n{:<27}{:>10}{:>19}{:>19}\n", "time", "apart", "along the horizon",
                   "in elevation");
    for (const light::Alignment& p : found.passages)
        fmt::print("{:<27}{:6.3f} deg  {:6.3f} deg {:<6}  {:6.3f} deg {:<6}{}\n",
                   sun::to_iso(p.utc, zone), degrees(p.separation_rad),
                   std::abs(degrees(p.right_rad)), p.right_rad < 0 ? "left" : "right",
                   std::abs(degrees(p.above_rad)), p.above_rad < 0 ? "below" : "above",
                   !p.sun_visible ? "  behind terrain"
                   : p.hole       ? "  not known: a void of the DEM"
                                  : "");
    fmt::print("\n{}\n{}\n", found.definition, horizon.description());
}

/// The point that --over means.
geo::Geodetic target_of(const WhenArguments& arguments, const dem::Posts& posts) {
    const geo::PlaceText over = geo::parse_place(arguments.over, "--over");
    if (over.has_height && !over.above_ground) return over.place;
    geo::Geodetic target =
        light::summit_near(posts, over.place, over.has_height ? 0 : arguments.summit_radius_m);
    target.height_m += over.place.height_m;
    return target;
}

light::Alignments find(const WhenArguments& arguments, const light::TerrainHorizon& horizon,
                       const geo::Geodetic& target, const DaysArguments::Days& asked) {
    light::AlignmentOptions options;
    options.tolerance_rad = radians(arguments.tolerance_deg);
    options.refraction = arguments.refraction.at(horizon.place());
    return light::alignments(horizon, target, asked.first, asked.last, asked.zone, options);
}

bool through_hole(const light::Alignments& found) {
    return found.sight.hole ||
           std::ranges::any_of(found.passages, [](const light::Alignment& p) { return p.hole; });
}

void run_points(const WhenArguments& arguments, FilesInUse& files, OutputFile* file) {
    arguments.days.parse({}, false);  // what is wrong with them is said before any work
    const auto points = arguments.points.read(files, arguments.output);
    const dem::Posts posts = arguments.terrain.load();
    const geo::Geodetic target = target_of(arguments, posts);
    struct WhenResult {
        std::unique_ptr<const light::TerrainHorizon> horizon;
        light::Alignments found;
        DaysArguments::Days asked;
    };
    const auto forms = [&](const dem::NamedPlace& point) {
        const geo::PlaceText& at = point.at;
        const auto result = std::make_shared<WhenResult>();
        result->asked = arguments.days.parse(at.place, false);
        result->horizon = std::make_unique<light::TerrainHorizon>(
            posts, at.place, arguments.terrain.horizon(at, arguments.place.eye_height_m));
        result->found = find(arguments, *result->horizon, target, result->asked);
        light::Doubt doubt =
            light::doubt_of(*result->horizon, result->found, arguments.terrain.highest_m);
        if (through_hole(result->found)) doubt.holes.emplace_back();
        return PointForms{
            .rows = [=] { return rows_of(result->found, result->asked.zone); },
            .json = [=] { return json_of(result->found, *result->horizon, result->asked); },
            .doubt = doubt};
    };
    deliver_points(arguments.points, points, {kWhenColumns, {kDirections}, forms}, arguments.output,
                   file, sun::is_zone_by_place(arguments.days.zone));
}

void run_when(const WhenArguments& arguments) {
    const OutputArguments& output = arguments.output;
    FilesInUse files;
    OutputFile* const file = output.open(files, arguments.terrain.dem);
    if (arguments.points.given()) return run_points(arguments, files, file);
    const DaysArguments::Days asked = arguments.days.parse(arguments.place.parse().place);
    geo::parse_place(arguments.over, "--over");  // what is wrong with it is said before any work
    const std::unique_ptr<TerrainView> view = arguments.terrain.view_from(arguments.place);
    const light::TerrainHorizon& horizon = view->horizon;
    const light::Alignments found =
        find(arguments, horizon, target_of(arguments, view->dem), asked);

    if (through_hole(found))
        log::warning(
            "the DEM has voids in the way: ground in them could hide the summit or the sun over "
            "it; use a DEM without voids");

    warn_of(light::doubt_of(horizon, found, arguments.terrain.highest_m));

    output.deliver({.drawing = {},
                    .csv = [&] { return csv_of(found, asked.zone); },
                    .json = [&] { return json_of(found, horizon, asked); },
                    .print = [&] { print_text(found, horizon, asked.zone); }},
                   file);
}

}  // namespace

void add_sun_when(Verb sun_verb) {
    const auto arguments = std::make_shared<WhenArguments>();
    const Verb verb =
        sun_verb.add_verb("when", "Times when the sun stands over a summit, seen from a place");
    arguments->terrain.add_to(verb);
    arguments->place.add_to(verb);
    arguments->points.add_to(verb);
    verb.add_option("--over", arguments->over,
                    "Summit: LAT,LON for the highest post nearby, or LAT,LON,H for that point")
        .required();
    verb.add_option("--summit-radius", arguments->summit_radius_m,
                    "Search radius of the summit, m (100)")
        .check(in_range(0.0, 10000.0));
    verb.add_option("--tolerance", arguments->tolerance_deg,
                    "Largest distance of the sun's centre, degrees (0.5)")
        .check(in_range(0.001, 45.0));
    arguments->days.add_to(verb);
    arguments->refraction.add_to(verb);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_when(*arguments); });
}

}  // namespace relevo::cli
