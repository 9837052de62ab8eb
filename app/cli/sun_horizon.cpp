#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "chart/panorama.h"
#include "cli/day_verb.h"
#include "cli/sun.h"
#include "geo/format.h"
#include "output/horizon_files.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

struct HorizonArguments : DayArguments {
    std::string format;
    std::optional<double> step_deg;
};

ordered_json number_or_null(double value) {
    return std::isnan(value) ? ordered_json() : ordered_json(value);
}

ordered_json json_of(const light::TerrainHorizon& horizon,
                     const std::vector<light::HorizonPoint>& profile, const light::Doubt& doubt) {
    ordered_json json;
    json["place"] = report::place_json<ordered_json>(horizon.place());
    json["eye_m"] = horizon.eye_m();
    json["definition"] = horizon.description();
    ordered_json& points = json["horizon"] = ordered_json::array();
    for (const light::HorizonPoint& p : profile) {
        const geo::Geodetic at = horizon.place_of(p);
        points.push_back({{"azimuth_deg", angle_deg(p.azimuth_rad)},
                          {"horizon_deg", angle_deg(p.elevation_rad)},
                          {"distance_m", number_or_null(p.distance_m)},
                          {"lat_deg", number_or_null(angle_deg(at.lat_rad))},
                          {"lon_deg", number_or_null(angle_deg(at.lon_rad))},
                          {"height_m", number_or_null(p.height_m)},
                          {"hole", p.hole}});
    }
    ordered_json& open = json["open_sectors"] = ordered_json::array();
    for (const light::OpenSector& s : doubt.open)
        open.push_back({{"from_azimuth_deg", angle_deg(s.from_azimuth_rad)},
                        {"to_azimuth_deg", angle_deg(s.to_azimuth_rad)},
                        {"reach_m", s.reach_m},
                        {"needed_m", s.needed_m},
                        {"least_m", s.least_m}});
    if (!doubt.holes.empty())
        json["hole_sectors"] = report::sectors_json<ordered_json>(doubt.holes);
    return json;
}

/// Where holes of the DEM leave the horizon open.
std::string holes_text(const light::Doubt& doubt) {
    return fmt::format(
        "not known: the horizon {}, where ground as high as the DEM's highest post in a void would "
        "be above it",
        report::sectors_text(doubt.holes));
}

constexpr const char* kHorizonColumns =
    "azimuth_deg,horizon_deg,distance_m,lat_deg,lon_deg,height_m";

std::vector<std::string> rows_of(const light::TerrainHorizon& horizon,
                                 const std::vector<light::HorizonPoint>& profile) {
    std::vector<std::string> rows;
    for (const light::HorizonPoint& p : profile) {
        std::string row =
            fmt::format("{:.6g},{:.5f}", degrees(p.azimuth_rad), degrees(p.elevation_rad));
        const geo::Geodetic at = horizon.place_of(p);
        if (std::isnan(p.distance_m))
            row += ",,,,";
        else
            row += fmt::format(",{:.1f},{:.6f},{:.6f},{:.1f}", p.distance_m, degrees(at.lat_rad),
                               degrees(at.lon_rad), p.height_m);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string csv_of(const light::TerrainHorizon& horizon,
                   const std::vector<light::HorizonPoint>& profile, const light::Doubt& doubt) {
    std::vector<std::string> remarks{
        fmt::format("eye at {}, {:.2f} m", geo::degrees_text(horizon.place()), horizon.eye_m()),
        horizon.description()};
    if (!doubt.holes.empty()) remarks.push_back(holes_text(doubt));
    std::string text = csv_remarks(remarks) + kHorizonColumns + "\n";
    for (const std::string& row : rows_of(horizon, profile))
        text += row + "\n";
    return text;
}

void print_text(const light::TerrainHorizon& horizon,
                const std::vector<light::HorizonPoint>& profile, const light::Doubt& doubt) {
    fmt::print("place               {}, {:.1f} m, eye at {:.1f} m\n\n",
               geo::degrees_text(horizon.place()), horizon.place().height_m, horizon.eye_m());
    fmt::print("azimuth       horizon   distance   height\n");
    const auto line = [&](double azimuth_deg) {
        const light::HorizonPoint p = horizon.at(radians(azimuth_deg));
        fmt::print("{:5.1f} {:<4}  {:7.3f} deg", azimuth_deg, compass_point(azimuth_deg),
                   degrees(p.elevation_rad));
        if (std::isnan(p.distance_m))
            fmt::print("   outside the DEM{}\n", p.hole ? "  not known: a void of the DEM" : "");
        else
            fmt::print("  {:6.2f} km  {:5.0f} m{}\n", p.distance_m / 1000, p.height_m,
                       p.hole ? "  not known: a void of the DEM" : "");
    };
    for (int k = 0; k < 16; ++k)
        line(22.5 * k);
    const auto highest = std::ranges::max_element(
        profile, [](const auto& a, const auto& b) { return a.elevation_rad < b.elevation_rad; });
    fmt::print("\nhighest\n");
    line(degrees(highest->azimuth_rad));
    fmt::print("\n{}\n", horizon.description());
    if (!doubt.holes.empty()) fmt::print("{}\n", holes_text(doubt));
}

/// @param asked  the day or the year whose sun or moon the panorama shows
chart::Drawing draw(const HorizonArguments& arguments, const std::optional<report::Days>& asked,
                    const light::TerrainHorizon& horizon,
                    const std::vector<light::HorizonPoint>& profile) {
    chart::HorizonPanorama panorama;
    panorama.horizon = &horizon;
    panorama.profile = &profile;
    panorama.names = chart::names_on_skyline(horizon);
    panorama.place_name = arguments.place.name;
    std::optional<light::DirectLight> direct;
    if (asked) {
        panorama.body = arguments.light.body;
        panorama.year = asked->first.year;
        panorama.zone = asked->zone;
        panorama.refraction = arguments.light.refraction.at(horizon.place());
        if (asked->single) {
            direct.emplace(horizon, arguments.view().light(horizon.place()));
            panorama.day = direct->day(asked->first, asked->zone);
            panorama.light_definition = direct->definition();
        }
    }
    return panorama.draw();
}

/// The form of the table: as --format says, else by the name's ending.
std::string format_of(const HorizonArguments& arguments) {
    if (!arguments.format.empty()) return arguments.format;
    const OutputArguments& output = arguments.output;
    if (output.has("hor") + output.has("txt") + (output.has("csv") || output.csv) > 1)
        bad_usage("-o: tables of several formats have different steps; write them one by one");
    return output.has("hor") ? "pvsyst" : output.has("txt") ? "pvgis" : "csv";
}

/// How many directions are looked at. @throws Error (Usage) for a step that is no part of a turn
int directions_of(const HorizonArguments& arguments, const std::string& format) {
    const double step_deg = arguments.step_deg.value_or(format == "csv"      ? 0.1
                                                        : format == "pvsyst" ? 3
                                                                             : 1);
    const double directions = 360 / step_deg;
    if (std::abs(directions - std::round(directions)) > 1e-6)
        bad_usage(fmt::format(
            "--step: {:.10g} degrees: does not divide 360, expected for example 0.1, 0.5 or 1",
            step_deg));
    return static_cast<int>(std::lround(directions));
}

void check_format(const HorizonArguments& arguments, const std::string& format) {
    const OutputArguments& output = arguments.output;
    if (!arguments.format.empty() && (output.json || output.has_drawing() || output.has("json")))
        bad_usage(
            "--format: applies to tables; pass -o with a name that ends in csv, hor, txt, or none "
            "for standard output");
    if (format != "csv" && !arguments.points.path.empty())
        bad_usage(fmt::format("--points: a file for {} is of one place; pass --at", format));
}

[[noreturn]] void refuse_days(const HorizonArguments& arguments) {
    bad_usage(
        fmt::format("--date and --year: only a panorama shows the {}; pass -o with a name that "
                    "ends in svg, png",
                    name_of(arguments.light.body)));
}

/// The day or the year whose sun a panorama shows, or the day whose moon.
std::optional<report::Days> asked_of(const HorizonArguments& arguments) {
    if (!arguments.days.given()) return std::nullopt;
    const report::Days asked = arguments.days.parse(arguments.place.parse().place);
    if (!asked.single && arguments.light.body == sun::Body::Moon)
        bad_usage("--from, --to and --year: a panorama shows one day of the moon; pass --date");
    if (!asked.single && !arguments.days.year)
        bad_usage(
            "--from and --to: a panorama shows one day or one year; pass --date or "
            "--year");
    if (!arguments.output.has_drawing()) refuse_days(arguments);
    return asked;
}

void run_points(const HorizonArguments& arguments, FilesInUse& files, const OpenResults& results) {
    if (arguments.days.given()) refuse_days(arguments);
    const auto points = arguments.points.read(files, arguments.output);
    const int directions = directions_of(arguments, "csv");
    const dem::Posts posts = arguments.terrain.load();
    struct HorizonResult {
        std::unique_ptr<const light::TerrainHorizon> horizon;
        std::vector<light::HorizonPoint> profile;
        light::Doubt doubt;
    };
    const auto forms = [&](const dem::NamedPlace& point) {
        const geo::PlaceText& at = point.at;
        const auto result = std::make_shared<HorizonResult>();
        result->horizon =
            std::make_unique<light::TerrainHorizon>(posts, at.place, arguments.view().horizon(at));
        result->profile = result->horizon->profile(directions);
        result->doubt =
            light::doubt_of(*result->horizon, result->profile, arguments.terrain.highest_m);
        return PointForms{
            .rows = [=] { return rows_of(*result->horizon, result->profile); },
            .json = [=] { return json_of(*result->horizon, result->profile, result->doubt); },
            .doubt = result->doubt};
    };
    deliver_points(arguments.points, points,
                   {kHorizonColumns,
                    {"terrain horizon: apparent elevations; --json has the definition of "
                     "each point"},
                    forms},
                   arguments.output, results, false);
}

void run_horizon(const HorizonArguments& arguments) {
    OutputArguments output = arguments.output;
    const std::string format = format_of(arguments);
    check_format(arguments, format);
    if (!arguments.format.empty() && output.paths.empty()) output.csv = true;
    FilesInUse files;
    const OpenResults results = output.open(files, arguments.terrain.dem);
    if (arguments.points.given()) return run_points(arguments, files, results);
    const std::optional<report::Days> asked = asked_of(arguments);
    const int directions = directions_of(arguments, format);
    const geo::PlaceText at = arguments.place.parse();
    const light::HorizonOptions options = arguments.view().horizon(at);
    const dem::Posts posts = arguments.terrain.load();
    const light::TerrainHorizon horizon(posts, at.place, options);
    const std::vector<light::HorizonPoint> profile = horizon.profile(directions);
    const light::Doubt doubt = light::doubt_of(horizon, profile, arguments.terrain.highest_m);
    report::warn_of(doubt);

    const auto table = [&] {
        return format == "pvlib"    ? output::pvlib_text(profile)
               : format == "pvgis"  ? output::pvgis_text(profile)
               : format == "pvsyst" ? output::pvsyst_text(profile, horizon.place())
                                    : csv_of(horizon, profile, doubt);
    };
    output.deliver({.drawing = [&] { return draw(arguments, asked, horizon, profile); },
                    .csv = table,
                    .json = [&] { return json_of(horizon, profile, doubt); },
                    .print = [&] { print_text(horizon, profile, doubt); }},
                   results);
}

}  // namespace

void add_horizon(Verb parent, sun::Body body) {
    const auto arguments = std::make_shared<HorizonArguments>();
    arguments->light.body = body;
    const Verb verb = parent.add_verb(
        "horizon", fmt::format("Terrain horizon of a point; as a panorama also with the {}",
                               body == sun::Body::Sun ? "sun's paths" : "moon's path"));
    arguments->terrain.add_to(verb);
    arguments->place.add_to(verb);
    arguments->points.add_to(verb);
    verb.add_option("--step", arguments->step_deg,
                    "Step of the azimuth, degrees (0.1; pvlib and pvgis 1, pvsyst 3)")
        .check(in_range(0.01, 90.0));
    verb.add_option("--format", arguments->format,
                    "Format of the table: csv, or a horizon file of pvlib, pvgis or pvsyst")
        .check(one_of({"csv", "pvlib", "pvgis", "pvsyst"}));
    arguments->days.add_to(verb);
    arguments->light.add_to(verb);
    arguments->light.add_dip_to(verb);
    arguments->output.add_to(verb, {"csv", "json", "svg", "png", "hor", "txt"});
    verb.callback([arguments] { run_horizon(*arguments); });
}

}  // namespace relevo::cli
