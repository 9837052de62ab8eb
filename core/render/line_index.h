#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "dem/lines.h"

namespace relevo::render {

/// Texels of an index at most: 256 MiB of RGBA32F. Addresses are stored as floats, which are exact
/// up to this number.
inline constexpr std::size_t kMostLineTexels = std::size_t{1} << 24;
/// Columns of the texture that holds an index. shaders/lib/lines.glsl has it too.
inline constexpr int kLineColumns = 4096;

struct LineIndexOptions {
    glm::ivec2 size_posts{1};  ///< columns and rows of the DEM
    /// Metres east and north for a step along the row (first column) and along the column (second
    /// one), at a post.
    std::function<glm::dmat2(const glm::dvec2& post)> metres_per_post;
    std::size_t max_texels = kMostLineTexels;
};

/// Lines as texels, in which a shader finds the nearest one.
struct LineIndex {
    std::vector<glm::vec4> texels;
    double accuracy_m = 0;    ///< of lines in the finest cells; 0: as in the file
    double finest_m = 0;      ///< side of the finest cells
    std::size_t dropped = 0;  ///< segments that exceed a cell's number in the finest cells
};

/// Builds a quadtree of square cells over lines. A cell of side C [posts], a power of two, lists
/// the segments that pass the cell widened by C / 2. A distance up to C / 2 is thus found in the
/// list of one cell.
///
/// A cell with at most 16 segments of the file lists these, and has no finer cells if it is at most
/// 2 km wide. Other cells list lines simplified to C / 2048 (Douglas and Peucker 1973), at most
/// 1023 segments of them, the longest. The finest cells are 2 m wide, or wider where the index
/// would exceed its texels.
///
/// Layout, in texels of four floats (shaders/lib/lines.glsl reads it):
///   0                level of the coarsest and of the finest table (C is 2^level), least metres a
///                    post, address of the lines
///   1 + 2 i          table i, of level coarsest - i: corner of its first cell [posts], whole parts
///                    and fractions
///   2 + 2 i          its columns, rows, and address
///   table            address of the finest node of this level or coarser at each cell; 0: none
///   node             number of segments, 1 without finer nodes, level
///   node + 1         its corner [posts], whole parts and fractions
///   node + 2         metres_per_post
///   node + 3         addresses of finer nodes, left and right of the first rows, then of the last
///   node + 4 ...     segments: both ends from the corner [posts]
///   then             of two segments a texel: metres along the line at the first end, its number
///   lines            attribute, kNoLineValue without one
LineIndex make_line_index(const std::vector<dem::PlacedLine>& lines,
                          const LineIndexOptions& options);

/// The attribute of a line that has none.
inline constexpr float kNoLineValue = -1e30F;

}  // namespace relevo::render
