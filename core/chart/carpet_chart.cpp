#include "chart/carpet_chart.h"

#include <cmath>

#include <fmt/format.h>

#include "chart/diagram_parts.h"

namespace relevo::chart {
namespace {

constexpr double kLeft = 116, kTop = 112;  // of a sheet
constexpr double kDayWidth = 2.8, kHourHeight = 20;
// A panel's plot, in the panel.
constexpr double kPanelLeft = 56, kPanelRight = 14, kPanelTop = 8, kPanelBottom = 48;
constexpr double kLit = 40, kLevel = 57;  // lines of hours below the carpet
const Pen kNoon{.stroke = Color{0xb06000}, .width = 1.1, .dash = {4, 3}};

int days_of(int year) {
    return sun::days_between({year, 1, 1}, {year + 1, 1, 1});
}

/// Where days and times are.
struct Plot : Rect {
    int year = 0;

    double day_width() const { return width / days_of(year); }
    double x_of(const sun::Date& date) const {
        return x + sun::days_between({year, 1, 1}, date) * day_width();
    }
    double y_of(double time_of_day_s) const { return y + height * (1 - time_of_day_s / 86400); }
    double right() const { return x + width; }
    double bottom() const { return y + height; }
};

/// Cells of one kind that follow each other are one area.
void add_cells(Drawing& drawing, const light::Carpet& carpet, const Plot& area) {
    drawing.rect(area, {.fill = CarpetChart::color_of(light::Light::Night), .crisp = true});
    for (int row = 0; row < carpet.light.height(); ++row) {
        const sun::Date date = carpet.days[static_cast<std::size_t>(row)].date;
        const double x = area.x_of(date);
        for (int from = 0, to = 0; from < carpet.light.width(); from = to) {
            const light::Light light = carpet.light.at(from, row);
            while (to < carpet.light.width() && carpet.light.at(to, row) == light)
                ++to;
            if (light == light::Light::Night) continue;
            const double top = area.y_of(to * double{1} * carpet.step_s);
            drawing.rect(
                {x, top, area.day_width(), area.y_of(from * double{1} * carpet.step_s) - top},
                {.fill = CarpetChart::color_of(light), .crisp = true});
        }
    }
}

void add_noon(Drawing& drawing, const light::Carpet& carpet, const Plot& area) {
    std::vector<glm::dvec2> noon;
    double before_s = -1;
    for (const light::LightDay& day : carpet.days) {
        const auto transit = day.flat.first(sun::EventKind::Transit);
        if (!transit) continue;
        const sun::CivilTime wall = carpet.zone.local(*transit).wall;
        const double s = wall.hour * 3600 + wall.minute * 60 + wall.second;
        if (before_s >= 0 && std::abs(s - before_s) > 600) noon.emplace_back(std::nan(""));
        before_s = s;
        noon.emplace_back(area.x_of(day.date) + 0.5 * area.day_width(), area.y_of(s));
    }
    drawing.path(std::move(noon), kNoon);
}

void add_hours(Drawing& drawing, const Plot& area) {
    // The first of these that has room for its times.
    constexpr double kText = 14;
    const int step = area.height >= 8 * kText ? 3 : area.height >= 4 * kText ? 6 : 12;
    for (int hour = 0; hour <= 24; hour += 1) {
        const double y = area.y_of(hour * 3600.0);
        if (hour % step == 0 && hour % 24 != 0)
            drawing.line({area.x, y}, {area.right(), y},
                         {.stroke = Color{0xffffff, 0.35}, .width = 0.8});
        drawing.line({area.x - (hour % step == 0 ? 7 : 4), y}, {area.x, y}, {.stroke = kSoft});
        if (hour % step == 0)
            drawing.text({area.x - 11, y + 4}, fmt::format("{:02}:00", hour),
                         {.size = 12, .color = kSoft, .anchor = Anchor::End});
    }
}

/// Names of the months, and their hours of light.
void add_months(Drawing& drawing, const light::Carpet& carpet, const Plot& area, bool is_panel) {
    const int year = carpet.year;
    std::vector<double> month_level_s(12, 0);
    for (std::size_t i = 0; i < carpet.days.size(); ++i)
        month_level_s[static_cast<std::size_t>(carpet.days[i].date.month - 1)] +=
            carpet.day_level_s[i];
    const double bottom = area.bottom();
    for (int month = 1; month <= 12; ++month) {
        const double from = area.x_of({year, month, 1});
        const sun::Date next =
            month < 12 ? sun::Date{year, month + 1, 1} : sun::Date{year + 1, 1, 1};
        const double middle = (from + area.x_of(next)) / 2;
        if (month > 1)
            drawing.line({from, area.y}, {from, bottom},
                         {.stroke = Color{0xffffff, 0.35}, .width = 0.8});
        drawing.line({from, bottom}, {from, bottom + 7}, {.stroke = kSoft});
        const auto i = static_cast<std::size_t>(month - 1);
        drawing.text({middle, bottom + 20}, month_name(month).substr(0, 3),
                     {.size = 13, .color = kInk, .anchor = Anchor::Middle, .bold = true});
        drawing.text({middle, bottom + kLit}, fmt::format("{:.0f} h", carpet.month_lit_s[i] / 3600),
                     {.size = 12, .color = kInk, .anchor = Anchor::Middle});
        if (is_panel) continue;
        drawing.text({middle, bottom + kLevel}, fmt::format("{:.0f} h", month_level_s[i] / 3600),
                     {.size = 12, .color = kSoft, .anchor = Anchor::Middle});
    }
}

void add_frame(Drawing& drawing, const Plot& area, bool is_panel) {
    const double right = area.right(), bottom = area.bottom();
    drawing.line({right, bottom}, {right, bottom + 7}, {.stroke = kSoft});
    drawing.rect(area, {.stroke = kSoft, .width = 1.2});
    drawing.text({area.x - 11, bottom + kLit}, is_panel ? "sun" : "direct sun",
                 {.size = 12, .color = kInk, .anchor = Anchor::End});
    if (is_panel) return;
    drawing.text({area.x - 11, bottom + kLevel}, "level horizon",
                 {.size = 12, .color = kSoft, .anchor = Anchor::End});
    drawing.text({kSheetMargin + 14, area.y + area.height / 2}, "local time",
                 {.size = 12, .color = kSoft, .anchor = Anchor::Middle, .turn_deg = -90});
}

void add_keys(Drawing& drawing, double keys_y) {
    double x = kLeft;
    x = add_key(drawing, x, keys_y, {.fill = CarpetChart::color_of(light::Light::Lit)},
                "direct sun");
    x = add_key(drawing, x, keys_y, {.fill = CarpetChart::color_of(light::Light::Shaded)},
                "sun behind terrain, up over a level horizon");
    x = add_key(drawing, x, keys_y, {.fill = CarpetChart::color_of(light::Light::Twilight)},
                "civil twilight");
    x = add_key(drawing, x, keys_y, {.fill = CarpetChart::color_of(light::Light::Night)}, "night");
    add_key(drawing, x, keys_y, kNoon, "true noon");
}

/// What stands below the title.
std::vector<std::string> title_lines(const CarpetChart& chart) {
    const light::Carpet& carpet = *chart.carpet;
    std::vector<std::string> lines{
        fmt::format("{}, {}", place_text(chart.place), carpet.zone.name()),
        fmt::format("{:.0f} hours of direct sun, {:.0f} over a level horizon ({:.0f} %)",
                    carpet.lit_s / 3600, carpet.level_s / 3600,
                    carpet.level_s > 0 ? 100 * carpet.lit_s / carpet.level_s : 0)};
    if (carpet.not_known_s > 0)
        lines.back() +=
            fmt::format("; {:.3g} hours of direct sun not known because of voids in the DEM",
                        carpet.not_known_s / 3600);
    return lines;
}

void add_plot(Drawing& drawing, const light::Carpet& carpet, const Plot& area, bool is_panel) {
    add_cells(drawing, carpet, area);
    add_noon(drawing, carpet, area);
    add_hours(drawing, area);
    add_months(drawing, carpet, area, is_panel);
    add_frame(drawing, area, is_panel);
}

}  // namespace

Color CarpetChart::color_of(light::Light light) {
    switch (light) {
        case light::Light::Night:
            return {0x1e2943};
        case light::Light::Twilight:
            return {0x6d7fb5};
        case light::Light::Shaded:
            return {0xb5aca0};
        case light::Light::Lit:
            return {0xffd24a};
    }
    return {};
}

Rect CarpetChart::plot() const {
    if (panel)
        return {kPanelLeft, kPanelTop, panel->width - kPanelLeft - kPanelRight,
                panel->height - kPanelTop - kPanelBottom};
    return {kLeft, kTop, days_of(carpet->year) * kDayWidth, 24 * kHourHeight};
}

Drawing CarpetChart::draw() const {
    const Plot area{plot(), carpet->year};
    if (panel) {
        Drawing drawing(panel->width, panel->height);
        add_plot(drawing, *carpet, area, /*is_panel=*/true);
        return drawing;
    }
    const std::vector<std::string> foot{
        "D" + carpet->definition.substr(1) +
            ". Level horizon: the same part of the sun at 0 degrees. Twilight: civil, the sun's "
            "centre less than 6 degrees below the horizon.",
        "T" + horizon_definition.substr(1) + "."};
    const double keys_y = area.bottom() + 92;
    Drawing drawing(1160, keys_y + 22 + foot_height(1160, kSheetMargin, foot) + kSheetMargin);
    const std::string subject = fmt::format("Direct sun through {}", carpet->year);
    const std::vector<std::string> lines = title_lines(*this);
    drawing.describe(title_of(place_name, subject), lines.back());
    add_title(drawing, kSheetMargin, place_name, subject, lines);
    add_plot(drawing, *carpet, area, /*is_panel=*/false);
    add_keys(drawing, keys_y);
    add_foot(drawing, kSheetMargin, foot);
    return drawing;
}

}  // namespace relevo::chart
