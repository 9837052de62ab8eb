#include "viewer/sun_model.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/position.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr const char* kMonths[] = {tr_later("Jan"), tr_later("Feb"), tr_later("Mar"),
                                   tr_later("Apr"), tr_later("May"), tr_later("Jun"),
                                   tr_later("Jul"), tr_later("Aug"), tr_later("Sep"),
                                   tr_later("Oct"), tr_later("Nov"), tr_later("Dec")};

}  // namespace

SunPoint sun_at(sun::Instant utc, const geo::Geodetic& place, const sun::Refraction& air) {
    const sun::Position position = sun::position(utc, place);
    const double elevation = air.apparent_rad(position.elevation_rad);
    const double level = std::cos(elevation);
    return {utc,
            {level * std::sin(position.azimuth_rad), level * std::cos(position.azimuth_rad),
             std::sin(elevation)},
            degrees(elevation)};
}

SunDay SunDay::of(sun::Date date, const sun::Zone& zone, const geo::Geodetic& place,
                  const sun::Refraction& air) {
    SunDay day;
    day.date = date;
    day.events = sun::day_events(date, zone, place);
    day.seasons = sun::seasons(date.year);
    constexpr double kStep_s = 600;
    const double length_s = day.events.span.length_s();
    for (double s = 0; s < length_s + kStep_s; s += kStep_s)
        day.points.push_back(sun_at(day.events.span.begin + std::min(s, length_s), place, air));
    return day;
}

std::optional<sun::Instant> time_with_sun(const SunDay& day, sun::Instant wanted) {
    constexpr double kHigh_deg = 10;
    double most_deg = 0;
    for (const SunPoint& point : day.points)
        most_deg = std::max(most_deg, point.elevation_deg);
    if (most_deg <= 0) return std::nullopt;
    std::optional<sun::Instant> nearest;
    for (const SunPoint& point : day.points) {
        if (point.elevation_deg < std::min(kHigh_deg, most_deg / 2)) continue;
        if (!nearest || std::abs(point.utc - wanted) < std::abs(*nearest - wanted))
            nearest = point.utc;
    }
    return nearest;
}

DayMinute DayMinute::of(sun::Instant utc, const sun::Zone& zone) {
    const sun::CivilTime wall = zone.local(utc).wall;
    return {wall.date, wall.hour * 60 + wall.minute};
}

sun::Instant DayMinute::utc(const sun::Zone& zone) const {
    return zone.resolve({.date = date, .hour = minute / 60, .minute = minute % 60}).utc;
}

int days_in_month(int year, int month) {
    const sun::Date first{year, month, 1};
    return sun::days_between(
        first, month == 12 ? sun::Date{year + 1, 1, 1} : sun::Date{year, month + 1, 1});
}

std::string english_day(sun::Date date) {
    return fmt::format("{} {}", date.day, kMonths[date.month - 1]);
}

std::string day_label(sun::Date date) {
    return fmt::format("{} {}", date.day, tr(kMonths[date.month - 1]));
}

std::string clock_label(sun::Instant utc, const sun::Zone& zone) {
    const int minute = DayMinute::of(utc + 30.0, zone).minute;
    return fmt::format("{:02}:{:02}", minute / 60, minute % 60);
}

sun::Date in_year(sun::Date date, int year) {
    return {year, date.month, std::min(date.day, days_in_month(year, date.month))};
}

int day_of_year(sun::Date date) {
    return sun::days_between({date.year, 1, 1}, date);
}

sun::Date date_of(int year, int day_of_year) {
    return sun::add_days({year, 1, 1}, day_of_year);
}

}  // namespace relevo::viewer
