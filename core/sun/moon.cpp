#include "sun/moon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <erfa.h>
#include <erfam.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/apparent.h"
#include "sun/moon_ephemeris.h"
#include "sun/observer.h"

namespace relevo::sun {
namespace {

constexpr double kSynodicMonth_d = 29.530588861;  // Meeus, Astronomical Algorithms, 49.1
constexpr double kPhaseRate_rad_s = 2 * kPi / (kSynodicMonth_d * kDay_s);

/// Apparent ecliptic longitude, true ecliptic and equinox of date, of a vector in CIRS.
double longitude_rad(const glm::dvec3& cirs, const Epoch& epoch, const SolarEphemeris& axes) {
    double in_longitude = 0, in_obliquity = 0;
    eraNut00b(epoch.tt_jd[0], epoch.tt_jd[1], &in_longitude, &in_obliquity);
    const double obliquity = eraObl06(epoch.tt_jd[0], epoch.tt_jd[1]) + in_obliquity;
    const double ra = axes.right_ascension_rad(cirs), dec = declination_rad(cirs);
    return std::atan2(
        std::sin(ra) * std::cos(dec) * std::cos(obliquity) + std::sin(dec) * std::sin(obliquity),
        std::cos(ra) * std::cos(dec));
}

/// @param moon  apparent, from the Earth's centre
double phase_longitude_rad(const Epoch& epoch, const SolarEphemeris& axes, const glm::dvec3& moon) {
    return eraAnp(longitude_rad(moon, epoch, axes) -
                  longitude_rad(axes.apparent_au(), epoch, axes));
}

/// Also outside of 1900-2100, by the month that moon_age_d() looks back.
double phase_longitude_rad(Instant utc) {
    const double utc_s = utc - Instant{};
    Epoch epoch;
    epoch.tt_jd[0] = kUnixEpoch_jd;
    epoch.tt_jd[1] = (utc_s + EarthRotation::built_in().at(utc).tt_minus_utc_s) / kDay_s;
    const SolarEphemeris axes(epoch.tt_jd[0], epoch.tt_jd[1]);
    return phase_longitude_rad(epoch, axes, apparent_moon_m(epoch.tt_jd[0], epoch.tt_jd[1], axes));
}

/// When the phase longitude is `wanted`, within half a month of `near`.
Instant when_phase_is(double wanted_rad, Instant near) {
    // The moon is up to a fifth slower or faster than on average: each pass leaves a fifth.
    for (int pass = 0; pass < 20; ++pass) {
        const double ahead = std::remainder(wanted_rad - phase_longitude_rad(near), 2 * kPi);
        near = near + ahead / kPhaseRate_rad_s;
        if (std::abs(ahead) / kPhaseRate_rad_s < 0.05) break;
    }
    return near;
}

/// Angle at `centre` of the direction towards `to`, from `up` counterclockwise as seen from the
/// origin [0, 2 pi). All unit vectors.
double angle_at(const glm::dvec3& centre, const glm::dvec3& to, const glm::dvec3& up) {
    const glm::dvec3 left = glm::cross(up, centre);  // of somebody who looks there, `up` upwards
    return eraAnp(std::atan2(glm::dot(to, left), glm::dot(to, up - glm::dot(up, centre) * centre)));
}

}  // namespace

MoonPosition moon_position(const Epoch& epoch, const geo::Geodetic& place) {
    const Observer observer(place);
    const SolarEphemeris axes(epoch.tt_jd[0], epoch.tt_jd[1]);
    const TurnedEarth earth(epoch);
    const TurnedEarth::Motion motion = earth.motion(place);
    const glm::dvec3 sun = axes.apparent_au(motion.position_m, motion.velocity_m_s);
    const glm::dvec3 from_centre_m = apparent_moon_m(epoch.tt_jd[0], epoch.tt_jd[1], axes);
    glm::dvec3 moon = (from_centre_m - motion.position_m) / ERFA_DAU;
    // Diurnal aberration, which the length does not have.
    const double distance_au = glm::length(moon);
    moon = distance_au * glm::normalize(moon / distance_au + motion.velocity_m_s / ERFA_CMPS);

    MoonPosition result{sky_position(moon, Body::Moon, observer, earth, axes)};
    const glm::dvec3 to_sun = glm::normalize(sun), to_moon = glm::normalize(moon);
    const glm::dvec3 from_moon = glm::normalize(sun - moon);
    result.phase_angle_rad = std::acos(std::clamp(glm::dot(from_moon, -to_moon), -1.0, 1.0));
    result.illuminated_fraction = (1 + std::cos(result.phase_angle_rad)) / 2;
    result.elongation_rad =
        std::atan2(glm::length(glm::cross(to_sun, to_moon)), glm::dot(to_sun, to_moon));
    result.bright_limb_rad = angle_at(to_moon, to_sun, {0, 0, 1});
    result.bright_limb_from_zenith_rad = angle_at(
        result.direction, glm::normalize(observer.enu(earth.itrs(sun))), glm::dvec3(0, 0, 1));
    result.phase_longitude_rad = phase_longitude_rad(epoch, axes, from_centre_m);
    return result;
}

MoonPosition moon_position(Instant utc, const geo::Geodetic& place) {
    return moon_position(Epoch::at(utc), place);
}

std::string_view name_of(Phase phase) {
    constexpr std::array<std::string_view, 4> kNames{"new moon", "first quarter", "full moon",
                                                     "last quarter"};
    return kNames[static_cast<std::size_t>(phase)];
}

std::string_view phase_name(double phase_longitude_rad) {
    constexpr double kNear_rad = radians(6);
    const double quarters = eraAnp(phase_longitude_rad) / (kPi / 2);
    const int nearest = static_cast<int>(std::lround(quarters)) % 4;
    if (std::abs(std::remainder(quarters - nearest, 4.0)) * kPi / 2 <= kNear_rad)
        return name_of(static_cast<Phase>(nearest));
    constexpr std::array<std::string_view, 4> kBetween{"waxing crescent", "waxing gibbous",
                                                       "waning gibbous", "waning crescent"};
    return kBetween[static_cast<std::size_t>(quarters) % 4];
}

std::vector<PhaseTime> moon_phases(Instant from, Instant to) {
    check_year(from);
    check_year(to);
    std::vector<PhaseTime> found;
    constexpr double kQuarter_s = kSynodicMonth_d * kDay_s / 4;
    const double begin_rad = phase_longitude_rad(from);
    int quarter = static_cast<int>(std::ceil(begin_rad / (kPi / 2)));
    Instant near = from + (quarter * kPi / 2 - begin_rad) / kPhaseRate_rad_s;
    // A quarter lasts 6.6 to 8.3 days.
    while (near < to + kDay_s) {
        const Instant at = when_phase_is(quarter * kPi / 2, near);
        if (at >= from && at <= to) found.push_back({static_cast<Phase>(quarter % 4), at});
        if (at > to) break;
        near = at + kQuarter_s;
        ++quarter;
    }
    return found;
}

double moon_age_d(Instant utc) {
    check_year(utc);
    const double since_rad = phase_longitude_rad(utc);
    Instant last = when_phase_is(0, utc - since_rad / kPhaseRate_rad_s);
    if (last > utc) last = when_phase_is(0, last - kSynodicMonth_d * kDay_s);
    return (utc - last) / kDay_s;
}

}  // namespace relevo::sun
