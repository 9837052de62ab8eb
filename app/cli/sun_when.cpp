#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "cli/sun_points.h"
#include "geo/format.h"
#include "report/when.h"

namespace relevo::cli {
namespace {

struct WhenArguments {
    TerrainArguments terrain;
    PlaceArguments place;
    PointsArguments points;
    report::WhenOptions options;
    DaysArguments days;
    RefractionArguments refraction;
    OutputArguments output;
    sun::Body body = sun::Body::Sun;

    report::View view() const {
        report::View light;
        light.body = body;
        light.refraction = refraction.name();
        return terrain.view(place.eye_height_m, light);
    }
};

std::string columns_of(sun::Body body) {
    return "time,separation_deg,right_deg,above_deg,azimuth_deg,apparent_elevation_deg," +
           report::visible_key(body);
}

std::string directions_of(sun::Body body) {
    return fmt::format(
        "right_deg and above_deg: of the {}'s centre from the summit; --json has the summit, the "
        "line of sight and the definition of each point",
        name_of(body));
}

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

std::string csv_of(const report::When& result) {
    const light::Alignments& found = result.found;
    std::string text =
        csv_remarks({target_text(found), found.definition}) + columns_of(result.body) + "\n";
    for (const std::string& row : rows_of(found, result.asked.zone))
        text += row + "\n";
    return text;
}

void print_text(const report::When& result) {
    const light::Alignments& found = result.found;
    const light::TerrainHorizon& horizon = *result.horizon;
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
        fmt::print("\nthe {} does not come that near on these days\n", name_of(result.body));
    else
        fmt::print("\n{:<27}{:>10}{:>19}{:>19}\n", "time", "apart", "along the horizon",
                   "in elevation");
    for (const light::Alignment& p : found.passages)
        fmt::print("{:<27}{:6.3f} deg  {:6.3f} deg {:<6}  {:6.3f} deg {:<6}{}\n",
                   sun::to_iso(p.utc, result.asked.zone), degrees(p.separation_rad),
                   std::abs(degrees(p.right_rad)), p.right_rad < 0 ? "left" : "right",
                   std::abs(degrees(p.above_rad)), p.above_rad < 0 ? "below" : "above",
                   !p.sun_visible ? "  behind terrain"
                   : p.hole       ? "  not known: a void of the DEM"
                                  : "");
    fmt::print("\n{}\n{}\n", found.definition, horizon.description());
}

void run_points(const WhenArguments& arguments, FilesInUse& files, const OpenResults& results) {
    arguments.days.parse({}, false);  // what is wrong with them is said before any work
    const auto points = arguments.points.read(files, arguments.output);
    const dem::Posts posts = arguments.terrain.load();
    const geo::Geodetic target = arguments.options.target(posts);
    const auto forms = [&](const dem::NamedPlace& point) {
        const report::Days asked = arguments.days.parse(point.at.place, false);
        const auto result = std::make_shared<const report::When>(
            report::when(arguments.view(), arguments.options, asked, point.at, posts, target));
        light::Doubt doubt = result->doubt;
        if (result->through_hole()) doubt.holes.emplace_back();
        return PointForms{.rows = [=] { return rows_of(result->found, result->asked.zone); },
                          .json = [=] { return nlohmann::ordered_json::parse(json_of(*result)); },
                          .doubt = doubt};
    };
    deliver_points(arguments.points, points,
                   {columns_of(arguments.body), {directions_of(arguments.body)}, forms},
                   arguments.output, results, sun::is_zone_by_place(arguments.days.zone));
}

void run_when(const WhenArguments& arguments) {
    const OutputArguments& output = arguments.output;
    FilesInUse files;
    const OpenResults results = output.open(files, arguments.terrain.dem);
    if (arguments.points.given()) return run_points(arguments, files, results);
    const geo::PlaceText at = arguments.place.parse();
    const report::Days asked = arguments.days.parse(at.place);
    // What is wrong with these is said before any work.
    geo::parse_place(arguments.options.over, "--over");
    arguments.view().horizon(at);
    const dem::Posts posts = arguments.terrain.load();
    const report::When result = report::when(arguments.view(), arguments.options, asked, at, posts,
                                             arguments.options.target(posts));
    report::warn_of(result);
    output.deliver({.drawing = {},
                    .csv = [&] { return csv_of(result); },
                    .json = [&] { return nlohmann::ordered_json::parse(json_of(result)); },
                    .print = [&] { print_text(result); }},
                   results);
}

}  // namespace

void add_when(Verb parent, sun::Body body) {
    const auto arguments = std::make_shared<WhenArguments>();
    arguments->body = body;
    const Verb verb = parent.add_verb(
        "when",
        fmt::format("Times when the {} stands over a summit, seen from a place", name_of(body)));
    arguments->terrain.add_to(verb);
    arguments->place.add_to(verb);
    arguments->points.add_to(verb);
    verb.add_option("--over", arguments->options.over,
                    "Summit: LAT,LON for the highest post nearby, or LAT,LON,H for that point")
        .required();
    verb.add_option("--summit-radius", arguments->options.summit_radius_m,
                    "Search radius of the summit, m (100)")
        .check(in_range(0.0, 10000.0));
    verb.add_option(
            "--tolerance", arguments->options.tolerance_deg,
            fmt::format("Largest distance of the {}'s centre, degrees (0.5)", name_of(body)))
        .check(in_range(0.001, 45.0));
    arguments->days.add_to(verb);
    arguments->refraction.add_to(verb, body);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_when(*arguments); });
}

}  // namespace relevo::cli
