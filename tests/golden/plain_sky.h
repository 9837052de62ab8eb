#pragma once

#include <chrono>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/units.h"
#include "golden/pinhole.h"

/// Where sun and stars stand by formulas of a textbook, J. Meeus, Astronomical Algorithms, 1998
/// (M): without nutation and aberration, so within 0.02 degrees. Nothing here is the program's, nor
/// of the library that it takes its axes from.
namespace relevo::test {

/// A time of UTC.
struct Moment {
    int year, month, day, hour, minute;
    std::string iso() const {
        return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}Z", year, month, day, hour, minute);
    }
    /// Days since 2000 January 1, 12 h.
    double days() const {
        const std::chrono::sys_days date{std::chrono::year{year} / static_cast<unsigned>(month) /
                                         static_cast<unsigned>(day)};
        return date.time_since_epoch().count() - 10957.5 + (hour + minute / 60.0) / 24;
    }
};

struct Site {
    double lat_deg, lon_deg;
};

struct Equatorial {
    double ra_deg, dec_deg;
};

/// From the equator of J2000 to that of the date (M 21.3, 21.4).
inline Equatorial precessed(const Equatorial& j2000, double days) {
    const double t = days / 36525, arcsec = radians(1.0 / 3600);
    const double zeta = (2306.2181 * t + 0.30188 * t * t) * arcsec,
                 z = (2306.2181 * t + 1.09468 * t * t) * arcsec,
                 theta = (2004.3109 * t - 0.42665 * t * t) * arcsec;
    const double ra = radians(j2000.ra_deg) + zeta, dec = radians(j2000.dec_deg);
    const double a = std::cos(dec) * std::sin(ra),
                 b = std::cos(theta) * std::cos(dec) * std::cos(ra) -
                     std::sin(theta) * std::sin(dec),
                 c = std::sin(theta) * std::cos(dec) * std::cos(ra) +
                     std::cos(theta) * std::sin(dec);
    return {degrees(std::atan2(a, b) + z), degrees(std::atan2(c, std::hypot(a, b)))};
}

/// Without air (M 12.4, 13.5, 13.6).
inline Direction above_horizon(const Equatorial& of_date, double days, const Site& site) {
    const double sidereal_deg = 280.46061837 + 360.98564736629 * days + site.lon_deg;
    const double hour = radians(sidereal_deg - of_date.ra_deg), dec = radians(of_date.dec_deg),
                 lat = radians(site.lat_deg);
    const double west = std::cos(dec) * std::sin(hour),
                 south =
                     std::cos(dec) * std::cos(hour) * std::sin(lat) - std::sin(dec) * std::cos(lat),
                 up =
                     std::cos(dec) * std::cos(hour) * std::cos(lat) + std::sin(dec) * std::sin(lat);
    return {degrees(std::atan2(-west, -south)), degrees(std::asin(up))};
}

/// Of the date (M 25.3, 25.4), within 0.01 degrees.
inline Equatorial plain_sun(double days) {
    const double t = days / 36525, anomaly = radians(357.52911 + 35999.05029 * t);
    const double longitude = radians(280.46646 + 36000.76983 * t +
                                     (1.914602 - 0.004817 * t) * std::sin(anomaly) +
                                     0.019993 * std::sin(2 * anomaly)),
                 obliquity = radians(23.43929 - 0.0130042 * t);
    return {degrees(std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude))),
            degrees(std::asin(std::sin(obliquity) * std::sin(longitude)))};
}

/// Through air of a pressure and temperature (M 16.4).
inline Direction through_air(const Direction& airless, double pressure_hpa, double temperature_c) {
    const double h = airless.elevation_deg,
                 arcmin = 1.02 / std::tan(radians(h + 10.3 / (h + 5.11))) * pressure_hpa / 1010 *
                          283 / (273 + temperature_c);
    return {airless.azimuth_deg, h + arcmin / 60};
}

}  // namespace relevo::test
