#include "sun/position_table.h"

#include <cmath>

#include <erfam.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "sun/apparent.h"
#include "sun/interpolate.h"
#include "sun/moon_ephemeris.h"
#include "sun/position.h"

namespace relevo::sun {

namespace {

constexpr double kJ2000_days = 10957.5;  // since 1970-01-01T00
constexpr int kMoonNodesPerDay = 4;
// One node more on each side than the interpolation needs.
constexpr int kNodesBefore = 3, kNodesAfter = 4;

std::int64_t day_of(Instant instant) {
    const std::int64_t us = instant.unix_us();
    return (us >= 0 ? us : us - (kDay_us - 1)) / kDay_us;
}

glm::dvec3 geocentric_au(Body body, double jd1, double jd2) {
    const SolarEphemeris ephemeris(jd1, jd2);
    if (body == Body::Sun) return ephemeris.apparent_au();
    return apparent_moon_m(jd1, jd2, ephemeris) / ERFA_DAU;
}

}  // namespace

PositionTable::PositionTable(Instant from, Instant to, const EarthRotation& rotation, Body body)
    : from_(from),
      to_(to),
      body_(body),
      first_day_(day_of(from)),
      nodes_per_day_(body == Body::Sun ? 1 : kMoonNodesPerDay) {
    if (to < from)
        bad_input(
            fmt::format("sun: from {} to {}: ends before it begins", to_iso(from), to_iso(to)));
    check_year(from);
    check_year(to);
    const std::int64_t last_day = day_of(to);
    for (std::int64_t day = first_day_; day <= last_day; ++day) {
        const Instant midnight = Instant::from_unix_us(day * kDay_us);
        // A millisecond before the next midnight, where a leap second may be waiting.
        constexpr double kAlmostADay_s = kDay_s - 1e-3;
        const EarthOrientation begin = rotation.at(midnight);
        const EarthOrientation end = rotation.at(midnight + kAlmostADay_s);
        days_.push_back({begin.tt_minus_utc_s, begin.ut1_minus_utc_s,
                         (end.ut1_minus_utc_s - begin.ut1_minus_utc_s) / kAlmostADay_s,
                         begin.pole_x_rad, begin.pole_y_rad});
    }
    const auto node_of = [&](Instant utc, double tt_minus_utc_s) {
        const double s = (utc - Instant::from_unix_us(first_day_ * kDay_us)) + tt_minus_utc_s;
        return static_cast<std::int64_t>(std::floor(s / kDay_s * nodes_per_day_));
    };
    first_node_ = node_of(from, days_.front().tt_minus_utc_s) - kNodesBefore;
    const std::int64_t last_node = node_of(to, days_.back().tt_minus_utc_s) + kNodesAfter;
    for (std::int64_t node = first_node_; node <= last_node; ++node) {
        const double day = std::floor(static_cast<double>(node) / nodes_per_day_);
        nodes_.push_back(geocentric_au(body, kUnixEpoch_jd + static_cast<double>(first_day_) + day,
                                       static_cast<double>(node) / nodes_per_day_ - day));
    }
}

glm::dvec3 PositionTable::vector_au(Instant utc, const Observer& observer) const {
    if (utc < from_ || utc > to_)
        failed(fmt::format("sun: {}: outside the table, which is from {} to {}", to_iso(utc),
                           to_iso(from_), to_iso(to_)));
    const std::int64_t utc_us = utc.unix_us();
    const std::int64_t first_us = first_day_ * kDay_us;
    const std::int64_t index = (utc_us - first_us) / kDay_us;
    const double of_day_s = static_cast<double>(utc_us - first_us - index * kDay_us) * 1e-6;
    const Day& day = days_[static_cast<std::size_t>(index)];

    // TT is at most 3 s behind UTC (1900) and two minutes ahead of it (2100).
    const double tt_days = static_cast<double>(index) + (of_day_s + day.tt_minus_utc_s) / kDay_s;
    const double at = tt_days * nodes_per_day_;
    const double node = std::floor(at);
    const QuinticWeights weights(at - node);
    const glm::dvec3* n =
        &nodes_[static_cast<std::size_t>(static_cast<std::int64_t>(node) - first_node_)];
    const glm::dvec3 cirs = weights.w[0] * n[-2] + weights.w[1] * n[-1] + weights.w[2] * n[0] +
                            weights.w[3] * n[1] + weights.w[4] * n[2] + weights.w[5] * n[3];

    // The Earth rotation angle of IAU 2000, whole turns taken out.
    const double ut1_day = (of_day_s + day.ut1_minus_utc_s + day.ut1_rate * of_day_s) / kDay_s;
    const double since_j2000 = static_cast<double>(first_day_ + index) - kJ2000_days + ut1_day;
    const double turns = 0.7790572732640 + 0.00273781191135448 * since_j2000 + ut1_day + 0.5;
    const double angle_rad = 2 * kPi * (turns - std::floor(turns));
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double x = c * cirs.x + s * cirs.y, y = c * cirs.y - s * cirs.x;
    const glm::dvec3 itrs(x + day.pole_x_rad * cirs.z, y - day.pole_y_rad * cirs.z,
                          cirs.z - day.pole_x_rad * x + day.pole_y_rad * y);

    glm::dvec3 enu = observer.enu(itrs - observer.position_au());
    // Diurnal aberration: towards where the place is going. It keeps the length to 1e-12.
    const double distance_au = glm::length(enu);
    enu.x += observer.eastward_beta() * distance_au;
    return enu * (distance_au / glm::length(enu));
}

glm::dvec3 PositionTable::direction(Instant utc, const Observer& observer) const {
    return glm::normalize(vector_au(utc, observer));
}

}  // namespace relevo::sun
