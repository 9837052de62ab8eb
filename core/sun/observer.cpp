#include "sun/observer.h"

#include <cmath>

#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/units.h"

namespace relevo::sun {

void check_place(const geo::Geodetic& place) {
    const double lat_deg = degrees(place.lat_rad);
    // A pole in radians may come out an ulp beyond.
    if (!(std::abs(place.lat_rad) <= kPi / 2 + 1e-12))
        bad_input(
            fmt::format("sun: latitude {:.10g}: no such place, expected -90 to 90 "
                        "degrees; latitude comes before longitude",
                        lat_deg));
    if (!std::isfinite(place.lon_rad))
        bad_input(
            fmt::format("sun: longitude {}: no such place, expected degrees east", place.lon_rad));
    if (!(place.height_m >= -12e3 && place.height_m <= 100e3))
        bad_input(
            fmt::format("sun: height {:.10g} m: no place on Earth, expected -12000 "
                        "to 100000 m above the ellipsoid",
                        place.height_m));
}

Observer::Observer(const geo::Geodetic& place) : place_(place) {
    check_place(place);
    double xyz_m[3];
    eraGd2gc(ERFA_WGS84, place.lon_rad, place.lat_rad, place.height_m, xyz_m);
    position_au_ = glm::dvec3(xyz_m[0], xyz_m[1], xyz_m[2]) / ERFA_DAU;
    const double sin_lat = std::sin(place.lat_rad), cos_lat = std::cos(place.lat_rad);
    const double sin_lon = std::sin(place.lon_rad), cos_lon = std::cos(place.lon_rad);
    const glm::dvec3 east(-sin_lon, cos_lon, 0);
    const glm::dvec3 north(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
    const glm::dvec3 up(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
    to_enu_ = glm::transpose(glm::dmat3(east, north, up));
    constexpr double kTurn_rad_s = 7.292115855306589e-5;  // SOFA pvtob: 1.00273781191135448 turns/d
    eastward_beta_ = kTurn_rad_s * std::hypot(xyz_m[0], xyz_m[1]) / ERFA_CMPS;
}

}  // namespace relevo::sun
