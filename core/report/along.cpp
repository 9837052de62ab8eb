#include "report/along.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/json_parts.h"

namespace relevo::report {
namespace {

using nlohmann::ordered_json;

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

ordered_json moment_json(const light::WalkMoment& moment, const sun::Zone& zone) {
    return {{"utc", utc_json<ordered_json>(moment.utc)},
            {"local", sun::to_iso(moment.utc, zone)},
            {"distance_m", moment.distance_m},
            {"lat_deg", angle_deg(moment.place.lat_rad)},
            {"lon_deg", angle_deg(moment.place.lon_rad)}};
}

bool has_time(const dem::NamedPlace& place) {
    return !place.time.empty();
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

/// What is not said of a walk's start and pace is the track's own.
light::Walk walk_of(const WalkWords& words, const dem::NamedLine& line, const std::string& path,
                    Along& result) {
    std::vector<geo::Geodetic> places;
    for (const dem::NamedPlace& place : line.places)
        places.push_back(place.at.place);
    std::optional<sun::Instant> start;
    if (!words.start.empty()) {
        const sun::ParsedTime when = words.parse_start(line.places.front().at);
        start = when.utc;
        result.zone = when.zone;
        result.assumption = when.assumption;
    } else {
        sun::ChosenZone chosen = words.choose(words.zone, places.front());
        result.zone = std::move(chosen.zone);
        result.assumption = std::move(chosen.assumption);
    }
    std::vector<sun::Instant> times;
    if (!start || !words.speed_kmh) times = times_of(line, path, result.zone);
    if (!words.speed_kmh) {
        const light::Walk walk = light::Walk::timed(std::move(places), std::move(times));
        return start ? walk.starting_at(*start) : walk;
    }
    return light::Walk::at_speed(std::move(places), start ? *start : times.front(),
                                 *words.speed_kmh / 3.6);
}

}  // namespace

void WalkWords::check(const dem::NamedLine& line, const std::string& path) const {
    if (std::ranges::any_of(line.places, has_time)) return;
    if (start.empty())
        bad_usage(
            fmt::format("--start: missing, as {} has no times; pass --start "
                        "2026-06-21T09:00 --speed 4",
                        path));
    if (!speed_kmh)
        bad_usage(
            fmt::format("--speed: missing, as {} has no times; pass --speed 4, in km/h", path));
}

Along along(const View& view, const WalkWords& words, const dem::NamedLine& line,
            const std::string& path, const dem::Posts& posts) {
    Along result;
    result.name = line.name;
    result.points = line.places.size();
    const light::Walk walk = walk_of(words, line, path, result);
    light::WalkOptions options;
    options.horizon = view.horizon({});
    options.air = [&](const geo::Geodetic& place) { return view.air(place); };
    options.highest_m = view.highest_m;
    result.air = view.refraction.value_or("standard") == "standard"
                     ? "integrated ICAO standard atmosphere over the ground there"
                     : view.air(walk.places().front()).description();
    result.found = light::light_along(posts, walk, options);
    return result;
}

std::vector<WalkHour> hours_of(const Along& result) {
    constexpr double kHour_s = 3600;
    const std::vector<light::WalkStretch>& stretches = result.found.stretches;
    const sun::Instant first = stretches.front().from.utc, last = stretches.back().to.utc;
    const sun::CivilTime wall = result.zone.local(first).wall;
    std::vector<WalkHour> hours;
    auto stretch = stretches.begin();
    for (sun::Instant begin = first - 60.0 * wall.minute - wall.second; begin < last;
         begin = begin + kHour_s) {
        WalkHour hour{.begin = begin};
        const sun::Instant end = begin + kHour_s;
        for (; stretch != stretches.end(); ++stretch) {
            const double time_s =
                std::min(stretch->to.utc, end) - std::max(stretch->from.utc, begin);
            if (time_s > 0) hour.time_s[static_cast<std::size_t>(stretch->light)] += time_s;
            if (stretch->to.utc > end) break;  // goes on in the next hour
        }
        hours.push_back(hour);
    }
    return hours;
}

std::string json_of(const Along& result, bool by_hour) {
    const light::LightAlong& found = result.found;
    auto json = json_of_shape<ordered_json>("sun-along");
    json["name"] = result.name;
    json["zone"] = result.zone.name();
    add_assumption(json, result.assumption);
    json["definition"] = found.definition;
    json["refraction"] = result.air;
    json["spacing_m"] = found.spacing_m;
    json["step_s"] = found.step_s;
    json["length_m"] = found.length_m;
    json["duration_h"] = found.duration_s / 3600;
    for (std::size_t i = 0; i < light::kWalkLights; ++i) {
        const light::WalkSum& sum = found.sums[i];
        json[std::string(light::name_of(static_cast<light::WalkLight>(i)))] = {
            {"duration_h", sum.time_s / 3600},
            {"length_m", sum.length_m},
            {"time_share", share(sum.time_s, found.duration_s)},
            {"length_share", share(sum.length_m, found.length_m)}};
    }
    if (by_hour) {
        ordered_json& hours = json["hours"] = ordered_json::array();
        for (const WalkHour& hour : hours_of(result)) {
            ordered_json& row = hours.emplace_back();
            row["time"] = sun::to_iso(hour.begin, result.zone);
            for (std::size_t i = 0; i < light::kWalkLights; ++i)
                row[fmt::format("{}_min", light::name_of(static_cast<light::WalkLight>(i)))] =
                    hour.time_s[i] / 60;
        }
        return json.dump();
    }
    ordered_json& stretches = json["stretches"] = ordered_json::array();
    for (const light::WalkStretch& stretch : found.stretches)
        stretches.push_back({{"light", light::name_of(stretch.light)},
                             {"from", moment_json(stretch.from, result.zone)},
                             {"to", moment_json(stretch.to, result.zone)}});
    return json.dump();
}

}  // namespace relevo::report
