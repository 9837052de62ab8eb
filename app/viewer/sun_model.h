#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "sun/events.h"
#include "sun/refraction.h"
#include "sun/seasons.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// Position of the sun at a time, as seen from the DEM's middle.
struct SunPoint {
    sun::Instant utc;
    glm::dvec3 direction{0};   ///< in the DEM's local frame, lifted by the air, unit
    double elevation_deg = 0;  ///< apparent
};

/// The sun's way on a local day.
struct SunDay {
    sun::Date date;
    std::vector<SunPoint> points;  ///< every ten minutes of the day, both ends included
    sun::Day events;
    sun::Seasons seasons;  ///< of its year

    static SunDay of(sun::Date date, const sun::Zone& zone, const geo::Geodetic& place,
                     const sun::Refraction& air);
};

/// @param place  the DEM's middle
/// @param air    over it, as the scene has it
SunPoint sun_at(sun::Instant utc, const geo::Geodetic& place, const sun::Refraction& air);

/// The time of a day nearest to `wanted` at which the sun is 10 degrees high, or half as high as at
/// most if that is lower. None if the sun does not rise.
std::optional<sun::Instant> time_with_sun(const SunDay& day, sun::Instant wanted);

/// A wall clock's minute of a local day, 0 to 1439, and the day.
struct DayMinute {
    sun::Date date;
    int minute = 0;

    static DayMinute of(sun::Instant utc, const sun::Zone& zone);
    sun::Instant utc(const sun::Zone& zone) const;
};

/// The same date in another year; the 29th of February becomes the 28th where there is none.
sun::Date in_year(sun::Date date, int year);
/// The day of the year, from 0, and the date that it is.
int day_of_year(sun::Date date);
sun::Date date_of(int year, int day_of_year);
int days_in_month(int year, int month);
/// "22 Sep"; for files.
std::string english_day(sun::Date date);
/// The same in the user's language.
std::string day_label(sun::Date date);
/// "15:03", rounded to the nearest minute, as in diagrams.
std::string clock_label(sun::Instant utc, const sun::Zone& zone);

}  // namespace relevo::viewer
