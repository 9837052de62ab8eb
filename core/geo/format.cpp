#include "geo/format.h"

#include <cassert>
#include <cmath>

#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <fmt/format.h>

#include "base/units.h"

namespace relevo::geo {
namespace {

struct Projected {
    int zone = 0;  // 0 is UPS
    bool north = true;
    double easting_m = 0;
    double northing_m = 0;
};

Projected project(const Geodetic& place) {
    Projected p;
    GeographicLib::UTMUPS::Forward(degrees(place.lat_rad), degrees(place.lon_rad), p.zone, p.north,
                                   p.easting_m, p.northing_m);
    return p;
}

}  // namespace

std::string utm_text(const Geodetic& place) {
    const Projected p = project(place);
    const char hemisphere = p.north ? 'N' : 'S';
    const std::string zone =
        p.zone == 0 ? fmt::format("UPS {}", hemisphere) : fmt::format("{}{}", p.zone, hemisphere);
    return fmt::format("{} {:.0f} E {:.0f} N", zone, p.easting_m, p.northing_m);
}

std::string mgrs_text(const Geodetic& place, int digits) {
    assert(digits >= 0 && digits <= 5);
    const Projected p = project(place);
    std::string text;
    // The latitude is given too, so that rounding of the northing cannot move a place that is on
    // the limit of a band into the next one.
    GeographicLib::MGRS::Forward(p.zone, p.north, p.easting_m, p.northing_m, degrees(place.lat_rad),
                                 digits, text);
    return text;
}

std::string degrees_text(const Geodetic& place) {
    return fmt::format("{:.5f} {} {:.5f} {}", std::abs(degrees(place.lat_rad)),
                       place.lat_rad < 0 ? 'S' : 'N', std::abs(degrees(place.lon_rad)),
                       place.lon_rad < 0 ? 'W' : 'E');
}

const char* compass_point(double azimuth_deg) {
    constexpr const char* kPoints[] = {"N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
                                       "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"};
    return kPoints[static_cast<int>(azimuth_deg / 22.5 + 0.5) % 16];
}

}  // namespace relevo::geo
