#include "chart/sun_path_diagram.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/contains.h"
#include "base/units.h"
#include "chart/diagram_parts.h"
#include "light/point/sectors.h"

namespace relevo::chart {
namespace {

constexpr double kWidth = 900;
constexpr double kRadius = 350;
constexpr Color kTerrain{0xd9d1c2, 0.8};
constexpr Color kRidge{0x7d7464};

class Disc {
  public:
    Disc(Drawing& drawing, const glm::dvec2& center) : drawing_(drawing), center_(center) {}

    glm::dvec2 point(double azimuth_rad, double elevation_rad) const {
        const double r = kRadius * std::tan((kPi / 2 - elevation_rad) / 2);
        return center_ + r * glm::dvec2(std::sin(azimuth_rad), -std::cos(azimuth_rad));
    }
    glm::dvec2 point(const PathPoint& p) const { return point(p.azimuth_rad, p.elevation_rad); }
    glm::dvec2 outside(double azimuth_rad, double beyond) const {
        return center_ +
               (kRadius + beyond) * glm::dvec2(std::sin(azimuth_rad), -std::cos(azimuth_rad));
    }

    /// A line of points, without what lies well under the horizon; the disc's clip does the rest.
    void path(const std::vector<PathPoint>& path, const Pen& pen) const {
        std::vector<glm::dvec2> points;
        for (const PathPoint& p : path)
            points.push_back(p.elevation_rad > radians(-12) ? point(p) : glm::dvec2(std::nan("")));
        drawing_.path(std::move(points), pen);
    }

    void grid() const {
        drawing_.circle(center_, kRadius, {.fill = kSky});
        for (int el = 10; el < 90; el += 10)
            drawing_.circle(center_, kRadius * std::tan(radians(90 - el) / 2),
                            {.stroke = kGrid, .width = el % 30 == 0 ? 1.3 : 0.8});
        for (int az = 0; az < 360; az += 10) {
            if (az % 30 == 0)
                drawing_.line(point(radians(az), radians(az % 90 == 0 ? 90 : 80)),
                              point(radians(az), 0), {.stroke = kGrid, .width = 0.8});
        }
    }

    void rim() const {
        drawing_.circle(center_, kRadius, {.stroke = kSoft, .width = 1.4});
        for (int az = 0; az < 360; az += 5)
            drawing_.line(outside(radians(az), 0), outside(radians(az), az % 10 == 0 ? 7 : 4),
                          {.stroke = kSoft, .width = az % 10 == 0 ? 1 : 0.7});
        for (int az = 0; az < 360; az += 30) {
            constexpr const char* kNames[] = {"N", "E", "S", "W"};
            const glm::dvec2 at = outside(radians(az), 20);
            const bool cardinal = az % 90 == 0;
            drawing_.text(at + glm::dvec2(0, cardinal ? 6 : 4),
                          cardinal ? kNames[az / 90] : fmt::format("{}°", az),
                          {.size = cardinal ? 17.0 : 11.5,
                           .color = cardinal ? kInk : kSoft,
                           .anchor = Anchor::Middle,
                           .bold = cardinal});
        }
    }

    /// Scale of elevations, along a direction in which the sun never stands in its way.
    void elevations(double azimuth_rad) const {
        for (int el = 10; el < 90; el += 10)
            drawing_.text(point(azimuth_rad, radians(el)) + glm::dvec2(3, -2),
                          fmt::format("{}°", el),
                          {.size = 10, .color = kSoft, .halo = Color{kPaper.rgb, 0.7}});
    }

  private:
    Drawing& drawing_;
    glm::dvec2 center_;
};

/// "civil dawn 04:37, sunrise 05:18, ..., day of 15:56:14"
std::string events_text(const sun::Day& day, const SunPaths& paths) {
    const auto time = [&](const char* name, sun::EventKind kind) {
        const auto utc = day.first(kind);
        return utc ? fmt::format("{} {}", name, paths.clock(*utc)) : std::string();
    };
    std::string events;
    for (const std::string& part :
         {time("civil dawn", sun::EventKind::CivilDawn), time("sunrise", sun::EventKind::Sunrise),
          time("transit", sun::EventKind::Transit), time("sunset", sun::EventKind::Sunset),
          time("civil dusk", sun::EventKind::CivilDusk)})
        if (!part.empty()) events += part + ", ";
    events += day.sun == sun::Crossing::AboveAllDay   ? "polar day"
              : day.sun == sun::Crossing::BelowAllDay ? "polar night"
                                                      : "day of " + duration_text(day.day_length_s);
    return events;
}

/// A diagram while it is drawn.
class Sheet {
  public:
    Sheet(const SunPathDiagram& of, const SunPaths& paths, Drawing& drawing,
          const glm::dvec2& center)
        : of_(of), paths_(paths), drawing_(drawing), center_(center), disc_(drawing, center) {}

    /// Everything inside of the disc but marks, from the lowest to the highest.
    void sky() const {
        disc_.grid();
        drawing_.clip_circle(center_, kRadius);
        year();
        if (of_.day) disc_.path(paths_.day(of_.day->date, 120), {.stroke = kDay, .width = 3.4});
        if (of_.terrain) terrain();  // paths behind it shine through
        disc_.elevations(south_of_sun() ? kPi : 0);
        drawing_.end_clip();
        disc_.rim();
    }

    void marks() const {
        if (of_.day) {
            day_hours();
            rise_and_set();
        } else {
            year_hours();
        }
        if (of_.light) light_edges();
    }

    void keys(double keys_y) const {
        double x = kSheetMargin;
        if (of_.day)
            x = add_key(drawing_, x, keys_y, {.stroke = kDay, .width = 3.4},
                        long_date(of_.day->date));
        for (const SeasonPath& season : season_paths())
            x = add_key(drawing_, x, keys_y,
                        {.stroke = season.color, .width = season.month % 3 == 0 ? 2.0 : 1.2},
                        season.label);
        x = add_key(drawing_, kSheetMargin, keys_y + 20, {.stroke = kFaint, .width = 0.9},
                    fmt::format("full hour (UTC{}), 21 Dec to 21 Jun",
                                sun::offset_text(paths_.standard_offset_s())));
        x = add_key(drawing_, x, keys_y + 20, {.stroke = kFaint, .width = 1.2, .dash = {0.1, 3.2}},
                    "21 Jun to 21 Dec");
        if (of_.terrain)
            x = add_key(drawing_, x, keys_y + 20, {.fill = kTerrain, .stroke = kRidge, .width = 1},
                        "terrain");
        if (marks_holes())
            add_key(drawing_, x, keys_y + 20, {.stroke = kHole, .width = 3}, kHoleWords);
    }

  private:
    bool south_of_sun() const { return of_.place.lat_rad < 0; }
    bool marks_holes() const { return of_.terrain && contains(of_.holes, true); }
    glm::dvec2 skyline(double azimuth_rad) const {
        return disc_.point(azimuth_rad, std::max(0.0, of_.terrain->elevation_rad(azimuth_rad)));
    }

    void year() const {
        // Hours of the year: half of each line for growing days, half, dashed, for shrinking ones.
        for (int hour = 0; hour < 24; ++hour) {
            const std::vector<PathPoint> line = paths_.hour_line(hour);
            const auto half = line.begin() + static_cast<std::ptrdiff_t>(line.size() / 2);
            disc_.path({line.begin(), half + 1}, {.stroke = kFaint, .width = 0.9});
            disc_.path({half, line.end()}, {.stroke = kFaint, .width = 1.2, .dash = {0.1, 3.2}});
        }
        for (const SeasonPath& season : season_paths())
            disc_.path(paths_.day({of_.year, season.month, 21}),
                       {.stroke = Color{season.color.rgb, of_.day ? 0.75 : 1.0},
                        .width = season.month % 3 == 0 ? 2.0 : 1.2});
    }

    void terrain() const {
        std::vector<glm::dvec2> ring;
        constexpr int kSteps = 1440;
        for (int i = 0; i <= kSteps; ++i) {
            const double azimuth_rad = 2 * kPi * i / kSteps;
            ring.push_back(skyline(azimuth_rad));
        }
        std::vector<glm::dvec2> area = ring;
        for (int i = kSteps; i >= 0; --i)
            area.push_back(disc_.outside(2 * kPi * i / kSteps, 2));
        drawing_.path(area, {.fill = kTerrain}, true);
        drawing_.path(ring, {.stroke = kRidge, .width = 1.2});
        if (marks_holes())
            for (const light::Sector& one : light::sectors_of(of_.holes))
                mark_hole(one);
    }

    void mark_hole(const light::Sector& hole) const {
        // A hole of one direction has a width, too.
        const double step_rad = 2 * kPi / static_cast<double>(of_.holes.size());
        const double from_rad = hole.from_azimuth_rad - step_rad;
        double turn_rad = hole.to_azimuth_rad + step_rad - from_rad;
        if (hole.to_azimuth_rad < hole.from_azimuth_rad) turn_rad += 2 * kPi;
        const int steps = 1 + static_cast<int>(turn_rad / radians(0.25));
        std::vector<glm::dvec2> line;
        for (int i = 0; i <= steps; ++i) {
            const double azimuth_rad = from_rad + turn_rad * i / steps;
            line.push_back(skyline(azimuth_rad));
        }
        drawing_.path(std::move(line), {.stroke = kHole, .width = 3});
    }

    void year_hours() const {
        // At the end of the longest day's side, away from the other paths.
        for (int hour = 0; hour < 24; ++hour) {
            const std::vector<PathPoint> line = paths_.hour_line(hour, 1);
            const std::size_t june = 182, december = 0, march = 90;
            const PathPoint& end = line[south_of_sun() ? december : june];
            if (end.elevation_rad < radians(0.5)) continue;
            const glm::dvec2 tip = disc_.point(end), inner = disc_.point(line[march]);
            const glm::dvec2 away = glm::normalize(tip - inner);
            drawing_.text(tip + 13.0 * away + glm::dvec2(0, 4), fmt::format("{}", hour),
                          {.size = 11.5,
                           .color = kInk,
                           .anchor = Anchor::Middle,
                           .bold = hour % 6 == 0,
                           .halo = kSky});
        }
    }

    void day_hours() const {
        for (const PathPoint& p : paths_.full_hours(of_.day->date)) {
            if (p.elevation_rad < 0) continue;
            const glm::dvec2 at = disc_.point(p);
            drawing_.circle(at, 3.6, {.fill = kPaper, .stroke = kDay, .width = 1.8});
            const glm::dvec2 outward = at - center_;
            const double length = glm::length(outward);
            glm::dvec2 aside = length > 1 ? outward / length : glm::dvec2(0, 1);
            if (length > 0.86 * kRadius) aside = -aside;  // the rim has words of its own
            drawing_.text(
                at + 15.0 * aside + glm::dvec2(0, 4),
                fmt::format("{}", of_.zone.local(p.utc).wall.hour),
                {.size = 12, .color = kInk, .anchor = Anchor::Middle, .bold = true, .halo = kSky});
        }
    }

    void rise_and_set() const {
        for (const sun::Event& event : of_.day->events) {
            const bool rises = event.kind == sun::EventKind::Sunrise;
            if (!rises && event.kind != sun::EventKind::Sunset) continue;
            drawing_.circle(disc_.outside(event.azimuth_rad, 0), 4.5,
                            {.fill = of_.light ? kPaper : kDay, .stroke = kDay, .width = 1.5});
            const glm::dvec2 at = disc_.outside(event.azimuth_rad, 34);
            drawing_.text(at + glm::dvec2(0, 4), paths_.clock(event.utc),
                          {.size = 13,
                           .color = kDay,
                           .anchor = std::sin(event.azimuth_rad) > 0 ? Anchor::Start : Anchor::End,
                           .bold = true});
        }
    }

    void light_edges() const {
        for (const light::LitInterval& lit : of_.light->lit)
            for (const light::LightEdge& edge : {lit.begin, lit.end})
                if (!edge.midnight)
                    drawing_.circle(disc_.point(edge.azimuth_rad, edge.elevation_rad), 5,
                                    {.fill = kDay, .stroke = kPaper, .width = 1.2});
    }

    const SunPathDiagram& of_;
    const SunPaths& paths_;
    Drawing& drawing_;
    glm::dvec2 center_;
    Disc disc_;
};

}  // namespace

Drawing SunPathDiagram::draw() const {
    const SunPaths paths(place, refraction, year, zone);
    std::vector<std::string> foot{
        fmt::format("Disc: the sky, stereographic; rings every 10 degrees of elevation. Paths: "
                    "centre of the sun, {}. {}.",
                    refraction.description(), "H" + paths.hours_text().substr(1))};
    if (day) foot.push_back("S" + day->definition.substr(1) + ".");
    if (light) foot.push_back("D" + light_definition.substr(1) + ".");
    if (terrain) foot.push_back("T" + terrain_definition.substr(1) + ".");

    const double top = 82 + 18.0 * (day.has_value() + light.has_value());
    const glm::dvec2 center(kWidth / 2, top + 40 + kRadius);
    const double keys_y = center.y + kRadius + 66;
    Drawing drawing(kWidth, keys_y + 34 + foot_height(kWidth, kSheetMargin, foot) + kSheetMargin);

    std::vector<std::string> lines{fmt::format("{}, {}", place_text(place), zone.name())};
    const std::string subject = day ? "Path of the sun, " + long_date(day->date)
                                    : fmt::format("Paths of the sun, {}", year);
    if (day) lines.push_back(events_text(*day, paths));
    if (light) lines.push_back(light_text(*light, paths));
    drawing.describe(title_of(place_name, subject), lines.front());
    add_title(drawing, kSheetMargin, place_name, subject, lines);

    const Sheet sheet(*this, paths, drawing, center);
    sheet.sky();
    sheet.marks();
    sheet.keys(keys_y);
    add_foot(drawing, kSheetMargin, foot);
    return drawing;
}

}  // namespace relevo::chart
