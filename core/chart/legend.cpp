#include "chart/legend.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::chart {
namespace {

constexpr double kPadding = 10, kBarWidth = 16, kBarHeight = 150, kGap = 6, kLetters = 11,
                 kTitle = 12, kLeastWidth = 92, kMostTitle = 220, kRing = 104, kClassHeight = 20,
                 kStepHeight = 18;
constexpr int kRampSteps = 75;  // of a continuous ramp
constexpr int kLabels = 6;      // at most

/// As few digits as tell neighbours apart.
std::string text_of(double value, double step) {
    const int digits =
        step >= 1 ? 0 : std::min(6, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    const std::string text = fmt::format("{:.{}f}", value, digits);
    return text.find_first_not_of("-0.") == std::string::npos ? fmt::format("{:.{}f}", 0.0, digits)
                                                              : text;
}

/// "07:30". @param value  minutes since midnight
std::string clock_of(double value) {
    const auto minute = static_cast<int>(std::lround(value));
    return fmt::format("{:02}:{:02}", minute / 60, minute % 60);
}

/// Round times of day from one to another, at most so many [min since midnight].
std::vector<double> round_times(double from, double to, int most) {
    std::vector<double> values;
    for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 180.0, 240.0, 360.0}) {
        const double first = std::ceil(from / step - 1e-9), last = std::floor(to / step + 1e-9);
        if (last - first + 1 > most) continue;
        for (double k = first; k <= last; ++k)
            values.push_back(k * step);
        return values;
    }
    return values;
}

struct Label {
    double y;  // of its middle, from the top of the bar
    std::string text;
};

/// Labels beside a bar from the lowest value to the highest one.
std::vector<Label> labels_of(const Legend& of) {
    const double low = of.ramp.stops.front().value, high = of.ramp.stops.back().value;
    const std::string& unit = of.unit;
    std::vector<Label> labels;
    const std::vector<double> values =
        of.clock ? round_times(low, high, kLabels) : round_values(low, high, kLabels);
    const double step = values.size() > 1 ? values[1] - values[0] : std::max(high - low, 1.0);
    for (const double value : values)
        labels.push_back({kBarHeight * (high - value) / (high - low), value_text(of, value, step)});
    if (!labels.empty() && !unit.empty() && unit != "1")
        labels.back().text += (unit == "°" ? "" : " ") + unit;
    return labels;
}

/// Labels beside steps of one height, the highest edge above.
std::vector<Label> labels_of(const std::vector<double>& edges, const std::string& unit) {
    std::vector<Label> labels;
    for (std::size_t k = 0; k < edges.size(); ++k)
        labels.push_back({kStepHeight * static_cast<double>(edges.size() - 1 - k),
                          fmt::format("{:.6g}", edges[k])});
    if (!unit.empty() && unit != "1") labels.back().text += (unit == "°" ? "" : " ") + unit;
    return labels;
}

void draw_steps(const Legend& about, double left, double top, Drawing& drawing) {
    const std::size_t count = about.edges.size() - 1;
    for (std::size_t k = 0; k < count; ++k)
        drawing.rect(
            {left, top + kStepHeight * static_cast<double>(count - 1 - k), kBarWidth, kStepHeight},
            {.fill = about.ramp.at(about.edges[k]), .stroke = Color{0x303030, 0.6}, .width = 0.8});
}

void draw_labels(const std::vector<Label>& labels, double right, double top, Drawing& drawing) {
    for (const Label& label : labels) {
        const double y = top + label.y;
        drawing.line({right, y}, {right + 4, y}, {.stroke = Color{0x303030}, .width = 0.8});
        drawing.text({right + kGap + 2, y + kLetters * 0.36}, label.text,
                     {.size = kLetters, .color = {0x202020}});
    }
}

void draw_bar(const Ramp& ramp, double left, double top, Drawing& drawing) {
    const double low = ramp.stops.front().value, high = ramp.stops.back().value;
    for (int k = 0; k < kRampSteps; ++k) {
        const double share = (k + 0.5) / kRampSteps;
        Color color = ramp.at(high - share * (high - low));
        drawing.rect(
            {left, top + kBarHeight * k / kRampSteps, kBarWidth, kBarHeight / kRampSteps + 0.5},
            {.fill = color, .crisp = true});
    }
    drawing.rect({left, top, kBarWidth, kBarHeight},
                 {.stroke = Color{0x303030, 0.6}, .width = 0.8});
}

/// North at the top, in a square.
void draw_ring(const Ramp& ramp, double left, double top, Drawing& drawing) {
    const glm::dvec2 middle(left + kRing / 2, top + kRing / 2);
    const auto at = [&](double azimuth_deg, double radius) {
        const double turn = radians(azimuth_deg);
        return middle + radius * glm::dvec2(std::sin(turn), -std::cos(turn));
    };
    constexpr double kStep_deg = 5, kOuter = kRing / 2 - kLetters - 3, kInner = 0.45 * kOuter;
    for (double azimuth = 0; azimuth < 360; azimuth += kStep_deg) {
        const double end = azimuth + kStep_deg + 0.5;
        drawing.path({at(azimuth, kInner), at(azimuth, kOuter), at(end, kOuter), at(end, kInner)},
                     {.fill = ramp.at(azimuth + kStep_deg / 2)}, /*closed=*/true);
    }
    for (const double radius : {kInner, kOuter})
        drawing.circle(middle, radius, {.stroke = Color{0x303030, 0.6}, .width = 0.8});
    for (const auto& [azimuth, letter] :
         {std::pair(0.0, "N"), std::pair(90.0, "E"), std::pair(180.0, "S"), std::pair(270.0, "W")})
        drawing.text(at(azimuth, kOuter + 4 + kLetters * 0.36) + glm::dvec2(0, kLetters * 0.36),
                     letter, {.size = kLetters, .color = {0x202020}, .anchor = Anchor::Middle});
}

/// A class a line, its colour on the ground's own.
void draw_classes(const std::vector<Legend::Class>& classes, double left, double top,
                  Drawing& drawing) {
    for (std::size_t k = 0; k < classes.size(); ++k) {
        const double y = top + static_cast<double>(k) * kClassHeight;
        drawing.rect({left, y, kBarWidth, kClassHeight - kGap}, {.fill = Color{0xb8ad94}});
        drawing.rect({left, y, kBarWidth, kClassHeight - kGap},
                     {.fill = classes[k].color, .stroke = Color{0x303030, 0.6}, .width = 0.8});
        drawing.text({left + kBarWidth + kGap, y + (kClassHeight - kGap) / 2 + kLetters * 0.36},
                     classes[k].name, {.size = kLetters, .color = {0x202020}});
    }
}

}  // namespace

std::string value_text(const Legend& legend, double value, double step) {
    return legend.clock ? clock_of(value) : text_of(value, step);
}

std::vector<double> round_values(double from, double to, int most) {
    std::vector<double> values;
    if (!(to > from) || most < 2) return values;
    double step = std::pow(10, std::floor(std::log10((to - from) / most)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
        const double first = std::ceil(from / (step * factor) - 1e-9);
        const double last = std::floor(to / (step * factor) + 1e-9);
        if (last - first + 1 > most) continue;
        for (double k = first; k <= last; ++k)
            values.push_back(k * step * factor);
        return values;
    }
    return values;
}

Drawing legend(const Legend& about) {
    const std::vector<std::string> lines = wrapped(about.title, kTitle, kMostTitle);
    const bool is_range =
        about.classes.empty() &&
        (!about.edges.empty() || (about.ramp.stops.size() > 1 &&
                                  about.ramp.stops.back().value > about.ramp.stops.front().value));
    const std::vector<Label> labels = !is_range || about.ring ? std::vector<Label>{}
                                      : about.edges.empty()   ? labels_of(about)
                                                              : labels_of(about.edges, about.unit);
    double width = about.ring ? kRing + 2 * kPadding : kLeastWidth;
    const double body =
        about.ring               ? kRing
        : !about.classes.empty() ? static_cast<double>(about.classes.size()) * kClassHeight - kGap
        : !about.edges.empty()   ? static_cast<double>(about.edges.size() - 1) * kStepHeight
        : is_range               ? kBarHeight
                                 : kLetters;
    for (const Legend::Class& one : about.classes)
        width =
            std::max(width, kBarWidth + kGap + text_width(one.name, kLetters) + 2 * kPadding + 4);
    for (const std::string& line : lines)
        width = std::max(width, text_width(line, kTitle, true) + 2 * kPadding);
    for (const Label& label : labels)
        width =
            std::max(width, kBarWidth + kGap + text_width(label.text, kLetters) + 2 * kPadding + 4);
    const double top = kPadding + static_cast<double>(lines.size()) * (kTitle + 4) + 4;
    Drawing drawing(std::ceil(width), std::ceil(top + body + kPadding + 2));
    drawing.rect({0, 0, drawing.width(), drawing.height()}, {.fill = Color{0xffffff, 0.82}});
    for (std::size_t k = 0; k < lines.size(); ++k)
        drawing.text({kPadding, kPadding + kTitle * 0.85 + static_cast<double>(k) * (kTitle + 4)},
                     lines[k], {.size = kTitle, .color = {0x202020}, .bold = true});
    if (about.ring) draw_ring(about.ramp, (drawing.width() - kRing) / 2, top, drawing);
    if (!about.classes.empty()) draw_classes(about.classes, kPadding, top, drawing);
    if (!is_range || about.ring) return drawing;
    if (about.edges.empty())
        draw_bar(about.ramp, kPadding, top, drawing);
    else
        draw_steps(about, kPadding, top, drawing);
    draw_labels(labels, kPadding + kBarWidth, top, drawing);
    return drawing;
}

}  // namespace relevo::chart
