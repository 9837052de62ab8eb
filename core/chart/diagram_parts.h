#pragma once

#include <string>
#include <vector>

#include "chart/drawing.h"
#include "light/point/direct_light.h"
#include "sun/observer.h"
#include "sun/position_table.h"
#include "sun/refraction.h"
#include "sun/zone.h"

// What the diagrams share. Inside of the layer only.

namespace relevo::chart {

// One palette for all of them: ink on paper, cold winter to warm summer, the day itself in orange.
inline constexpr Color kInk{0x20262c};
inline constexpr Color kSoft{0x5f6a75};
inline constexpr Color kFaint{0xa4adb6};
inline constexpr Color kGrid{0xdde3e8};
inline constexpr Color kPaper{0xffffff};
inline constexpr Color kSky{0xf5f9fc};
inline constexpr Color kDay{0xe07b12};
inline constexpr Color kShadow{0x7d8b99};
inline constexpr Color kHole{0xb3261e};
inline constexpr double kSheetMargin = 28;  // of a sheet
inline constexpr const char* kHoleWords = "void of the DEM: the horizon may be higher";

/// The sun or the moon at a moment.
struct PathPoint {
    sun::Instant utc;
    double azimuth_rad = 0;
    double elevation_rad = 0;  ///< apparent
};

/// The way of the sun, or the moon, over the sky of a place.
class SunPaths {
  public:
    SunPaths(const geo::Geodetic& place, const sun::Refraction& refraction, int year,
             const sun::Zone& zone);
    /// The way of the moon: of a day alone, which are all that day(), full_hours() and at() may be
    /// asked for.
    SunPaths(const geo::Geodetic& place, const sun::Refraction& refraction, sun::Date moon_day,
             const sun::Zone& zone);

    int year() const { return year_; }
    const sun::Zone& zone() const { return zone_; }
    /// The offset of the zone in the darker part of the year, which hour lines are drawn for.
    int standard_offset_s() const { return standard_offset_s_; }

    PathPoint at(sun::Instant utc) const;
    /// From the first to the last moment of a local day, `step_s` apart.
    std::vector<PathPoint> day(sun::Date date, double step_s = 300) const;
    /// Every full hour of the clock on a local day.
    std::vector<PathPoint> full_hours(sun::Date date) const;
    /// A full hour of standard time through the year, `step` days apart, from 21 December of the
    /// year before on.
    std::vector<PathPoint> hour_line(int hour, int step = 3) const;

    /// "hours: UTC+1; in summer time add 1 h".
    std::string hours_text() const;
    /// "07:42", by the clock of the zone, to the nearest minute.
    std::string clock(sun::Instant utc) const;

  private:
    sun::Observer observer_;
    sun::Refraction refraction_;
    int year_;
    sun::Zone zone_;
    int standard_offset_s_, largest_offset_s_;
    sun::PositionTable table_;
};

/// Seven days that stand for the year, from the December to the June solstice.
struct SeasonPath {
    int month;  ///< the 21st of it
    const char* label;
    Color color;
};
const std::vector<SeasonPath>& season_paths();

/// "21 June 2026"; "June".
std::string long_date(sun::Date date);
std::string month_name(int month);
/// "8 h 23 min".
std::string duration_text(double seconds);
/// "47.2692 N 11.4041 E, 574 m".
std::string place_text(const geo::Geodetic& place);

/// "Direct sun 08:33 to 16:55 (8 h 21 min); over a level horizon 10 h 03 min".
/// @param light  "Direct sun"
std::string light_text(const light::LightDay& day, const SunPaths& paths,
                       const std::string& light = "Direct sun");

/// "The valley: paths of the sun, 2026"; without a name "Paths of the sun, 2026".
std::string title_of(const std::string& place_name, const std::string& subject);
/// Title and lines under it, at the top left. A name that is too long for the drawing is shortened.
/// @param subject  as title_of() takes it
void add_title(Drawing& drawing, double margin, const std::string& place_name,
               const std::string& subject, const std::vector<std::string>& lines);
/// The lines of small print at the foot.
void add_foot(Drawing& drawing, double margin, const std::vector<std::string>& sentences);
double foot_height(double width, double margin, const std::vector<std::string>& sentences);

/// A line of a legend with words after it; returns where the next one may begin.
double add_key(Drawing& drawing, double x, double y, const Pen& pen, const std::string& words);

}  // namespace relevo::chart
