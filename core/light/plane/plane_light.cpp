#include "light/plane/plane_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "light/point/clear_sky.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {

/// The sun over the place at one time.
struct PlaneLight::Sun {
    glm::dvec3 direction{0};  // of the light
    double true_rad = 0, azimuth_rad = 0, elevation_rad = 0, distance_au = 1;
};

namespace {

/// When the sun is up and lit, in a run of rows.
struct Sunshine {
    std::vector<LitInterval> up;
    const std::vector<LitInterval>* lit;  // null: wherever it is up
    std::vector<sun::Instant> edges{};    // of both, in order

    void add_edges(const std::vector<LitInterval>& intervals) {
        for (const LitInterval& interval : intervals)
            edges.insert(edges.end(), {interval.begin.utc, interval.end.utc});
        std::ranges::sort(edges);
    }
};

bool covers(const std::vector<LitInterval>& intervals, sun::Instant utc) {
    const auto next = std::ranges::upper_bound(
        intervals, utc, {}, [](const LitInterval& interval) { return interval.begin.utc; });
    return next != intervals.begin() && utc < std::prev(next)->end.utc;
}

/// A time in which the sun is up, and lit or not.
struct Part {
    sun::TimeSpan span;
    bool lit;
};

/// What of a row's time has the sun.
struct Parts {
    std::vector<Part> parts;
    double up_s = 0, lit_s = 0;
    sun::Instant middle;  // of the longest part in which it is up
};

Parts within(const Sunshine& sunshine, const sun::TimeSpan& span) {
    Parts found;
    sun::TimeSpan up;
    double longest_s = 0;
    auto edge = std::ranges::upper_bound(sunshine.edges, span.begin);
    for (sun::Instant from = span.begin, to; from < span.end; from = to) {
        to = edge == sunshine.edges.end() ? span.end : std::min(*edge++, span.end);
        const sun::TimeSpan part{from, to};
        const sun::Instant middle = from + part.length_s() / 2;
        if (to <= from || !covers(sunshine.up, middle)) continue;
        const bool lit = !sunshine.lit || covers(*sunshine.lit, middle);
        found.parts.push_back({part, lit});
        found.up_s += part.length_s();
        found.lit_s += lit ? part.length_s() : 0;
        up = {up.end == from ? up.begin : from, to};
        if (up.length_s() <= longest_s) continue;
        longest_s = up.length_s();
        found.middle = up.begin + longest_s / 2;
    }
    return found;
}

/// Calls visit(first, end) for rows that follow each other without a gap.
template <typename Row, typename Visit>
void each_run(const std::vector<Row>& rows, const Visit& visit) {
    for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
        for (end = first + 1; end < rows.size() && rows[end].span.begin == rows[end - 1].span.end;)
            ++end;
        visit(first, end);
    }
}

constexpr double kStep_s = 60;  // in which the cosine is a line to 1e-6

/// Calls visit(time, length in s) for the middles of equal steps.
template <typename Visit>
void each_step(const sun::TimeSpan& span, const Visit& visit) {
    const int steps = std::max(1, static_cast<int>(std::ceil(span.length_s() / kStep_s)));
    const double step_s = span.length_s() / steps;
    for (int k = 0; k < steps; ++k)
        visit(span.begin + (k + 0.5) * step_s, step_s);
}

}  // namespace

PlaneLight::PlaneLight(const PlaneOptions& options, const DirectLight& level,
                       const DirectLight* terrain)
    : options_(options),
      level_(level),
      terrain_(terrain),
      level_sky_(open_sky(options.plane)),
      sky_(terrain ? open_sky(options.plane, terrain->skyline()) : level_sky_) {}

PlaneLight::Sun PlaneLight::sun_at(const sun::PositionTable& table, sun::Instant utc) const {
    const glm::dvec3 vector = table.vector_au(utc, level_.observer());
    Sun sun;
    sun.distance_au = glm::length(vector);
    sun.direction = vector / sun.distance_au;
    sun.true_rad = sun.elevation_rad = sun::elevation_of(vector);
    sun.azimuth_rad = sun::azimuth_of(vector);
    if (!level_.refraction().bends()) return sun;
    sun.elevation_rad = level_.refraction().apparent_rad(sun.true_rad);
    const double level = std::cos(sun.elevation_rad);
    sun.direction = {level * std::sin(sun.azimuth_rad), level * std::cos(sun.azimuth_rad),
                     std::sin(sun.elevation_rad)};
    return sun;
}

/// By mean solar time, from 1.
int PlaneLight::day_of_year(sun::Instant utc) const {
    const double solar_s = degrees(level_.observer().place().lon_rad) * 240;
    const sun::Date date = (utc + solar_s).utc().date;
    return 1 + sun::days_between({date.year, 1, 1}, date);
}

/// Adds the light of sky and ground to an hour that has its beam.
/// @param sun  where the models take it; where it is not up, not used
void PlaneLight::add_sky(const Sun& sun, double open_beam, PlaneHour& hour) const {
    SkyFactors factors{level_sky_, 0, 0};
    if (hour.up_s > 0) {
        hour.azimuth_rad = sun.azimuth_rad;
        hour.elevation_rad = sun.elevation_rad;
        const SkySun seen{kPi / 2 - sun.true_rad, sun.direction.z,
                          glm::dot(sun.direction, options_.plane.normal()),
                          irradiance_above_air(day_of_year(hour.span.begin))};
        factors = sky_factors(options_.sky, options_.plane, seen, hour.dni, hour.dhi);
    }
    const auto diffuse = [&](double lit, double sky) {
        return hour.dhi * std::max(0.0, factors.isotropic * sky + factors.circumsolar * lit +
                                            factors.band * sky);
    };
    const double lit = hour.up_s > 0 ? hour.lit_s / hour.up_s : 0;
    hour.diffuse = diffuse(lit, sky_ / level_sky_);
    const double ground_w_m2 = options_.albedo * hour.ghi;
    hour.reflected = ground_w_m2 * std::max(0.0, 1 - sky_);
    hour.open_global = open_beam + diffuse(1, 1) + ground_w_m2 * (1 - level_sky_);
}

void PlaneLight::add_instant(const sun::PositionTable& table, sun::Instant utc,
                             PlaneHour& hour) const {
    const Sun sun = sun_at(table, utc);
    double open_beam = 0;
    if (level_.lit_at(utc, table)) {
        hour.up_s = hour.span.length_s();
        open_beam = hour.dni * std::max(0.0, glm::dot(sun.direction, options_.plane.normal()));
        if (!terrain_ || terrain_->lit_at(utc, table)) {
            hour.lit_s = hour.up_s;
            hour.beam = open_beam;
        }
    }
    add_sky(sun, open_beam, hour);
}

/// Calls fill(table, parts, hour) for all hours, with a table for each run of them without gaps.
template <typename Fill>
PlaneLight::Result PlaneLight::by_runs(std::vector<PlaneHour> hours, const Fill& fill) const {
    Result result;
    each_run(hours, [&](std::size_t first, std::size_t end) {
        const sun::TimeSpan run{hours[first].span.begin, hours[end - 1].span.end};
        const sun::PositionTable table(run.begin, run.end);
        LightDay lit;
        if (terrain_) {
            lit.span = run;
            lit.lit = terrain_->lit_within(run, table);
            for (const LitInterval& interval : lit.lit)
                lit.not_known_s += interval.not_known_s();
        }
        Sunshine sunshine{level_.lit_within(run, table), terrain_ ? &lit.lit : nullptr};
        sunshine.add_edges(sunshine.up);
        sunshine.add_edges(lit.lit);
        for (std::size_t i = first; i < end; ++i)
            fill(table, within(sunshine, hours[i].span), hours[i]);
        if (terrain_) result.lit.push_back(std::move(lit));
    });
    std::ranges::sort(result.lit, {}, [](const LightDay& run) { return run.span.begin; });
    result.hours = std::move(hours);
    return result;
}

PlaneLight::Result PlaneLight::of(const std::vector<Irradiance>& rows,
                                  const std::optional<double>& instant_s) const {
    std::vector<PlaneHour> hours;
    for (const Irradiance& row : rows)
        hours.push_back({.span = row.span, .ghi = row.ghi, .dni = row.dni, .dhi = row.dhi});
    const glm::dvec3 normal = options_.plane.normal();
    return by_runs(std::move(hours), [&](const sun::PositionTable& table, const Parts& parts,
                                         PlaneHour& hour) {
        if (instant_s) return add_instant(table, hour.span.begin + *instant_s, hour);
        hour.up_s = parts.up_s;
        hour.lit_s = parts.lit_s;
        double open_s = 0, lit_s = 0;  // times the cosine
        if (hour.dni > 0)
            for (const Part& part : parts.parts)
                each_step(part.span, [&](sun::Instant utc, double step_s) {
                    const double gain =
                        step_s * std::max(0.0, glm::dot(sun_at(table, utc).direction, normal));
                    open_s += gain;
                    if (part.lit) lit_s += gain;
                });
        if (open_s > 0) hour.beam = hour.dni * lit_s / parts.up_s;
        add_sky(parts.up_s > 0 ? sun_at(table, parts.middle) : Sun{},
                open_s > 0 ? hour.dni * open_s / parts.up_s : 0, hour);
    });
}

PlaneLight::Result PlaneLight::clear(const std::vector<sun::TimeSpan>& hours,
                                     const std::function<double(sun::Instant)>& linke) const {
    std::vector<PlaneHour> empty;
    for (const sun::TimeSpan& span : hours)
        empty.push_back({.span = span});
    const glm::dvec3 normal = options_.plane.normal();
    const double height_m = level_.observer().place().height_m;
    return by_runs(std::move(empty), [&](const sun::PositionTable& table, const Parts& parts,
                                         PlaneHour& hour) {
        hour.up_s = parts.up_s;
        hour.lit_s = parts.lit_s;
        if (parts.up_s == 0) return;
        const Sun middle = sun_at(table, parts.middle);
        const ClearSky sky(linke(hour.span.begin), middle.distance_au);
        double open_beam = 0;
        for (const Part& part : parts.parts)
            each_step(part.span, [&](sun::Instant utc, double step_s) {
                const Sun sun = sun_at(table, utc);
                const double share = step_s / hour.span.length_s();
                const double dni = share * sky.beam(sun.true_rad, height_m);
                const double dhi = share * sky.diffuse(sun.true_rad);
                const double gain = dni * std::max(0.0, glm::dot(sun.direction, normal));
                hour.dni += dni;
                hour.dhi += dhi;
                hour.ghi += dni * std::max(0.0, sun.direction.z) + dhi;
                open_beam += gain;
                if (part.lit) hour.beam += gain;
            });
        add_sky(middle, open_beam, hour);
    });
}

std::optional<PlaneLight::Misfit> PlaneLight::misfit(const std::vector<Irradiance>& rows,
                                                     const std::optional<double>& instant_s) const {
    constexpr std::array kShifts_h{0.0, -0.5, 0.5, -1.0, 1.0};
    std::array<double, kShifts_h.size()> off_wh{};
    double global_wh = 0, direct_wh = 0, dark_wh = 0, worst = 0;
    std::size_t worst_line = 0, dark_line = 0;
    const auto add = [&](const sun::PositionTable& table, const Irradiance& row) {
        const double length_h = row.span.length_s() / kHour_s;
        std::array<double, kShifts_h.size()> sines;  // of the elevation
        for (std::size_t k = 0; k < sines.size(); ++k) {
            sines[k] = sun_at(table, row.span.begin + kShifts_h[k] * kHour_s +
                                         instant_s.value_or(row.span.length_s() / 2))
                           .direction.z;
            off_wh[k] += length_h * std::abs(row.dni * std::max(0.0, sines[k]) + row.dhi - row.ghi);
        }
        global_wh += length_h * row.ghi;
        direct_wh += length_h * row.dni;
        if (row.dni > 0 && std::max({sines[0], sines[1], sines[2]}) <= 0) {
            if (dark_wh == 0) dark_line = row.line;
            dark_wh += length_h * row.dni;
        }
        const double off = std::abs(row.dni * std::max(0.0, sines[0]) + row.dhi - row.ghi);
        if (off <= worst) return;
        worst = off;
        worst_line = row.line;
    };
    each_run(rows, [&](std::size_t first, std::size_t end) {
        const sun::PositionTable table(rows[first].span.begin - 2 * kHour_s,
                                       rows[end - 1].span.end + 2 * kHour_s);
        for (std::size_t i = first; i < end; ++i)
            if (rows[i].ghi > 0 || rows[i].dni > 0) add(table, rows[i]);
    });
    if (dark_wh > 100 && dark_wh > 0.01 * direct_wh)
        return Misfit{dark_line, "direct irradiance, but the sun is down"};
    const auto best = std::ranges::min_element(off_wh);
    if (global_wh < 5000 || off_wh[0] < 0.015 * global_wh || *best > off_wh[0] / 3)
        return std::nullopt;
    return Misfit{worst_line,
                  fmt::format("direct and diffuse irradiance give the global one to {:.1f} %, but "
                              "to {:.1f} % with times moved by {:+} h",
                              100 * off_wh[0] / global_wh, 100 * *best / global_wh,
                              kShifts_h[static_cast<std::size_t>(best - off_wh.begin())])};
}

std::vector<PlaneSum> sums_by(SumBy by, const std::vector<PlaneHour>& hours, const sun::Zone& zone,
                              bool typical) {
    std::vector<PlaneSum> sums;
    std::map<std::tuple<int, int, int, int>, std::size_t> places;
    for (const PlaneHour& hour : hours) {
        const sun::CivilTime wall = zone.local(hour.span.begin).wall;
        const sun::Date& date = wall.date;
        const auto key = by == SumBy::Day     ? std::tuple(date.year, date.month, date.day, 0)
                         : by == SumBy::Month ? std::tuple(date.year, date.month, 0, 0)
                         : by == SumBy::Year  ? std::tuple(typical ? 0 : date.year, 0, 0, 0)
                                              : std::tuple(0, date.month, 0, wall.hour);
        const auto [place, is_new] = places.try_emplace(key, sums.size());
        if (is_new) sums.push_back({.date = date, .hour = wall.hour});
        PlaneSum& sum = sums[place->second];
        const double hours_long = hour.span.length_s() / kHour_s;
        sum.lit_s += hour.lit_s;
        sum.beam_wh += hours_long * hour.beam;
        sum.diffuse_wh += hours_long * hour.diffuse;
        sum.reflected_wh += hours_long * hour.reflected;
        sum.open_global_wh += hours_long * hour.open_global;
    }
    return sums;
}

}  // namespace relevo::light
