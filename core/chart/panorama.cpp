#include "chart/panorama.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/units.h"
#include "chart/diagram_parts.h"
#include "chart/label_placer.h"

namespace relevo::chart {
namespace {

constexpr double kSheetWidth = 1500;
constexpr Rect kSheetPlot{74, 104, kSheetWidth - 74 - 34, 460};
// A panel's plot, in the panel.
constexpr double kPanoramaLeft = 40, kPanoramaRight = 18, kPanoramaTop = 8, kPanoramaBottom = 48;
constexpr int kColumns = 1440;  // directions of the ridges

constexpr Color kZenithSky{0xd3e5f3};
constexpr Color kHorizonSky{0xfaf6ee};
constexpr Color kRidgeLine{0x2d352f};

/// Far ground is paler and bluer: Leonardo's perspective of the air.
Color ground_color(double nearness) {
    constexpr std::array kShades{Color{0xbccbda}, Color{0x8ea5b5}, Color{0x6d8580}, Color{0x55694f},
                                 Color{0x3f4a38}};
    const double at = std::clamp(nearness, 0.0, 1.0) * (kShades.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), kShades.size() - 2);
    return mixed(kShades[i], kShades[i + 1], at - static_cast<double>(i));
}

std::string distance_text(double distance_m) {
    return distance_m < 1000 ? fmt::format("{:.0f} m", distance_m)
                             : fmt::format("{:.3g} km", distance_m / 1000);
}

class Panorama {
  public:
    explicit Panorama(const HorizonPanorama& of) : of_(of) {
        if (moon() && of.day)
            paths_.emplace(of.horizon->place(), of.refraction, of.day->date, of.zone);
        else if (of.year != 0)
            paths_.emplace(of.horizon->place(), of.refraction, of.year, of.zone);
        middle_rad_ = of.horizon->place().lat_rad < 0 ? 0 : kPi;
        if (of.panel)
            plot_ = {kPanoramaLeft, kPanoramaTop, of.panel->width - kPanoramaLeft - kPanoramaRight,
                     of.panel->height - kPanoramaTop - kPanoramaBottom};
        choose_range();
        if (!of.panel) make_foot();
    }

    Drawing draw() {
        if (of_.panel) {
            Drawing drawing(of_.panel->width, of_.panel->height);
            drawing_ = &drawing;
            add_plot();
            return drawing;
        }
        const double keys_y = plot_.y + plot_.height + 62;
        Drawing drawing(kSheetWidth, keys_y + (paths_ && !moon() ? 50 : 30) +
                                         foot_height(kSheetWidth, kSheetMargin, foot_) +
                                         kSheetMargin);
        drawing_ = &drawing;
        add_head();
        add_plot();
        add_keys(keys_y);
        add_foot(drawing, kSheetMargin, foot_);
        return drawing;
    }

    HorizonPanorama::Axes axes() const {
        return {plot_, middle_rad_, radians(low_deg_), radians(high_deg_)};
    }

  private:
    void add_plot() {
        drawing_->clip(plot_);
        add_sky();
        if (paths_) add_paths();
        add_ridges();
        add_holes();
        add_level();
        drawing_->end_clip();
        add_axes();
        add_marks();
    }

    bool moon() const { return of_.body == sun::Body::Moon; }
    double x(double azimuth_rad) const { return axes().at(azimuth_rad, 0).x; }
    double y(double elevation_rad) const { return axes().at(0, elevation_rad).y; }
    glm::dvec2 point(const PathPoint& p) const { return {x(p.azimuth_rad), y(p.elevation_rad)}; }

    void choose_range() {
        double lowest = 0, highest = 0;
        for (const light::HorizonPoint& p : *of_.profile) {
            lowest = std::min(lowest, p.elevation_rad);
            highest = std::max(highest, p.elevation_rad);
        }
        if (moon() && of_.day)
            for (const PathPoint& p : paths_->day(of_.day->date))
                highest = std::max(highest, p.elevation_rad);
        else if (paths_)
            for (int month = 1; month <= 12; ++month)
                for (const PathPoint& p : paths_->day({of_.year, month, 21}))
                    highest = std::max(highest, p.elevation_rad);
        // Room for the labels over the highest path, and under the lowest ground.
        const double tall = degrees(highest - lowest);
        high_deg_ = std::min(90.0, std::ceil(degrees(highest) + std::max(2.0, 0.12 * tall)));
        low_deg_ = std::floor(degrees(lowest) - std::max(1.0, 0.06 * tall));
    }

    double stretch() const { return plot_.height / (high_deg_ - low_deg_) / (plot_.width / 360); }

    void make_foot() {
        foot_.push_back("T" + of_.horizon->description().substr(1) + ".");
        if (paths_)
            foot_.push_back(fmt::format("{}: centre of the {}, {}.{}", moon() ? "Path" : "Paths",
                                        name_of(of_.body), of_.refraction.description(),
                                        moon() ? "" : " H" + paths_->hours_text().substr(1) + "."));
        if (of_.day)
            foot_.push_back("D" + of_.light_definition.substr(1) + ". " + (moon() ? "M" : "S") +
                            of_.day->flat.definition.substr(1) + ".");
    }

    void add_head() {
        std::string subject = "Horizon";
        if (of_.day)
            subject +=
                fmt::format(" and path of the {}, {}", name_of(of_.body), long_date(of_.day->date));
        else if (paths_)
            subject += fmt::format(" and paths of the sun, {}", of_.year);
        std::string where = place_text(of_.horizon->place());
        if (of_.year != 0) where += ", " + of_.zone.name();
        std::vector<std::string> lines{where};
        if (of_.day)
            lines.push_back(
                light_text(*of_.day, *paths_, moon() ? "Direct moonlight" : "Direct sun"));
        drawing_->describe(title_of(of_.place_name, subject), lines.back());
        add_title(*drawing_, kSheetMargin, of_.place_name, subject, lines);
    }

    void add_sky() {
        constexpr int kStrips = 60;
        const Rect all = plot_;
        for (int i = 0; i < kStrips; ++i)
            drawing_->rect(
                {all.x, all.y + all.height * i / kStrips, all.width, all.height / kStrips + 1},
                {.fill = mixed(kZenithSky, kHorizonSky, i / (kStrips - 1.0)), .crisp = true});
    }

    void path(const std::vector<PathPoint>& points, const Pen& pen) const {
        const double left = plot_.x, width = plot_.width;
        std::vector<glm::dvec2> line;
        for (const PathPoint& p : points) {
            const glm::dvec2 at = point(p);
            if (!line.empty() && std::abs(at.x - line.back().x) > width / 2) {
                // Out at one edge and in at the other; by the zenith it may only seem so.
                const glm::dvec2 from = line.back();
                const double turn = from.x > at.x ? width : -width;
                const glm::dvec2 way = at + glm::dvec2(turn, 0) - from;
                const double edge = turn > 0 ? left + width : left;
                if (p.elevation_rad < radians(85) && way.x != 0) {
                    const double y = from.y + way.y * (edge - from.x) / way.x;
                    line.emplace_back(edge, y);
                    line.emplace_back(std::nan(""));
                    line.emplace_back(edge - turn, y);
                } else {
                    line.emplace_back(std::nan(""));
                }
            } else if (!line.empty() && p.elevation_rad > radians(88.5)) {
                line.emplace_back(std::nan(""));
            }
            line.push_back(at);
        }
        drawing_->path(std::move(line), pen);
    }

    void add_paths() {
        if (!moon()) add_paths_of_year();
        if (of_.day) path(paths_->day(of_.day->date, 120), {.stroke = kDay, .width = 3.2});
    }

    void add_paths_of_year() {
        for (int hour = 0; hour < 24; ++hour) {
            const std::vector<PathPoint> line = paths_->hour_line(hour);
            const auto half = line.begin() + static_cast<std::ptrdiff_t>(line.size() / 2);
            path({line.begin(), half + 1}, {.stroke = kFaint, .width = 0.9});
            path({half, line.end()}, {.stroke = kFaint, .width = 1.1, .dash = {0.1, 3.2}});
        }
        for (const SeasonPath& season : season_paths())
            path(paths_->day({of_.year, season.month, 21}, 120),
                 {.stroke = Color{season.color.rgb, of_.day ? 0.75 : 1.0},
                  .width = season.month % 3 == 0 ? 2.0 : 1.2});
    }

    /// Ridges before ridges: what stands within growing distances, the farthest first.
    void add_ridges() {
        double farthest_m = 0;
        for (const light::HorizonPoint& p : *of_.profile)
            if (p.distance_m > farthest_m) farthest_m = p.distance_m;
        farthest_m = std::max(farthest_m, 1000.0);
        // Nearer than some posts there is no ridge yet.
        const glm::dvec2 spacing_m = of_.horizon->posts().grid().post_spacing_m();
        const double nearest_m = 5 * std::max(spacing_m.x, spacing_m.y);
        constexpr std::array kRound{100.,  200., 500., 1e3, 2e3, 3e3, 5e3, 7e3, 1e4,
                                    1.5e4, 2e4,  3e4,  5e4, 7e4, 1e5, 2e5, 5e5};
        for (const double d : kRound)
            if (d >= nearest_m && d < 0.95 * farthest_m) bands_m_.push_back(d);
        if (bands_m_.size() > 9) bands_m_.erase(bands_m_.begin(), bands_m_.end() - 9);
        bands_m_.push_back(farthest_m);

        const auto n = static_cast<int>(bands_m_.size());
        std::vector<std::vector<double>> elevation_rad(bands_m_.size());
        for (auto& band : elevation_rad)
            band.resize(kColumns + 1);
        parallel_for(0, kColumns + 1, 64, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const double azimuth_rad = middle_rad_ - kPi + 2 * kPi * i / kColumns;
                for (std::size_t b = 0; b + 1 < bands_m_.size(); ++b)
                    elevation_rad[b][static_cast<std::size_t>(i)] =
                        of_.horizon->elevation_within_rad(azimuth_rad, bands_m_[b]);
                elevation_rad.back()[static_cast<std::size_t>(i)] =
                    of_.horizon->elevation_rad(azimuth_rad);
            }
        });
        const Rect all = plot_;
        for (int b = n - 1; b >= 0; --b) {
            std::vector<glm::dvec2> ridge;
            for (int i = 0; i <= kColumns; ++i)
                ridge.emplace_back(all.x + all.width * i / kColumns,
                                   std::min(all.y + all.height + 2,
                                            y(elevation_rad[static_cast<std::size_t>(b)]
                                                           [static_cast<std::size_t>(i)])));
            // Its sides and its foot lie outside of the picture.
            ridge.emplace_back(all.x + all.width + 4, ridge.back().y);
            ridge.emplace_back(all.x + all.width + 4, all.y + all.height + 4);
            ridge.emplace_back(all.x - 4, all.y + all.height + 4);
            ridge.emplace_back(all.x - 4, ridge.front().y);
            drawing_->path(std::move(ridge),
                           {.fill = ground_color(nearness(b)),
                            .stroke = Color{kRidgeLine.rgb, b == n - 1 ? 1.0 : 0.35},
                            .width = b == n - 1 ? 1.3 : 0.7},
                           true);
        }
    }

    void add_holes() {
        const std::vector<light::HorizonPoint>& p = *of_.profile;
        const glm::dvec2 half(plot_.width / static_cast<double>(p.size()) / 2, 0);
        std::vector<glm::dvec2> line;
        for (const light::HorizonPoint& point : p) {
            const glm::dvec2 at(x(point.azimuth_rad), y(point.elevation_rad));
            const bool goes_on = !line.empty() && line.back().x < at.x;  // not round the back
            if (!point.hole || !goes_on) line.emplace_back(std::nan(""));
            if (point.hole) line.insert(line.end(), {at - half, at + half});
            marks_holes_ |= point.hole;
        }
        drawing_->path(std::move(line), {.stroke = kHole, .width = 3});
    }

    double nearness(int band) const {
        return bands_m_.size() < 2 ? 0.5 : 1 - band / static_cast<double>(bands_m_.size() - 1);
    }

    void add_level() {
        drawing_->line({plot_.x, y(0)}, {plot_.x + plot_.width, y(0)},
                       {.stroke = Color{0xffffff, 0.75}, .width = 1, .dash = {5, 4}});
    }

    void add_axes() {
        const Rect all = plot_;
        drawing_->rect(all, {.stroke = kSoft, .width = 1.2});
        const double bottom = all.y + all.height;
        constexpr const char* kNames[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
        for (int k = -18; k <= 18; ++k) {
            const int az =
                (static_cast<int>(std::lround(degrees(middle_rad_))) + 10 * k + 720) % 360;
            const double at = all.x + all.width * (k + 18) / 36;
            const bool named = az % 45 == 0;
            drawing_->line({at, bottom}, {at, bottom + (named ? 8 : 5)}, {.stroke = kSoft});
            if (az % 30 == 0 || named)
                drawing_->text({at, bottom + 20}, fmt::format("{}°", az),
                               {.size = 11.5, .color = kSoft, .anchor = Anchor::Middle});
        }
        for (int i = 0; i < 8; ++i) {
            double at = x(radians(45.0 * i));
            const auto label = [&] {
                drawing_->text({at, bottom + 38}, kNames[i],
                               {.size = i % 2 == 0 ? 16.0 : 12.5,
                                .color = i % 2 == 0 ? kInk : kSoft,
                                .anchor = Anchor::Middle,
                                .bold = i % 2 == 0});
            };
            label();
            if (std::abs(std::remainder(radians(45.0 * i) - middle_rad_ - kPi, 2 * kPi)) < 1e-6) {
                at = 2 * all.x + all.width - at;  // at both ends
                label();
            }
        }
        // As fine as its numbers have room for.
        constexpr double kApart = 14;
        int step = high_deg_ - low_deg_ > 50 ? 10 : high_deg_ - low_deg_ > 22 ? 5 : 2;
        while (step < 30 && y(0) - y(radians(step)) < kApart)
            step = step == 2 ? 5 : step == 5 ? 10 : step == 10 ? 20 : 30;
        for (int el = static_cast<int>(std::ceil(low_deg_ / step)) * step; el <= high_deg_;
             el += step) {
            drawing_->line({all.x - 5, y(radians(el))}, {all.x, y(radians(el))}, {.stroke = kSoft});
            drawing_->text({all.x - 9, y(radians(el)) + 4}, fmt::format("{}°", el),
                           {.size = 11.5, .color = kSoft, .anchor = Anchor::End});
        }
        if (of_.panel) return;
        drawing_->text({kSheetMargin + 4, all.y + all.height / 2}, "elevation",
                       {.size = 12, .color = kSoft, .anchor = Anchor::Middle, .turn_deg = -90});
        drawing_->text({all.x + all.width, all.y - 8},
                       fmt::format("azimuth from true north; elevations drawn {:.2g} times as tall",
                                   stretch()),
                       {.size = 11.5, .color = kSoft, .anchor = Anchor::End});
    }

    /// Hours, first and last light, and the ridges that stand out.
    void add_marks() {
        LabelPlacer labels(*drawing_, plot_);
        if (of_.day) {
            for (const PathPoint& p : paths_->full_hours(of_.day->date)) {
                const double ground_rad = of_.horizon->elevation_rad(p.azimuth_rad);
                if (p.elevation_rad <= ground_rad) continue;
                drawing_->circle(point(p), 3.6, {.fill = kPaper, .stroke = kDay, .width = 1.8});
                labels.keep_clear(point(p), 5);
            }
            for (const light::LitInterval& lit : of_.day->lit)
                for (const light::LightEdge& edge : {lit.begin, lit.end}) {
                    if (edge.midnight) continue;
                    const glm::dvec2 at(x(edge.azimuth_rad), y(edge.elevation_rad));
                    drawing_->circle(at, 4.6, {.fill = kDay, .stroke = kPaper, .width = 1.2});
                    labels.keep_clear(at, 6);
                    labels.add(at, paths_->clock(edge.utc),
                               {.size = 13.5, .color = Color{0xa64f00}, .bold = true}, 11);
                }
            for (const PathPoint& p : paths_->full_hours(of_.day->date)) {
                if (p.elevation_rad <= of_.horizon->elevation_rad(p.azimuth_rad)) continue;
                labels.add(point(p), fmt::format("{}", of_.zone.local(p.utc).wall.hour),
                           {.size = 12, .color = kInk, .bold = true}, 10);
            }
            for (const sun::Event& event : of_.day->flat.events) {
                const bool rises =
                    event.kind == sun::EventKind::Sunrise || event.kind == sun::EventKind::Moonrise;
                if (!rises && event.kind != sun::EventKind::Sunset &&
                    event.kind != sun::EventKind::Moonset)
                    continue;
                const glm::dvec2 at(x(event.azimuth_rad), y(0));
                drawing_->circle(at, 3.4, {.fill = kPaper, .stroke = kInk, .width = 1.2});
                labels.add(at,
                           fmt::format("{} {}", sun::name_of(event.kind), paths_->clock(event.utc)),
                           {.size = 11.5, .color = kPaper, .halo = Color{kRidgeLine.rgb, 0.8}}, 7,
                           LabelPlacer::Side::Below);
            }
        } else if (paths_) {
            for (int hour = 0; hour < 24; ++hour) {
                // Over the top of the hour's figure of eight.
                const std::vector<PathPoint> line = paths_->hour_line(hour);
                const PathPoint& top =
                    *std::ranges::max_element(line, [](const PathPoint& a, const PathPoint& b) {
                        return a.elevation_rad < b.elevation_rad;
                    });
                if (top.elevation_rad <= of_.horizon->elevation_rad(top.azimuth_rad)) continue;
                labels.add(point(top), fmt::format("{}", hour),
                           {.size = 12, .color = kInk, .bold = true}, 6);
            }
        }
        add_summits(labels);
    }

    void add_summits(LabelPlacer& labels) {
        const std::vector<light::HorizonPoint>& p = *of_.profile;
        const auto n = p.size();
        const double step_rad = 2 * kPi / static_cast<double>(n);
        const auto around = static_cast<std::size_t>(std::lround(radians(6) / step_rad));
        struct Summit {
            std::size_t at;
            double rises_rad;  // over the lower of the lowest ground within some degrees
        };
        std::vector<Summit> summits;
        for (std::size_t i = 0; i < n; ++i) {
            if (std::isnan(p[i].distance_m) || p[i].distance_m < 500) continue;
            bool top = true;
            double left = kPi, right = kPi;
            for (std::size_t k = 1; k <= around && top; ++k) {
                const double a = p[(i + n - k) % n].elevation_rad, b = p[(i + k) % n].elevation_rad;
                top = a < p[i].elevation_rad && b <= p[i].elevation_rad;
                left = std::min(left, a);
                right = std::min(right, b);
            }
            const double rises_rad = p[i].elevation_rad - std::max(left, right);
            if (top && rises_rad > radians(0.4)) summits.push_back({i, rises_rad});
        }
        std::ranges::sort(
            summits, [](const Summit& a, const Summit& b) { return a.rises_rad > b.rises_rad; });
        // In the sky, not on ground that stands higher beside.
        const Rect all = plot_;
        const double column = all.width / static_cast<double>(n);
        for (const light::HorizonPoint& h : p) {
            const double top = y(h.elevation_rad);
            labels.keep_clear(Rect{x(h.azimuth_rad), top, column, all.y + all.height - top});
        }
        constexpr std::size_t kMost = 14;
        std::vector<double> named_rad;
        for (const SkylineName& name : of_.names)
            if (named_rad.size() < kMost &&
                labels.add({x(name.azimuth_rad), y(name.elevation_rad)}, name.text,
                           {.size = 10.5, .color = kInk}, 8, LabelPlacer::Side::Above, true))
                named_rad.push_back(name.azimuth_rad);
        std::size_t room = kMost - named_rad.size();
        for (const Summit& summit : summits) {
            const light::HorizonPoint& h = p[summit.at];
            const auto is_named = [&](double azimuth_rad) {
                return std::abs(std::remainder(azimuth_rad - h.azimuth_rad, 2 * kPi)) < radians(1);
            };
            if (std::ranges::any_of(named_rad, is_named)) continue;
            if (room-- == 0) break;
            labels.add({x(h.azimuth_rad), y(h.elevation_rad)},
                       fmt::format("{:.0f} m, {}", h.height_m, distance_text(h.distance_m)),
                       {.size = 10.5, .color = kInk}, 8, LabelPlacer::Side::Above, true);
        }
    }

    void add_keys(double y) {
        double at = kSheetMargin;
        if (of_.day)
            at =
                add_key(*drawing_, at, y, {.stroke = kDay, .width = 3.2}, long_date(of_.day->date));
        if (paths_ && !moon())
            for (const SeasonPath& season : season_paths())
                at = add_key(*drawing_, at, y,
                             {.stroke = season.color, .width = season.month % 3 == 0 ? 2.0 : 1.2},
                             season.label);
        if (paths_ && !moon()) {
            at = add_key(*drawing_, at, y, {.stroke = kFaint, .width = 0.9},
                         fmt::format("full hour (UTC{}), 21 Dec to 21 Jun",
                                     sun::offset_text(paths_->standard_offset_s())));
            add_key(*drawing_, at, y, {.stroke = kFaint, .width = 1.1, .dash = {0.1, 3.2}},
                    "21 Jun to 21 Dec");
            at = kSheetMargin;
            y += 20;
        }
        drawing_->text({at, y}, "ground within", {.size = 11.5, .color = kSoft});
        at += text_width("ground within", 11.5) + 10;
        for (std::size_t b = 0; b < bands_m_.size(); ++b) {
            drawing_->rect({at, y - 9, 14, 11},
                           {.fill = ground_color(nearness(static_cast<int>(b)))});
            const std::string words = distance_text(bands_m_[b]);
            drawing_->text({at + 18, y}, words, {.size = 11.5, .color = kInk});
            at += 18 + text_width(words, 11.5) + 12;
        }
        if (marks_holes_) add_key(*drawing_, at, y, {.stroke = kHole, .width = 3}, kHoleWords);
    }

    const HorizonPanorama& of_;
    std::optional<SunPaths> paths_;
    Rect plot_ = kSheetPlot;
    double middle_rad_ = kPi, low_deg_ = 0, high_deg_ = 90;
    std::vector<std::string> foot_;
    std::vector<double> bands_m_;
    bool marks_holes_ = false;
    Drawing* drawing_ = nullptr;
};

}  // namespace

glm::dvec2 HorizonPanorama::Axes::at(double azimuth_rad, double elevation_rad) const {
    const double from_middle = std::remainder(azimuth_rad - middle_rad, 2 * kPi);
    return {plot.x + plot.width * (0.5 + from_middle / (2 * kPi)),
            plot.y + plot.height * (high_rad - elevation_rad) / (high_rad - low_rad)};
}

Drawing HorizonPanorama::draw(Axes* axes) const {
    Panorama panorama(*this);
    if (axes) *axes = panorama.axes();
    return panorama.draw();
}

}  // namespace relevo::chart
