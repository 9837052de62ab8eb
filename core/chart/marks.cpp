#include "chart/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/geometric.hpp>

namespace relevo::chart {
namespace {

// In sizes of the letters.
constexpr double kAscent = 0.76, kHeight = 0.98;  // of a line, with descenders
constexpr double kCapital = 0.72;                 // height of digits and capitals
constexpr double kHalo = 0.15;                    // as Drawing draws it
constexpr double kLongest = 24;                   // of a name; the rest is cut
constexpr double kSymbol = 0.24;                  // half a symbol
constexpr double kSymbolGap = 0.25;               // between symbol and words
constexpr double kStep = 1.15;                    // between two lengths of leaders
constexpr int kArcSteps = 10;
/// Where the leader meets the words, in their width from the left.
constexpr std::array<double, 5> kMeets = {0.5, 0.3, 0.7, 0.1, 0.9};

Rect grown(const Rect& box, double by) {
    return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

class Placer {
  public:
    Placer(const MarkStyle& style, FreeRoom& room) : style_(style), room_(room) {}

    /// @returns whether there was room
    bool place(PlacedMark& mark) {
        const Rect& within = room_.within();
        if (!(mark.at.x >= within.x && mark.at.x <= within.x + within.width &&
              mark.at.y >= within.y && mark.at.y <= within.y + within.height))
            return false;
        if (mark.kind != Symbol::None) {
            const double half = (kSymbol + kHalo) * style_.size;
            mark.symbol = {mark.at.x - half, mark.at.y - half, 2 * half, 2 * half};
            if (!is_free(mark.symbol)) return false;
        }
        mark.leader_top = mark.at.y;
        if (!mark.words.empty() && !place_words(mark)) return false;
        if (mark.kind != Symbol::None) take(mark.symbol);
        if (!mark.words.empty()) take(mark.box);
        if (mark.leader_top < mark.at.y) take(leader(mark));
        return true;
    }

  private:
    bool place_words(PlacedMark& mark) const {
        if (mark.is_centred) return centred(mark);
        return style_.leader > 0 ? above(mark) : beside(mark);
    }

    // Half of the distance around each of two marks.
    void take(const Rect& box) { room_.take(grown(box, style_.distance / 2)); }
    bool is_free(const Rect& box) const { return room_.is_free(grown(box, style_.distance / 2)); }

    Rect leader(const PlacedMark& mark) const {
        return {mark.at.x - 1, mark.leader_top, 2, mark.at.y - mark.leader_top};
    }

    /// Puts the words with their left end at a place, if that is free.
    bool try_words(PlacedMark& mark, const glm::dvec2& baseline, double width) const {
        const double size = style_.size, halo = kHalo * size;
        mark.baseline = baseline;
        mark.box = grown({baseline.x, baseline.y - kAscent * size, width, kHeight * size}, halo);
        return is_free(mark.box);
    }

    /// Around the place, turned.
    bool centred(PlacedMark& mark) const {
        const double size = style_.size, halo = kHalo * size;
        const double turn = mark.turn_deg * std::numbers::pi / 180;
        const double cosine = std::cos(turn), sine = std::abs(std::sin(turn));
        const double width = text_width(mark.words, size) + 2 * halo,
                     height = kHeight * size + 2 * halo;
        const glm::dvec2 half(0.5 * (width * cosine + height * sine),
                              0.5 * (width * sine + height * cosine));
        mark.box = {mark.at.x - half.x, mark.at.y - half.y, 2 * half.x, 2 * half.y};
        mark.baseline = mark.at + 0.5 * kCapital * size * glm::dvec2(-std::sin(turn), cosine);
        return is_free(mark.box);
    }

    /// Right, left, above or below.
    bool beside(PlacedMark& mark) const {
        const double size = style_.size, width = text_width(mark.words, size);
        const double symbol = mark.kind == Symbol::None ? 0 : kSymbol * size;
        const double aside = symbol + (kSymbolGap + kHalo) * size;
        const double level = mark.at.y + (kAscent - kHeight / 2) * size;
        const double up = mark.at.y - aside - (kHeight - kAscent) * size;
        const double down = mark.at.y + aside + kAscent * size;
        const double middle = mark.at.x - width / 2;
        if (mark.kind == Symbol::None) return try_words(mark, {middle, level}, width);
        for (const glm::dvec2& at :
             {glm::dvec2(mark.at.x + aside, level), glm::dvec2(mark.at.x - aside - width, level),
              glm::dvec2(middle, up), glm::dvec2(middle, down)})
            if (try_words(mark, at, width)) return true;
        return false;
    }

    /// Above, over a vertical line as short as possible.
    bool above(PlacedMark& mark) const {
        const double size = style_.size, width = text_width(mark.words, size);
        for (int step = 0; step < kArcSteps; ++step) {
            const double top = mark.at.y - style_.leader - step * kStep * size;
            for (const double meets : kMeets) {
                const glm::dvec2 at(mark.at.x - meets * width,
                                    top - (kHeight - kAscent + kHalo + 0.1) * size);
                if (!try_words(mark, at, width)) continue;
                mark.leader_top = top;
                if (is_free(leader(mark))) return true;
            }
        }
        return false;
    }

    const MarkStyle& style_;
    FreeRoom& room_;
};

void draw_leader(const PlacedMark& mark, const MarkStyle& style, Drawing& drawing) {
    if (mark.leader_top >= mark.at.y) return;
    const glm::dvec2 top(mark.at.x, mark.leader_top);
    const double width = std::max(1.0, style.size / 13);
    drawing.line(mark.at, top, {.stroke = style.halo, .width = 3 * width});
    drawing.line(mark.at, top, {.stroke = style.color, .width = width});
}

void draw_symbol(const PlacedMark& mark, const MarkStyle& style, Drawing& drawing) {
    const double half = kSymbol * style.size;
    // Half of a stroke lies outside: twice the halo's width below, the symbol over it.
    const Pen below{.fill = style.halo, .stroke = style.halo, .width = 2 * kHalo * style.size};
    const Pen over{.fill = style.color};
    for (const Pen& pen : {below, over})
        if (mark.kind == Symbol::Dot)
            drawing.circle(mark.at, 0.8 * half, pen);
        else if (mark.kind == Symbol::Triangle)
            drawing.path({mark.at + glm::dvec2(-half, 0.8 * half), mark.at + glm::dvec2(0, -half),
                          mark.at + glm::dvec2(half, 0.8 * half)},
                         pen, true);
}

}  // namespace

namespace {

/// Where names already are.
class Repeats {
  public:
    explicit Repeats(double distance) : distance_(distance) {}

    bool is_near(const PlacedMark& mark) const {
        if (distance_ <= 0 || mark.words.empty()) return false;
        const auto [first, last] = places_.equal_range(mark.words);
        return std::any_of(first, last, [&](const auto& other) {
            return glm::distance(other.second, mark.at) < distance_;
        });
    }
    void add(const PlacedMark& mark) {
        if (distance_ > 0) places_.emplace(mark.words, mark.at);
    }

  private:
    double distance_;
    std::multimap<std::string, glm::dvec2> places_;
};

PlacedMark without_room(std::size_t index, const MarkPoint& point, const MarkStyle& style) {
    PlacedMark mark{.index = index, .at = point.at};
    mark.words = shortened(std::string(point.name), style.size, kLongest * style.size);
    mark.is_centred = point.turn_deg.has_value();
    mark.turn_deg = point.turn_deg.value_or(0);
    mark.kind = mark.is_centred ? Symbol::None : point.symbol.value_or(style.symbol);
    return mark;
}

}  // namespace

std::vector<PlacedMark> place_marks(std::span<const MarkPoint> points, const MarkStyle& style,
                                    FreeRoom& room) {
    std::vector<PlacedMark> placed;
    Placer placer(style, room);
    Repeats repeats(style.repeat);
    int misses = 0;
    for (std::size_t i = 0; i < points.size() && placed.size() < style.most; ++i) {
        PlacedMark mark = without_room(i, points[i], style);
        if (!repeats.is_near(mark) && placer.place(mark)) {
            repeats.add(mark);
            placed.push_back(std::move(mark));
            misses = 0;
        } else if (++misses >= kMostMisses) {
            break;
        }
    }
    return placed;
}

void draw_marks(std::span<const PlacedMark> marks, const MarkStyle& style, Drawing& drawing) {
    for (const PlacedMark& mark : marks)
        draw_leader(mark, style, drawing);
    for (const PlacedMark& mark : marks)
        draw_symbol(mark, style, drawing);
    for (const PlacedMark& mark : marks)
        if (!mark.words.empty())
            drawing.text(mark.baseline, mark.words,
                         {.size = style.size,
                          .color = style.color,
                          .anchor = mark.is_centred ? Anchor::Middle : Anchor::Start,
                          .turn_deg = mark.turn_deg,
                          .halo = style.halo});
}

}  // namespace relevo::chart
