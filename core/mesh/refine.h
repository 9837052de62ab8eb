#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/array2d.h"
#include "mesh/delaunay.h"

/// Triangles instead of the posts of a grid, as few as a stated vertical error allows.
///
/// A cell of the grid is ground where all four of its posts have a height; other cells are void.
/// The mesh covers the cells of ground and nothing else.
namespace relevo::mesh {

/// Bits of a post's role in a refinement.
inline constexpr std::uint8_t kGround = 1;  ///< the corner of a cell of ground
inline constexpr std::uint8_t kFixed = 2;   ///< becomes a vertex whatever its height is
inline constexpr std::uint8_t kVertex = 4;  ///< is one

/// Whether the cell between a post and the next column and row is ground.
bool is_ground_cell(const Array2d<float>& height_m, int column, int row);

/// The roles of all posts before any is a vertex: kGround, and kFixed where a void cell is near, so
/// that the mesh follows the outlines of voids.
Array2d<std::uint8_t> ground_roles(const Array2d<float>& height_m);

/// Makes posts void at which two cells of ground touch with nothing but a corner, until there are
/// none: the outlines of what is left do not meet themselves.
/// @returns the number of these posts
std::int64_t cut_corner_contacts(Array2d<float>& height_m);

/// Triangles between posts. The rows of the grid count downwards on a map, on which triangles are
/// counter-clockwise.
struct GridMesh {
    std::vector<LatticePoint> points;
    std::vector<std::uint32_t> corners;                ///< three a triangle
    std::vector<std::array<std::uint32_t, 2>> border;  ///< edges of one triangle, as in it
    std::size_t triangles() const { return corners.size() / 3; }
};

/// Memory of refine() and of its result together, for each triangle [bytes] (measured).
inline constexpr std::int64_t kBytesATriangle = 72;

/// Greedy refinement: begins with two triangles and inserts the post that is farthest from the
/// mesh, until none is farther than `error`. Heights of the mesh are linear in columns and rows.
/// Source: M. Garland, P. S. Heckbert, Fast Polygonal Approximation of Terrains and Height Fields,
/// CMU-CS-95-181, 1995 (algorithm III, with Delaunay triangulation).
/// @param height_m  2 to Delaunay::kMaxSide of both; NaN for voids
/// @param roles     of its posts; become vertices: all kFixed. kVertex is added
/// @param error_m   above 0; infinite: the fixed posts alone
/// @param on_share  is told now and then about how much is done, 0 to 1; may throw
/// @returns none if that takes more than `max_triangles`
std::optional<GridMesh> refine(const Array2d<float>& height_m, Array2d<std::uint8_t>& roles,
                               double error_m, std::int64_t max_triangles,
                               const std::function<void(double)>& on_share = {});

}  // namespace relevo::mesh
