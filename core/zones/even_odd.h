#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

/// What rings enclose, by the even-odd rule: what an odd number of rings surrounds.
namespace relevo::zones {

/// Corners in order; the last is joined to the first.
using Ring = std::vector<glm::dvec2>;

/// A piece of an outline, from its lower end (in y) to its upper one. No two cross.
struct Edge {
    glm::dvec2 low, high;  ///< low.y < high.y
    bool enters = true;    ///< what is enclosed lies on the side of greater x
};

/// Rings as edges. They may cross, touch and lie upon each other and themselves; level pieces
/// enclose nothing and are left out. Corners must be finite.
///
/// Exact but for the rounding of the points where edges cross. Takes n log n for n corners that lie
/// as outlines do.
std::vector<Edge> even_odd_edges(std::span<const Ring> rings);

/// Encloses [area of the unit of the corners squared].
double area(std::span<const Edge> edges);

}  // namespace relevo::zones
