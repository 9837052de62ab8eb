#include "sun/position.h"

#include <cmath>

#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "sun/apparent.h"
#include "sun/observer.h"

namespace relevo::sun {

namespace {

/// The Julian date of the instant plus seconds, in two parts: midnight, and the fraction of a day.
void set_julian_date(Instant instant, double plus_s, double jd[2]) {
    const std::int64_t us = instant.unix_us();
    const std::int64_t day = (us >= 0 ? us : us - (kDay_us - 1)) / kDay_us;
    jd[0] = kUnixEpoch_jd + static_cast<double>(day);
    jd[1] = (static_cast<double>(us - day * kDay_us) * 1e-6 + plus_s) / kDay_s;
}

Geocentric geocentric(const Epoch& epoch, const SolarEphemeris& ephemeris) {
    const glm::dvec3 sun = ephemeris.apparent_au();
    const double turned_rad = eraEra00(epoch.ut1_jd[0], epoch.ut1_jd[1]);
    const double hour_angle_rad = turned_rad - std::atan2(sun.y, sun.x);
    // The Julian day begins at noon, so its fraction is the mean sun's hour angle.
    const double mean_rad =
        2 * kPi * (std::fmod(epoch.ut1_jd[0], 1.0) + std::fmod(epoch.ut1_jd[1], 1.0));
    Geocentric result;
    result.right_ascension_rad = ephemeris.right_ascension_rad(sun);
    result.declination_rad = declination_rad(sun);
    result.distance_au = glm::length(sun);
    const double ra = result.right_ascension_rad, dec = result.declination_rad;
    // The mean obliquity will do: the sun is so near the ecliptic (1.2 arcsec) that its longitude
    // does not depend on it.
    const double obliquity = eraObl06(epoch.tt_jd[0], epoch.tt_jd[1]);
    result.longitude_rad = eraAnp(std::atan2(
        std::sin(ra) * std::cos(dec) * std::cos(obliquity) + std::sin(dec) * std::sin(obliquity),
        std::cos(ra) * std::cos(dec)));
    result.equation_of_time_s = eraAnpm(hour_angle_rad - mean_rad) / (2 * kPi) * kDay_s;
    return result;
}

/// Of a unit vector; exact near the zenith, where the arc sine is not.
double angle_above(double up, double east, double north) {
    return std::atan2(up, std::hypot(east, north));
}

}  // namespace

bool is_in_years(Instant instant) {
    constexpr double kSlack_s = 2 * kDay_s;
    static const Instant first = Instant::from_utc({{kFirstYear, 1, 1}}) - kSlack_s;
    static const Instant last = Instant::from_utc({{kLastYear + 1, 1, 1}}) + kSlack_s;
    return instant >= first && instant < last;
}

void check_year(Instant instant) {
    if (!is_in_years(instant))
        bad_input(fmt::format("time: {}: sun and moon are computed for the years {} to {}",
                              to_iso(instant), kFirstYear, kLastYear));
}

Epoch Epoch::at(Instant utc, const EarthRotation& rotation) {
    check_year(utc);
    const EarthOrientation earth = rotation.at(utc);
    Epoch epoch;
    set_julian_date(utc, earth.tt_minus_utc_s, epoch.tt_jd);
    set_julian_date(utc, earth.ut1_minus_utc_s, epoch.ut1_jd);
    epoch.pole_x_rad = earth.pole_x_rad;
    epoch.pole_y_rad = earth.pole_y_rad;
    return epoch;
}

Epoch Epoch::from_utc(Instant utc, double ut1_minus_utc_s) {
    check_year(utc);
    Epoch epoch;
    set_julian_date(utc, tai_minus_utc_s(utc) + ERFA_TTMTAI, epoch.tt_jd);
    set_julian_date(utc, ut1_minus_utc_s, epoch.ut1_jd);
    return epoch;
}

Epoch Epoch::from_ut1(Instant ut1, double delta_t_s) {
    check_year(ut1);
    Epoch epoch;
    set_julian_date(ut1, delta_t_s, epoch.tt_jd);
    set_julian_date(ut1, 0, epoch.ut1_jd);
    return epoch;
}

Geocentric geocentric(const Epoch& epoch) {
    return geocentric(epoch, SolarEphemeris(epoch.tt_jd[0], epoch.tt_jd[1]));
}

double azimuth_of(const glm::dvec3& direction) {
    return eraAnp(std::atan2(direction.x, direction.y));
}

double elevation_of(const glm::dvec3& direction) {
    return angle_above(direction.z, direction.x, direction.y);
}

double semidiameter_rad(double distance_au, Body body) {
    const double radius_m = body == Body::Sun ? kSunRadius_m : kMoonRadius_m;
    return std::asin(radius_m / (distance_au * ERFA_DAU));
}

SkyPosition sky_position(const glm::dvec3& cirs_au, Body body, const Observer& observer,
                         const TurnedEarth& earth, const SolarEphemeris& axes) {
    SkyPosition sky;
    sky.direction = glm::normalize(observer.enu(earth.itrs(cirs_au)));
    sky.azimuth_rad = azimuth_of(sky.direction);
    sky.elevation_rad = elevation_of(sky.direction);
    sky.distance_au = glm::length(cirs_au);
    sky.right_ascension_rad = axes.right_ascension_rad(cirs_au);
    sky.declination_rad = declination_rad(cirs_au);
    sky.hour_angle_rad =
        eraAnpm(earth.angle_rad() + observer.place().lon_rad - std::atan2(cirs_au.y, cirs_au.x));
    sky.semidiameter_rad = semidiameter_rad(sky.distance_au, body);
    return sky;
}

Position position(const Epoch& epoch, const geo::Geodetic& place) {
    const Observer observer(place);
    const SolarEphemeris ephemeris(epoch.tt_jd[0], epoch.tt_jd[1]);
    const TurnedEarth earth(epoch);
    const TurnedEarth::Motion motion = earth.motion(place);
    const glm::dvec3 cirs = ephemeris.apparent_au(motion.position_m, motion.velocity_m_s);
    Position result{sky_position(cirs, Body::Sun, observer, earth, ephemeris)};
    result.equation_of_time_s = geocentric(epoch, ephemeris).equation_of_time_s;
    return result;
}

Position position(Instant utc, const geo::Geodetic& place) {
    return position(Epoch::at(utc), place);
}

}  // namespace relevo::sun
