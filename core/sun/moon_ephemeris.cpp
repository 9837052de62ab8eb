#include "sun/moon_ephemeris.h"

#include <cmath>
#include <mutex>

#include <erfa.h>
#include <erfam.h>
#include <glm/geometric.hpp>
#include <libnova/lunar.h>

#include "base/units.h"

namespace relevo::sun {
namespace {

/// The series of ELP 2000-82B [m]: mean ecliptic and inertial equinox of J2000.
glm::dvec3 series_m(double tt_jd) {
    // libnova keeps its last result in static variables.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    constexpr double kAllTerms = 0;
    ln_rect_posn km{};
    ln_get_lunar_geo_posn(tt_jd, &km, kAllTerms);
    return glm::dvec3(km.X, km.Y, km.Z) * 1000.0;
}

/// Difference of the mean longitudes, ELP/MPP02 minus ELP 2000-82B, which was fitted to DE200 with
/// its weaker tides: the constants DW1(0), DW1(1), DW1(2) for lunar laser ranging, and the
/// difference of the two theories' secular acceleration, -6.8084 to -5.8883.
double longitude_correction_rad(double centuries) {
    constexpr double kAcceleration = -6.8084 - -5.8883 - 0.03794;
    return (-0.10525 + centuries * (-0.32311 + centuries * kAcceleration)) * kArcsecond_rad;
}

}  // namespace

glm::dvec3 moon_icrs_m(double tt_jd1, double tt_jd2) {
    const double centuries = ((tt_jd1 - ERFA_DJ00) + tt_jd2) / ERFA_DJC;
    const glm::dvec3 v = series_m(tt_jd1 + tt_jd2);
    const double turn = longitude_correction_rad(centuries);
    const double x = v.x * std::cos(turn) - v.y * std::sin(turn);
    const double y = v.x * std::sin(turn) + v.y * std::cos(turn);
    // To the mean equator and equinox of FK5, which ICRS follows within 0.03 arcsec: the notice of
    // ELP 2000-82B, catalogue VI/79 of the Centre de Donnees astronomiques de Strasbourg.
    return {x + 4.37913e-7 * y - 1.89859e-7 * v.z,
            -4.77299e-7 * x + 0.917482137607 * y - 0.397776981701 * v.z,
            0.397776981701 * y + 0.917482137607 * v.z};
}

glm::dvec3 apparent_moon_m(double tt_jd1, double tt_jd2, const SolarEphemeris& axes) {
    double pv_au[2][3];
    eraMoon98(tt_jd1, tt_jd2, pv_au);  // good to 1e-5 of the distance
    const glm::dvec3 now_au(pv_au[0][0], pv_au[0][1], pv_au[0][2]);
    const double light_time_d = glm::length(now_au) * ERFA_AULT / ERFA_DAYSEC;
    return axes.cirs(moon_icrs_m(tt_jd1, tt_jd2 - light_time_d));
}

}  // namespace relevo::sun
