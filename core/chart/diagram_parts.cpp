#include "chart/diagram_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "geo/format.h"
#include "sun/position.h"

namespace relevo::chart {
namespace {

using sun::Date;
using sun::Instant;

constexpr double kTitleSize = 21;
constexpr double kFootSize = 10.5;
constexpr double kFootLead = 14;

int offset_on(const sun::Zone& zone, int year, int month) {
    return zone.local(Instant::from_utc({{year, month, 21}, 12})).utc_offset_s;
}

}  // namespace

SunPaths::SunPaths(const geo::Geodetic& place, const sun::Refraction& refraction, int year,
                   const sun::Zone& zone)
    : observer_(place),
      refraction_(refraction),
      year_(year),
      zone_(zone),
      standard_offset_s_(std::min(offset_on(zone, year, 1), offset_on(zone, year, 7))),
      largest_offset_s_(std::max(offset_on(zone, year, 1), offset_on(zone, year, 7))),
      // Hour lines begin at the solstice before.
      table_(std::max(Instant::from_utc({{year - 1, 12, 20}}),
                      Instant::from_utc({{sun::kFirstYear, 1, 1}}) - 86400),
             std::min(Instant::from_utc({{year + 1, 1, 2}}),
                      Instant::from_utc({{sun::kLastYear + 1, 1, 1}}) + 86400)) {}

SunPaths::SunPaths(const geo::Geodetic& place, const sun::Refraction& refraction, Date moon_day,
                   const sun::Zone& zone)
    : observer_(place),
      refraction_(refraction),
      year_(moon_day.year),
      zone_(zone),
      standard_offset_s_(std::min(offset_on(zone, year_, 1), offset_on(zone, year_, 7))),
      largest_offset_s_(std::max(offset_on(zone, year_, 1), offset_on(zone, year_, 7))),
      table_(zone.day(moon_day).begin, zone.day(moon_day).end, sun::Body::Moon) {}

PathPoint SunPaths::at(Instant utc) const {
    const Instant inside = std::clamp(utc, table_.from(), table_.to());
    const glm::dvec3 body = table_.vector_au(inside, observer_);
    return {utc, sun::azimuth_of(body), refraction_.apparent_rad(sun::elevation_of(body))};
}

std::vector<PathPoint> SunPaths::day(Date date, double step_s) const {
    std::vector<PathPoint> points;
    const auto span = zone_.find_day(date);
    if (!span) return points;
    for (double t = 0; t < span->length_s(); t += step_s)
        points.push_back(at(span->begin + t));
    points.push_back(at(span->end));
    return points;
}

std::vector<PathPoint> SunPaths::full_hours(Date date) const {
    std::vector<PathPoint> points;
    if (!zone_.find_day(date)) return points;
    for (int hour = 0; hour < 24; ++hour) {
        const sun::ResolvedTime time = zone_.resolve({date, hour});
        if (time.kind != sun::WallTimeKind::Nonexistent) points.push_back(at(time.utc));
    }
    return points;
}

std::vector<PathPoint> SunPaths::hour_line(int hour, int step) const {
    std::vector<PathPoint> points;
    const Date first{year_ - 1, 12, 21};
    for (int d = 0; d <= 366; d += step)
        points.push_back(
            at(Instant::from_utc({sun::add_days(first, d), hour}) - standard_offset_s_));
    return points;
}

std::string SunPaths::hours_text() const {
    const std::string standard = sun::offset_text(standard_offset_s_);
    if (largest_offset_s_ == standard_offset_s_) return fmt::format("hours: UTC{}", standard);
    return fmt::format("hours: UTC{}; in summer time add {:.3g} h", standard,
                       (largest_offset_s_ - standard_offset_s_) / 3600.0);
}

std::string SunPaths::clock(Instant utc) const {
    const sun::CivilTime wall = zone_.local(utc + 30).wall;
    return fmt::format("{:02}:{:02}", wall.hour, wall.minute);
}

const std::vector<SeasonPath>& season_paths() {
    static const std::vector<SeasonPath> paths{
        {12, "21 Dec", {0x2b5fa8}},     {1, "21 Jan, Nov", {0x4b8fc2}},
        {2, "21 Feb, Oct", {0x63aeb0}}, {3, "21 Mar, Sep", {0x6a9f4b}},
        {4, "21 Apr, Aug", {0xc2a52d}}, {5, "21 May, Jul", {0xd97f35}},
        {6, "21 Jun", {0xc43d2b}}};
    return paths;
}

std::string month_name(int month) {
    constexpr std::array kNames{"January",   "February", "March",    "April",
                                "May",       "June",     "July",     "August",
                                "September", "October",  "November", "December"};
    return kNames[static_cast<std::size_t>(month - 1)];
}

std::string long_date(Date date) {
    return fmt::format("{} {} {}", date.day, month_name(date.month), date.year);
}

std::string duration_text(double seconds) {
    const long minutes = std::lround(seconds / 60);
    return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

std::string place_text(const geo::Geodetic& place) {
    return fmt::format("{}, {:.0f} m", geo::degrees_text(place), place.height_m);
}

std::string light_text(const light::LightDay& day, const SunPaths& paths,
                       const std::string& light) {
    std::string text;
    for (const light::LitInterval& lit : day.lit)
        text += fmt::format("{}{} to {}", text.empty() ? light + " " : ", ",
                            lit.begin.midnight ? "midnight" : paths.clock(lit.begin.utc),
                            lit.end.midnight ? "midnight" : paths.clock(lit.end.utc));
    if (day.lit.size() == 1 && day.lit[0].begin.midnight && day.lit[0].end.midnight)
        text = light + " all day";
    if (text.empty())
        text = "No d" + light.substr(1);
    else
        text += " (" + duration_text(day.lit_s) + ")";
    if (day.not_known_s > 0)
        text += fmt::format(", {} of it not known because of voids in the DEM",
                            day.not_known_s < 30 ? "seconds" : duration_text(day.not_known_s));
    return text + "; over a level horizon " + duration_text(day.flat.day_length_s);
}

std::string title_of(const std::string& place_name, const std::string& subject) {
    if (place_name.empty()) return subject;
    return place_name + ": " + lower(subject.substr(0, 1)) + subject.substr(1);
}

void add_title(Drawing& drawing, double margin, const std::string& place_name,
               const std::string& subject, const std::vector<std::string>& lines) {
    const double room = drawing.width() - 2 * margin - text_width(": " + subject, kTitleSize, true);
    drawing.text({margin, margin + 16},
                 title_of(shortened(printable(place_name), kTitleSize, room, true), subject),
                 {.size = kTitleSize, .color = kInk, .bold = true});
    double y = margin + 38;
    for (const std::string& line : lines) {
        drawing.text({margin, y}, line, {.size = 13, .color = kSoft});
        y += 18;
    }
}

double foot_height(double width, double margin, const std::vector<std::string>& sentences) {
    std::size_t lines = 0;
    for (const std::string& sentence : sentences)
        lines += wrapped(sentence, kFootSize, width - 2 * margin).size();
    return static_cast<double>(lines) * kFootLead + 10;
}

void add_foot(Drawing& drawing, double margin, const std::vector<std::string>& sentences) {
    double y = drawing.height() - margin - foot_height(drawing.width(), margin, sentences) + 10;
    drawing.line({margin, y}, {drawing.width() - margin, y}, {.stroke = kGrid});
    for (const std::string& sentence : sentences)
        for (const std::string& line : wrapped(sentence, kFootSize, drawing.width() - 2 * margin)) {
            y += kFootLead;
            drawing.text({margin, y}, line, {.size = kFootSize, .color = kSoft});
        }
}

double add_key(Drawing& drawing, double x, double y, const Pen& pen, const std::string& words) {
    constexpr double kSample = 22, kGap = 6, kSize = 11.5;
    if (pen.fill)
        drawing.rect({x, y - 9, kSample, 11}, pen);
    else
        drawing.line({x, y - 4}, {x + kSample, y - 4}, pen);
    drawing.text({x + kSample + kGap, y}, words, {.size = kSize, .color = kInk});
    return x + kSample + kGap + text_width(words, kSize) + 18;
}

}  // namespace relevo::chart
