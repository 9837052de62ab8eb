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

namespace relevo::cli {
namespace {

using light::WalkLight;
using nlohmann::ordered_json;

struct AlongArguments {
    TerrainArguments terrain;
    std::string crs, start, zone, name;
    int track = 0;
    std::optional<double> speed_kmh, eye_height_m;
    RefractionArguments refraction;
    OutputArguments output;
};

/// Everything that the verb says, before it is text.
struct AlongResult {
    std::string name;
    std::size_t points = 0;
    sun::Zone zone;
    std::string assumption;
    std::string air;
    light::LightAlong found;
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

const light::WalkSum& sum_of(const AlongResult& result, WalkLight light) {
    return result.found.sums[static_cast<std::size_t>(light)];
}

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

ordered_json moment_json(const light::WalkMoment& moment, const sun::Zone& zone) {
    return {{"utc", report::utc_json<ordered_json>(moment.utc)},
            {"local", sun::to_iso(moment.utc, zone)},
            {"distance_m", moment.distance_m},
            {"lat_deg", angle_deg(moment.place.lat_rad)},
            {"lon_deg", angle_deg(moment.place.lon_rad)}};
}

ordered_json json_of(const AlongResult& result) {
    const light::LightAlong& found = result.found;
    ordered_json json;
    json["name"] = result.name;
    json["zone"] = result.zone.name();
    report::add_assumption(json, result.assumption);
    json["definition"] = found.definition;
    json["refraction"] = result.air;
    json["spacing_m"] = found.spacing_m;
    json["step_s"] = found.step_s;
    json["length_m"] = found.length_m;
    json["duration_h"] = found.duration_s / 3600;
    for (const WalkLight light : kLights) {
        const light::WalkSum& sum = sum_of(result, light);
        json[std::string(light::name_of(light))] = {
            {"duration_h", sum.time_s / 3600},
            {"length_m", sum.length_m},
            {"time_share", share(sum.time_s, found.duration_s)},
            {"length_share", share(sum.length_m, found.length_m)}};
    }
    ordered_json& stretches = json["stretches"] = ordered_json::array();
    for (const light::WalkStretch& stretch : found.stretches)
        stretches.push_back({{"light", light::name_of(stretch.light)},
                             {"from", moment_json(stretch.from, result.zone)},
                             {"to", moment_json(stretch.to, result.zone)}});
    return json;
}

std::string csv_of(const AlongResult& result) {
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

void print_text(const AlongResult& result) {
    const light::LightAlong& found = result.found;
    fmt::print("track               {}{:.2f} km, {} points\n",
               result.name.empty() ? "" : result.name + ", ", found.length_m / 1000, result.points);
    fmt::print("walk                {} to {}  ({}), {}\n\n",
               sun::to_iso(found.stretches.front().from.utc, result.zone),
               sun::to_iso(found.stretches.back().to.utc, result.zone),
               hours_text(found.duration_s), result.zone.name());
    for (const WalkLight light : kLights) {
        const light::WalkSum& sum = sum_of(result, light);
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

bool has_time(const dem::NamedPlace& place) {
    return !place.time.empty();
}

/// What a track without times of its own needs, before any work is done. @throws Error (Usage)
void check_times(const AlongArguments& arguments, const dem::NamedLine& line,
                 const std::string& path) {
    if (std::ranges::any_of(line.places, has_time)) return;
    if (arguments.start.empty())
        bad_usage(
            fmt::format("--start: missing, as {} has no times; pass --start "
                        "2026-06-21T09:00 --speed 4",
                        path));
    if (!arguments.speed_kmh)
        bad_usage(
            fmt::format("--speed: missing, as {} has no times; pass --speed 4, in km/h", path));
}

/// The times of a track's points: an offset of their own counts, whatever the walk's zone is.
/// @throws Error (BadInput) where one has none, and where one is no time
std::vector<sun::Instant> times_of(const dem::NamedLine& line, const std::string& path,
                                   const sun::Zone& zone) {
    // Loggers mix up fractions of a second: such points have one time.
    constexpr double kLoggersSecond_s = 1;
    std::vector<sun::Instant> times;
    std::optional<sun::Instant> earliest;
    for (const dem::NamedPlace& place : line.places) {
        if (!has_time(place))
            bad_input(
                fmt::format("sun along: {}: line {}: a point without a time, where others have "
                            "one; pass --start and --speed",
                            path, place.line));
        try {
            times.push_back(sun::is_wall_time(place.time) ? sun::parse_time(place.time, zone).utc
                                                          : sun::parse_time(place.time).utc);
        } catch (const Error& error) {
            bad_input(fmt::format("sun along: {}: line {}: {}", path, place.line, error.what()));
        }
        if (times.size() < 2) continue;
        const sun::Instant before = times[times.size() - 2];
        if (before - times.back() >= kLoggersSecond_s)
            bad_input(fmt::format(
                "sun along: {}: line {}: its time, {}, is before that of the point before, {}; "
                "expected times in order",
                path, place.line, sun::exact_iso(times.back()), sun::exact_iso(before)));
        earliest = std::min(earliest.value_or(before), times.back());
        times.back() = std::max(times.back(), before);
    }
    if (earliest && *earliest < times.front() && times.front() == times.back())
        bad_input(fmt::format(
            "sun along: {}: all points are within one second, from {} to {}; expected times that "
            "increase",
            path, sun::exact_iso(*earliest), sun::exact_iso(times.back())));
    return times;
}

/// The walk that is meant, and the clocks that it goes by: what is not said of its start and its
/// pace is the track's own.
light::Walk walk_of(const AlongArguments& arguments, const std::string& path,
                    const dem::NamedLine& line, const dem::Posts& posts, AlongResult& result) {
    std::vector<geo::Geodetic> places;
    for (const dem::NamedPlace& place : line.places)
        places.push_back(place.at.place);
    std::optional<sun::Instant> start;
    if (!arguments.start.empty()) {
        const sun::ParsedTime when =
            session::parse({arguments.start, {}, arguments.zone},
                           {.middle = [&] { return places.front(); },
                            .posts = [&]() -> const dem::Posts& { return posts; }},
                           line.places.front().at);
        start = when.utc;
        result.zone = when.zone;
        result.assumption = when.assumption;
    } else {
        sun::ChosenZone chosen = session::zone_of(arguments.zone, places.front());
        result.zone = std::move(chosen.zone);
        result.assumption = std::move(chosen.assumption);
    }
    std::vector<sun::Instant> times;
    if (!start || !arguments.speed_kmh) times = times_of(line, path, result.zone);
    if (!arguments.speed_kmh) {
        const light::Walk walk = light::Walk::timed(std::move(places), std::move(times));
        return start ? walk.starting_at(*start) : walk;
    }
    return light::Walk::at_speed(std::move(places), start ? *start : times.front(),
                                 *arguments.speed_kmh / 3.6);
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
    OutputFile* const file = arguments.output.open(files, arguments.terrain.dem);
    files.add_input(path, "the track");
    // Before the DEM: one from the net opens the net to all that GDAL reads.
    const dem::NamedLine line = dem::read_line(path, "sun along", arguments.crs, arguments.track);
    check_times(arguments, line, path);
    const dem::Posts posts = arguments.terrain.load();
    AlongResult result;
    result.name = arguments.name.empty() ? line.name : arguments.name;
    result.points = line.places.size();
    const light::Walk walk = walk_of(arguments, path, line, posts, result);
    light::WalkOptions options;
    options.horizon = arguments.terrain.view(arguments.eye_height_m).horizon({});
    options.air = [&](const geo::Geodetic& place) { return arguments.refraction.at(place); };
    options.highest_m = arguments.terrain.highest_m;
    result.air = arguments.refraction.name() == "standard"
                     ? "integrated ICAO standard atmosphere over the ground there"
                     : arguments.refraction.at(walk.places().front()).description();
    result.found = light::light_along(posts, walk, options);
    report::warn_of(result.found.doubt);
    arguments.output.deliver({.drawing = {},
                              .csv = [&] { return csv_of(result); },
                              .json = [&] { return json_of(result); },
                              .print = [&] { print_text(result); }},
                             file);
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
    verb.add_option("--name", arguments->name, "Name of the walk (default: the track's own)");
    verb.add_option("--eye-height", arguments->eye_height_m,
                    "Height of the eye above the ground, m (0)")
        .check(in_range(0.0, 10000.0));
    arguments->refraction.add_to(verb);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_along(*arguments); });
}

}  // namespace relevo::cli
