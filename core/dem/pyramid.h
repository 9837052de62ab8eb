#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/heightfield.h"
#include "dem/source.h"

namespace relevo::dem {

/// Interpolates on the two triangles of a quad, which is split from its upper right to its lower
/// left corner as in the drawn grid.
/// @param u, v  0 to 1 from the left and from above
inline float on_triangles(float upper_left, float upper_right, float lower_left, float lower_right,
                          float u, float v) {
    return u + v <= 1 ? upper_left + u * (upper_right - upper_left) + v * (lower_left - upper_left)
                      : lower_right + (1 - u) * (lower_left - lower_right) +
                            (1 - v) * (upper_right - lower_right);
}

/// Heights of a DEM at several levels of detail. The spacing doubles from level to level.
///
/// The nodes of level 0 are the posts. The nodes of level k are every 2^k-th post, counted from the
/// first, and the last post of each row and column: all levels have the same rim. A node's height
/// is the mean of the valid nodes around it on the next finer level, with weights 1 2 1 along rows
/// and columns. Its coverage is the valid fraction of these weights. Coverage averages like area:
/// voids that are cut at a coverage of 0.5 have the same size on all levels. Voids do not affect
/// the heights next to them.
///
/// If the DEM exceeds the memory, block() reads the finer levels as means, from the file's
/// overviews if it has them. The bounds of their tiles are derived from the coarser levels and from
/// a sample of the posts.
class Pyramid {
  public:
    /// Heights and vertical error of a tile.
    struct Bounds;
    /// Whether posts without a height keep none where the means around them have some.
    enum class Voids { Kept, Filled };
    /// The bounds of all tiles, which cost more than the levels themselves: they can be kept.
    struct TileBounds;

    /// Computes coarser levels until one has at most 65 x 65 nodes.
    /// @param posts_m  level 0, NaN in voids; must outlive this
    explicit Pyramid(const Array2d<float>& posts_m);

    /// For a DEM of which only means are in memory.
    /// @param means   as returned by load(): means of a power of two posts; must outlive this
    /// @param source  of the finer levels; must outlive this
    /// @param memory  for the pieces that are sampled
    /// @param voids   of the finer levels
    /// @param known   tile_bounds() of an equal pyramid; null: they are computed
    /// @throws Error (BadInput) if the file is damaged, also from block()
    Pyramid(const Heightfield& means, const Source& source,
            const MemoryBudget& memory = MemoryBudget::of_mib(MemoryBudget::kDefault_mib),
            Voids voids = Voids::Kept, const TileBounds* known = nullptr);

    /// Pyramid of a heightfield of posts or of means.
    /// @param source  null: there are no levels finer than the heightfield
    static Pyramid of(const Heightfield& field, const Source* source, const MemoryBudget& memory,
                      Voids voids = Voids::Kept, const TileBounds* known = nullptr);

    int levels() const { return static_cast<int>(sizes_.size()); }
    int columns() const { return sizes_.front().x; }  ///< of level 0
    int rows() const { return sizes_.front().y; }     ///< of level 0
    int first_in_memory() const { return first_; }    ///< the finest level in memory
    bool has_voids() const { return has_voids_; }

    /// Columns and rows of a level.
    glm::ivec2 size(int level) const;
    /// Column and row of the post at a node.
    glm::ivec2 post(int level, glm::ivec2 node) const;

    /// Height [m] of a node of a level in memory; NaN if its coverage is 0. Indices are clamped to
    /// the level.
    float height(int level, int column, int row) const;
    /// Coverage of a node of a level in memory, 0 to 1. Indices are clamped to the level.
    float coverage(int level, int column, int row) const;

    /// All heights of a level in memory.
    const Array2d<float>& heights(int level) const {
        return level == 0 ? *posts_m_ : levels_[static_cast<std::size_t>(level)].height_m;
    }

    /// Nodes of a rectangle. Nodes of coverage 0 have the mean height of their eight neighbours, so
    /// that the surface is continuous up to the cut at half coverage; 0 if all of these are voids.
    struct Block {
        Array2d<float> height_m;
        Array2d<float> coverage;  ///< 0 to 1
    };
    /// Thread-safe.
    /// @param first  column and row of its first node; indices are clamped to the level
    Block block(int level, glm::ivec2 first, int columns, int rows) const;

    /// Position of a node among those of the next coarser level: from + share, in nodes.
    struct Place {
        int from = 0;
        float share = 0;  ///< 0 to 1
    };
    Place column_in_coarser(int level, int column) const;
    Place row_in_coarser(int level, int row) const;

    /// Heights of a tile's posts [m], and the vertical error of the level's triangles at these
    /// posts.
    struct Bounds {
        float lowest_m = 0;
        float highest_m = 0;  ///< below lowest_m if the tile is all void
        float error_m = 0;    ///< upper bound of the largest error
        /// Root mean square error, from the errors between successive levels as if independent.
        /// Within a third of the true one on the bundled DEM (tests/dem/test_pyramid.cpp).
        float rms_m = 0;

        bool empty() const { return highest_m < lowest_m; }
    };

    /// Quads along a side of a tile.
    static constexpr int kTileQuads = 64;

    /// Columns and rows of a level's tiles.
    glm::ivec2 tiles(int level) const;
    /// Bounds of tile (x, y), which has the columns 64 x to 64 x + 64 and the rows 64 y to 64 y
    /// + 64.
    Bounds bounds(int level, glm::ivec2 tile) const;
    TileBounds tile_bounds() const;

    /// Quantile of the errors of a level's tiles [m].
    /// @param measure   &Bounds::error_m or &Bounds::rms_m
    /// @param quantile  0 to 1
    float error_m(int level, float Bounds::*measure, double quantile) const;

  private:
    struct Level {
        Array2d<float> height_m;
        Array2d<std::uint8_t> coverage;  // 0 to 255; empty without voids
        Array2d<Bounds> tiles;
    };

    /// @param known  bounds of the tiles; null: they are computed
    void make_coarser_levels(const TileBounds* known = nullptr);
    void make_level();
    /// Takes the bounds of the last level's tiles from `known`, or computes them.
    void settle_tiles(const TileBounds* known);
    void bound_tiles(int level);
    /// Vertical errors of a tile's triangles at the nodes of the next finer level.
    struct Misfit {
        float worst_m = 0;
        double mean_square_m2 = 0;
    };
    /// @param columns  column_in_coarser() of these nodes
    Misfit misfit(int level, glm::ivec2 tile, const std::vector<Place>& columns) const;
    /// Union of the bounds of a tile's children; nullopt if all are void.
    std::optional<Bounds> bounds_of_children(int level, glm::ivec2 tile) const;
    void measure_errors(int level);
    Level nodes_of_means(const Array2d<float>& means, glm::ivec2 first_mean, int level,
                         glm::ivec2 first, glm::ivec2 count) const;
    Block read_block(int level, glm::ivec2 first, int columns, int rows) const;
    /// Reads means of side x side posts; voids get what lies between the nodes in memory, if
    /// wanted.
    Array2d<float> read_filled(const Window& window, int side) const;
    /// Height between the nodes of the finest level in memory; NaN next to one without a height.
    float between_nodes(const glm::dvec2& post) const;
    void sample_errors(std::int64_t max_nodes);

    const Array2d<float>* posts_m_ = nullptr;
    const Source* source_ = nullptr;
    bool fills_voids_ = false;  // of levels finer than those in memory
    int first_ = 0;
    std::vector<glm::ivec2> sizes_;  // of all levels
    std::vector<Level> levels_;      // empty below first_; the heights of level 0 are posts_m_
    std::vector<Bounds> sampled_;    // largest sampled errors of levels 0 to first_
    bool has_voids_ = false;
};

struct Pyramid::TileBounds {
    std::vector<Bounds> sampled;         ///< the largest ones of levels not in memory
    std::vector<Array2d<Bounds>> tiles;  ///< of the levels in memory, the finest first
};

}  // namespace relevo::dem
