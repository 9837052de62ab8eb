#include "chart/stamps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace relevo::chart {
namespace {

constexpr Color kInk{0x202020}, kPanel{0xffffff, 0.82}, kEdge{0x303030};
constexpr double kStampLetters = 11, kStampTitle = 17, kStampPadding = 8, kStampMargin = 12,
                 kStampGap = 6, kRatio = 14;
constexpr double kLabelGap = 9;  // around labels of the graticule
constexpr double kMostBar = 200, kMostOfWidth = 0.4;

/// Words on a panel, a line below the other.
Drawing lines_panel(const std::vector<std::string>& lines, double size, bool bold) {
    double width = 0;
    for (const std::string& line : lines)
        width = std::max(width, text_width(line, size, bold));
    const double step = size * 1.4;
    Drawing drawing(std::ceil(width + 2 * kStampPadding),
                    std::ceil(static_cast<double>(lines.size()) * step + 1.3 * kStampPadding));
    drawing.rect({0, 0, drawing.width(), drawing.height()}, {.fill = kPanel});
    for (std::size_t k = 0; k < lines.size(); ++k)
        drawing.text({kStampPadding, kStampPadding + size * 0.8 + static_cast<double>(k) * step},
                     lines[k], {.size = size, .color = kInk, .bold = bold});
    return drawing;
}

/// Light words on a dark ground that lets the picture through.
Drawing bare_lines(const std::vector<std::string>& lines, double size) {
    const Drawing panel = lines_panel(lines, size, false);
    Drawing bare(panel.width(), panel.height());
    bare.rect({0, 0, bare.width(), bare.height()}, {.fill = Color{0x182028, 0.5}});
    double y = kStampPadding + size * 0.8;
    for (const std::string& line : lines) {
        bare.text({kStampPadding, y}, line, {.size = size, .color = {0xffffff, 0.95}});
        y += size * 1.4;
    }
    return bare;
}

/// Black and white parts, 0 at the left end.
Drawing scale_panel(const Stamps::Scale& scale, double width_px, double unit_px) {
    const double most_px = std::min(kMostBar * unit_px, kMostOfWidth * width_px);
    const ScaleBar bar = scale_bar(scale.px_per_m, most_px);
    const double length = bar.length_px / unit_px, height = 5;
    const std::string end = bar.text();
    const double words = scale.where.empty() ? 0 : text_width(scale.where, kStampLetters);
    const double left = kStampPadding + 3, over = text_width(end, kStampLetters) / 2;
    const double top = kStampPadding + kStampLetters + 4;
    const double ratio = scale.ratio.empty() ? 0 : text_width(scale.ratio, kRatio, true);
    const double after = left + length + over + 8;  // the bar
    Drawing drawing(std::ceil(std::max({left + length + std::max(over, kStampPadding) + 2,
                                        left + words + kStampPadding,
                                        ratio > 0 ? after + ratio + kStampPadding : 0})),
                    std::ceil(top + height + kStampPadding + (words > 0 ? kStampLetters + 6 : 0)));
    drawing.rect({0, 0, drawing.width(), drawing.height()}, {.fill = kPanel});
    for (int part = 0; part < 4; ++part)
        drawing.rect({left + length * part / 4, top, length / 4, height},
                     {.fill = part % 2 == 0 ? Color{0x202020} : Color{0xffffff}, .crisp = true});
    drawing.rect({left, top, length, height}, {.stroke = kEdge, .width = 0.8});
    drawing.text({left, top - 4}, "0",
                 {.size = kStampLetters, .color = kInk, .anchor = Anchor::Middle});
    drawing.text({left + length, top - 4}, end,
                 {.size = kStampLetters, .color = kInk, .anchor = Anchor::Middle});
    if (ratio > 0)
        drawing.text({after, top + height}, scale.ratio,
                     {.size = kRatio, .color = kInk, .bold = true});
    if (words > 0)
        drawing.text({left, top + height + kStampLetters + 4}, scale.where,
                     {.size = kStampLetters, .color = kInk});
    return drawing;
}

/// An arrow as long whichever way it points.
Drawing north_panel(const glm::dvec2& north) {
    constexpr double kSide = 52, kArrow = 17, kHalf = 6;
    Drawing drawing(kSide, kSide);
    const glm::dvec2 middle(kSide / 2), aside(-north.y, north.x);
    drawing.circle(middle, kSide / 2, {.fill = kPanel});
    const glm::dvec2 tip = middle + (kArrow - 5) * north, tail = middle - kArrow * north;
    const glm::dvec2 notch = middle - (kArrow - 6) * north;
    drawing.path({tip, tail + kHalf * aside, notch}, {.fill = kInk, .stroke = kInk, .width = 0.8},
                 true);
    drawing.path({tip, tail - kHalf * aside, notch},
                 {.fill = Color{0xffffff}, .stroke = kInk, .width = 0.8}, true);
    drawing.text(middle + (kArrow + 1) * north + glm::dvec2(0, kStampLetters * 0.36), "N",
                 {.size = kStampLetters, .color = kInk, .anchor = Anchor::Middle, .bold = true});
    return drawing;
}

/// All but the labels of the graticule.
struct Panels {
    std::vector<Drawing> legends;
    std::optional<Drawing> title, scale, attribution, lines, north;

    /// @param width_px  of the picture
    Panels(const Stamps& stamps, double width_px, double unit_px) {
        for (const Legend& one : stamps.legends)
            legends.push_back(legend(one));
        if (!stamps.title.empty()) title = lines_panel({stamps.title}, kStampTitle, true);
        if (stamps.scale) scale = scale_panel(*stamps.scale, width_px, unit_px);
        if (!stamps.attribution.empty())
            attribution = lines_panel(
                wrapped(stamps.attribution, 0.85 * kStampLetters, 0.45 * width_px / unit_px),
                0.85 * kStampLetters, false);
        if (!stamps.lines.empty())
            lines = stamps.bare_lines ? bare_lines(stamps.lines, 0.85 * kStampLetters)
                                      : lines_panel(stamps.lines, kStampLetters, false);
        if (stamps.north) north = north_panel(*stamps.north);
    }

    /// Of what stands below a map, with gaps.
    double width_below() const {
        const auto width = [](const std::optional<Drawing>& drawing) {
            return drawing ? drawing->width() + kStampGap : 0;
        };
        return width(north) + width(scale) + std::max(width(attribution), width(lines));
    }
};

enum class Corner { TopLeft, TopRight, BottomLeft, BottomRight };

/// Gives out the room of a picture, from its corners on.
class Layout {
  public:
    /// @param map  that no panel may lie on
    Layout(const glm::dvec2& size_px, double unit_px, const std::optional<Rect>& map)
        : size_px_(size_px), unit_px_(unit_px), map_(map) {}

    double unit_px() const { return unit_px_; }
    const glm::dvec2& size_px() const { return size_px_; }

    /// @returns whether there was room
    bool add(const Drawing& drawing, Corner corner) {
        const double margin = kStampMargin * unit_px_;
        const double width = drawing.width() * unit_px_, height = drawing.height() * unit_px_;
        double& used = used_[static_cast<std::size_t>(corner)];
        const bool right = corner == Corner::TopRight || corner == Corner::BottomRight;
        const bool below = corner == Corner::BottomLeft || corner == Corner::BottomRight;
        const double from = margin + used;
        if (!put(drawing, right ? size_px_.x - margin - width : margin,
                 below ? size_px_.y - from - height : from))
            return false;
        used += height + kStampGap * unit_px_;
        return true;
    }

    /// The same at a place [px].
    bool put(const Drawing& drawing, double x, double y) {
        const Rect at{std::round(x), std::round(y), drawing.width() * unit_px_,
                      drawing.height() * unit_px_};
        if (!is_free(at, 0) || (map_ && overlap(at, *map_))) return false;
        laid_.taken.push_back(at);
        laid_.drawings.push_back({drawing, {at.x, at.y}, unit_px_});
        if (map_) laid_.drawings.back().drawing.fill_opaquely();
        return true;
    }

    /// Whether a place is in the picture and nothing stands there.
    bool is_free(const Rect& at, double margin_px) const {
        if (at.x < margin_px || at.y < margin_px || at.x + at.width > size_px_.x - margin_px ||
            at.y + at.height > size_px_.y - margin_px)
            return false;
        return std::ranges::none_of(laid_.taken,
                                    [&](const Rect& other) { return overlap(at, other); });
    }

    void take(const Rect& at) { laid_.taken.push_back(at); }
    /// Notes what had no room.
    void note(bool there_was_room, const char* name) {
        if (!there_was_room) laid_.missing.emplace_back(name);
    }
    LaidStamps& laid() { return laid_; }

  private:
    glm::dvec2 size_px_;
    double unit_px_;
    std::optional<Rect> map_;
    std::array<double, 4> used_{};  // of each corner, upwards or downwards
    LaidStamps laid_;
};

void add_to_corners(const Panels& panels, Layout& layout) {
    const auto add = [&](const std::optional<Drawing>& drawing, Corner corner, const char* name) {
        if (drawing) layout.note(layout.add(*drawing, corner), name);
    };
    for (const Drawing& one : panels.legends)
        add(one, Corner::TopRight, "legend");
    add(panels.title, Corner::TopLeft, "title");
    add(panels.scale, Corner::BottomLeft, "scale");
    add(panels.attribution, Corner::BottomRight, "attribution");
    add(panels.lines, Corner::BottomRight, "date and sun");
    add(panels.north, Corner::BottomLeft, "north");
}

/// The title no wider than its room, and the left and the right end of what stands below the map:
/// those of the map, or a row about its middle if it is too narrow.
struct Around {
    std::optional<Drawing> title;
    double left, right;
};

Around around(const Panels& panels, const std::string& title, const Rect& map, double margin_px,
              const Layout& layout) {
    const double unit = layout.unit_px(), end = layout.size_px().x - margin_px;
    const double below = unit * panels.width_below();
    Around result{panels.title, map.x, map.x + map.width};
    if (below > map.width) {
        result.left = std::clamp(map.x + (map.width - below) / 2, margin_px,
                                 std::max(margin_px, end - below));
        result.right = std::min(result.left + below, end);
    }
    const double room = (end - map.x) / unit;
    if (panels.title && panels.title->width() > room)
        result.title = lines_panel(
            {shortened(title, kStampTitle, room - 2 * kStampPadding - 1, true)}, kStampTitle, true);
    return result;
}

void add_around(const Panels& panels, const std::string& title, const Rect& map, Layout& layout) {
    const double unit = layout.unit_px(), margin = kStampMargin * unit, gap = kStampGap * unit;
    const glm::dvec2 size = layout.size_px();
    const Around room = around(panels, title, map, margin, layout);
    const auto put = [&](const Drawing& drawing, double x, double y, const char* name) {
        layout.note(layout.put(drawing, x, y), name);
    };
    const double padding = kStampPadding * unit;  // letters begin where the map does
    if (room.title) put(*room.title, map.x - padding, margin, "title");
    double y = map.y;
    for (const Drawing& one : panels.legends) {
        put(one, map.x + map.width + gap, y, "legend");
        y += one.height() * unit + gap;
    }
    double x = room.left;
    for (const auto& [drawing, name] :
         {std::pair(&panels.north, "north"), std::pair(&panels.scale, "scale")}) {
        if (!*drawing) continue;
        put(**drawing, x, size.y - margin - (*drawing)->height() * unit, name);
        x += (*drawing)->width() * unit + gap;
    }
    double from = size.y - margin;
    for (const auto& [drawing, name] : {std::pair(&panels.attribution, "attribution"),
                                        std::pair(&panels.lines, "date and sun")}) {
        if (!*drawing) continue;
        from -= (*drawing)->height() * unit;
        put(**drawing, room.right + padding - (*drawing)->width() * unit, from, name);
        from -= gap;
    }
}

/// A label outside of a map, next to its edge.
Stamps::Label outside(Stamps::Label label, const Rect& map) {
    if (std::abs(label.away.x) > std::abs(label.away.y)) {
        label.at_px.x = label.away.x < 0 ? map.x : map.x + map.width;
        label.away = {label.away.x < 0 ? -1 : 1, 0};
    } else {
        label.at_px.y = label.away.y < 0 ? map.y : map.y + map.height;
        label.away = {0, label.away.y < 0 ? -1 : 1};
    }
    return label;
}

void add_labels(const std::vector<Stamps::Label>& labels, const std::optional<Rect>& map,
                Layout& layout) {
    if (labels.empty()) return;
    const double unit = layout.unit_px(), size = kStampLetters * unit;
    Drawing drawing(layout.size_px().x, layout.size_px().y);
    int left_out = 0;
    for (const Stamps::Label& each : labels) {
        const Stamps::Label label = map ? outside(each, *map) : each;
        const double width = text_width(label.words, size), half = size * 0.5;
        const double reach = std::abs(label.away.x) * width / 2 + std::abs(label.away.y) * half;
        const glm::dvec2 middle = label.at_px + (reach + 5 * unit) * label.away;
        const Rect at{middle.x - width / 2, middle.y - half, width, size};
        if (!layout.is_free(at, 2 * unit)) {
            ++left_out;
            continue;
        }
        layout.take(at);
        drawing.text(
            {middle.x, middle.y + size * 0.36}, label.words,
            {.size = size, .color = kInk, .anchor = Anchor::Middle, .halo = Color{0xffffff, 0.85}});
    }
    LaidStamps& laid = layout.laid();
    laid.drawings.push_back({std::move(drawing), {0, 0}, 1});
    if (left_out > 0)
        laid.missing.push_back(
            fmt::format("{} label{} of the graticule", left_out, left_out > 1 ? "s" : ""));
}

}  // namespace

ScaleBar scale_bar(double px_per_m, double most_px) {
    const double most_m = most_px / px_per_m;
    const double ten = std::pow(10, std::floor(std::log10(most_m) + 1e-9));
    for (const double factor : {5.0, 2.0})
        if (factor * ten <= most_m) return {factor * ten, factor * ten * px_per_m};
    return {ten, ten * px_per_m};
}

std::string ScaleBar::text() const {
    if (length_m >= 999.5) return fmt::format("{:.0f} km", length_m / 1000);
    if (length_m >= 0.995) return fmt::format("{:.0f} m", length_m);
    return length_m >= 0.00995 ? fmt::format("{:.0f} cm", length_m * 100)
                               : fmt::format("{:g} mm", length_m * 1000);
}

double stamp_scale(int width_px, int height_px) {
    return std::clamp(std::min(width_px, height_px) / 900.0, 0.8, 16.0);
}

Margins margins_for(const Stamps& stamps, int width_px, int height_px) {
    return margins_for(stamps, width_px, stamp_scale(width_px, height_px));
}

Margins margins_for(const Stamps& stamps, int width_px, double unit) {
    const Panels panels(stamps, width_px, unit);
    const auto height = [](const std::optional<Drawing>& drawing) {
        return drawing ? drawing->height() : 0.0;
    };
    double legends = 0, labels = 0;
    for (const Drawing& one : panels.legends)
        legends = std::max(legends, one.width() + kStampGap);
    for (const Stamps::Label& label : stamps.graticule)
        labels = std::max(labels, text_width(label.words, kStampLetters) + kLabelGap);
    const double right = height(panels.lines) + height(panels.attribution) +
                         (panels.lines && panels.attribution ? kStampGap : 0);
    const double below = std::max({height(panels.north), height(panels.scale), right});
    const double above = height(panels.title);
    const auto px = [&](double length) { return static_cast<int>(std::ceil(length * unit)); };
    return {.left = px(kStampMargin + labels),
            .top = px(kStampMargin + above + (above > 0 ? kStampGap : 0)),
            .right = px(kStampMargin + legends),
            .bottom = px(kStampMargin + below + (below > 0 ? kStampGap : 0) +
                         (labels > 0 ? kStampLetters + kLabelGap : 0))};
}

LaidStamps lay_out(const Stamps& stamps, const glm::ivec2& size_px, double unit_px,
                   const std::optional<Rect>& map) {
    Layout layout(size_px, unit_px, map);
    const Panels panels(stamps, size_px.x, unit_px);
    if (map)
        add_around(panels, stamps.title, *map, layout);
    else
        add_to_corners(panels, layout);
    add_labels(stamps.graticule, map, layout);
    return std::move(layout.laid());
}

std::vector<std::string> stamp(const Stamps& stamps, image::Image8& picture,
                               std::vector<Rect>* taken, const std::optional<Rect>& map) {
    LaidStamps laid = lay_out(stamps, {picture.width, picture.height},
                              stamp_scale(picture.width, picture.height), map);
    for (const Placed& each : laid.drawings)
        paint(each, picture);
    if (taken) *taken = std::move(laid.taken);
    return std::move(laid.missing);
}

}  // namespace relevo::chart
