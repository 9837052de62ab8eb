#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "dem/places.h"
#include "light/point/light_along.h"
#include "report/along.h"

namespace relevo::cli {
namespace {

using light::WalkLight;

struct AlongArguments {
    TerrainArguments terrain;
    std::string crs, start, zone, name;
    std::string by = "stretch";
    int track = 0;
    std::optional<double> speed_kmh, eye_height_m;
    RefractionArguments refraction;
    OutputArguments output;
};

constexpr std::array kLights = {WalkLight::Sun, WalkLight::Terrain, WalkLight::Night,
                                WalkLight::NotKnown};

const char* words_of(WalkLight light) {
    switch (light) {
        case WalkLight::Sun:
            return "sun";
        case WalkLight::Terrain:
            return "shade by terrain";
        case WalkLight::Night:
            return "night";
        case WalkLight::NotKnown:
            break;
    }
    return "not known: a void of the DEM";
}

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

std::string csv_of(const report::Along& result) {
    std::string text =
        csv_remarks({result.found.definition, "refraction of the sun: " + result.air});
    text +=
        "light,from_time,to_time,from_km,to_km,from_lat_deg,from_lon_deg,to_lat_deg,to_lon_deg\n";
    for (const light::WalkStretch& s : result.found.stretches)
        text += fmt::format("{},{},{},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}\n",
                            light::name_of(s.light), sun::to_iso(s.from.utc, result.zone),
                            sun::to_iso(s.to.utc, result.zone), s.from.distance_m / 1000,
                            s.to.distance_m / 1000, angle_deg(s.from.place.lat_rad),
                            angle_deg(s.from.place.lon_rad), angle_deg(s.to.place.lat_rad),
                            angle_deg(s.to.place.lon_rad));
    return text;
}

std::string hours_csv(const report::Along& result) {
    std::string text = csv_remarks({result.found.definition, "refraction of the sun: " + result.air,
                                    "minutes of the walk in each hour; time is its begin"});
    text += "time,sun_min,terrain_min,night_min,not_known_min\n";
    for (const report::WalkHour& hour : report::hours_of(result)) {
        text += sun::to_iso(hour.begin, result.zone);
        for (const WalkLight light : kLights)
            text += fmt::format(",{:.3f}", hour.time_s[static_cast<std::size_t>(light)] / 60);
        text += '\n';
    }
    return text;
}

void print_hours(const report::Along& result) {
    fmt::print("{:<28}{:>10}{:>20}{:>8}{:>12}\n", "hour from", "sun", "shade by terrain", "night",
               "not known");
    for (const report::WalkHour& hour : report::hours_of(result)) {
        const auto minutes = [&](WalkLight light) {
            return hour.time_s[static_cast<std::size_t>(light)] / 60;
        };
        fmt::print("{:<28}{:>6.1f} min{:>16.1f} min{:>4.0f} min{:>8.1f} min\n",
                   sun::to_iso(hour.begin, result.zone), minutes(WalkLight::Sun),
                   minutes(WalkLight::Terrain), minutes(WalkLight::Night),
                   minutes(WalkLight::NotKnown));
    }
    fmt::print("\n{}\nrefraction of the sun: {}\n", result.found.definition, result.air);
}

void print_text(const report::Along& result) {
    const light::LightAlong& found = result.found;
    fmt::print("track               {}{:.2f} km, {} points\n",
               result.name.empty() ? "" : result.name + ", ", found.length_m / 1000, result.points);
    fmt::print("walk                {} to {}  ({}), {}\n\n",
               sun::to_iso(found.stretches.front().from.utc, result.zone),
               sun::to_iso(found.stretches.back().to.utc, result.zone),
               hours_text(found.duration_s), result.zone.name());
    for (const WalkLight light : kLights) {
        const light::WalkSum& sum = result.sum(light);
        if (light != WalkLight::Sun && sum.time_s <= 0 && sum.length_m <= 0) continue;
        fmt::print("{:<18}{:>9}{:6.1f} %{:10.2f} km{:6.1f} %\n",
                   light == WalkLight::NotKnown ? "not known" : words_of(light),
                   hours_text(sum.time_s), 100 * share(sum.time_s, found.duration_s),
                   sum.length_m / 1000, 100 * share(sum.length_m, found.length_m));
    }
    const sun::Zone& zone = result.zone;
    const auto day_of = [&](sun::Instant utc) { return zone.local(utc + 0.5).wall.date; };
    std::optional<sun::Date> day;
    for (const light::WalkStretch& s : found.stretches) {
        if (day != day_of(s.from.utc)) {
            day = day_of(s.from.utc);
            fmt::print("\n{}\n", sun::to_string(*day));
        }
        fmt::print("{} to {}{:10.3f} to {:8.3f} km  {}\n", clock_text(s.from.utc, zone),
                   clock_text(s.to.utc, zone), s.from.distance_m / 1000, s.to.distance_m / 1000,
                   words_of(s.light));
    }
    fmt::print("\n{}\nrefraction of the sun: {}\n", found.definition, result.air);
}

void run_along(AlongArguments arguments) {
    std::vector<std::string>& dems = arguments.terrain.dem.paths;
    if (dems.size() < 2)
        bad_usage(
            "TRACK: missing; name the DEM first, then a GPX, GeoJSON or CSV, as in relevo "
            "sun along dem.tif walk.gpx");
    const std::string path = dems.back();
    dems.pop_back();
    FilesInUse files;
    const OpenResults results = arguments.output.open(files, arguments.terrain.dem);
    files.add_input(path, "the track");
    // Before the DEM: one from the net opens the net to all that GDAL reads.
    const dem::NamedLine line = dem::read_line(path, "sun along", arguments.crs, arguments.track);
    report::WalkWords words{.start = arguments.start,
                            .zone = arguments.zone,
                            .speed_kmh = arguments.speed_kmh,
                            .parse_start = {},
                            .choose = session::zone_of};
    words.check(line, path);
    const dem::Posts posts = arguments.terrain.load();
    words.parse_start = [&](const geo::PlaceText& first) {
        return session::parse({words.start, {}, words.zone},
                              {.middle = [&] { return first.place; },
                               .posts = [&]() -> const dem::Posts& { return posts; }},
                              first);
    };
    report::View view;
    view.refraction = arguments.refraction.name();
    report::Along result = report::along(arguments.terrain.view(arguments.eye_height_m, view),
                                         words, line, path, posts);
    if (!arguments.name.empty()) result.name = arguments.name;
    report::warn_of(result.found.doubt);
    const bool by_hour = arguments.by == "hour";
    arguments.output.deliver(
        {.drawing = {},
         .csv = [&] { return by_hour ? hours_csv(result) : csv_of(result); },
         .json = [&] { return nlohmann::ordered_json::parse(json_of(result, by_hour)); },
         .print = [&] { by_hour ? print_hours(result) : print_text(result); }},
        results);
}

}  // namespace

void add_sun_along(Verb sun_verb) {
    const auto arguments = std::make_shared<AlongArguments>();
    const Verb verb = sun_verb.add_verb("along", "Finds where a walk is in the sun");
    arguments->terrain.add_to(verb);
    verb.option("DEM").description(
        "DEM... TRACK: elevation rasters, then a GPX, GeoJSON or CSV of the walk");
    verb.add_option("--start", arguments->start,
                    "When the walk begins: 2026-06-21T09:00, or an event such as sunrise+1h with "
                    "its date before it (default: the track's own)");
    verb.add_option("--speed", arguments->speed_kmh,
                    "Speed on the map, km/h (default: the track's own times)")
        .check(in_range(0.01, 1000.0));
    verb.add_option("--tz", arguments->zone,
                    "Time zone: Europe/Zurich, +05:30, solar, or auto, that of the start (auto)");
    verb.add_option("--track", arguments->track, "Number of the track in the file, from 1")
        .check(whole_number())
        .check(in_range(1, 1'000'000));
    verb.add_option("--points-crs", arguments->crs, "CRS of columns x and y in a CSV: EPSG:n");
    verb.add_option("--by", arguments->by,
                    "Rows: stretch of one light, or hour of the clock (stretch)")
        .check(one_of({"stretch", "hour"}));
    verb.add_option("--name", arguments->name, "Name of the walk (default: the track's own)");
    verb.add_option("--eye-height", arguments->eye_height_m,
                    "Height of the eye above the ground, m (0)")
        .check(in_range(0.0, 10000.0));
    arguments->refraction.add_to(verb);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_along(*arguments); });
}

}  // namespace relevo::cli
