#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chart/drawing.h"
#include "chart/free_room.h"

/// Names and symbols at points of a picture, without overlap.
namespace relevo::chart {

enum class Symbol { None, Dot, Triangle };

/// How the marks of a list are drawn. Lengths are in pixels of the picture.
struct MarkStyle {
    double size = 13;  ///< of the letters, as Lettering::size
    Color color{0x202020};
    Color halo{0xffffff, 0.85};
    Symbol symbol = Symbol::Dot;
    double leader = 0;       ///< least length of the line up to the name; 0: none
    double distance = 4;     ///< least distance of a name or symbol from those of other marks
    double repeat = 0;       ///< least distance between two marks of the list with the same name
    std::size_t most = 200;  ///< marks of the list that are placed at most

    bool operator==(const MarkStyle&) const = default;
};

/// A point of a picture with its name, as printable() leaves it; without a name only the symbol is
/// drawn.
struct MarkPoint {
    glm::dvec2 at{0};
    std::string_view name;
    std::optional<Symbol> symbol = {};  ///< nullopt: that of the style
    /// Direction of the name, clockwise from the right [-90, 90 degrees]. The name is centred on
    /// the point then, without symbol and leader.
    std::optional<double> turn_deg = {};
};

/// A mark that has room.
struct PlacedMark {
    std::size_t index = 0;  ///< in the points
    glm::dvec2 at{0};
    std::string words;       ///< the name, shortened if it is very long
    glm::dvec2 baseline{0};  ///< left end of the words, or their middle if they are turned
    double turn_deg = 0;     ///< of the words, clockwise
    bool is_centred = false;
    Rect box;  ///< of the words with their halo; empty without words
    Symbol kind = Symbol::None;
    Rect symbol;            ///< with its halo; empty without a symbol
    double leader_top = 0;  ///< y of the leader's upper end; `at.y` without one
};

/// Finds room for marks. The first points have it first. The result depends on the arguments alone.
/// After kMostMisses points in a row without room the rest is skipped.
/// @param room  taken by the marks that are placed; shared by several lists
/// @returns at most MarkStyle::most, in the order of the points
std::vector<PlacedMark> place_marks(std::span<const MarkPoint> points, const MarkStyle& style,
                                    FreeRoom& room);
inline constexpr int kMostMisses = 5000;

/// Draws placed marks: leaders below, then symbols, then words.
void draw_marks(std::span<const PlacedMark> marks, const MarkStyle& style, Drawing& drawing);

}  // namespace relevo::chart
