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

/// A value between the four corners of a quad that is divided from its upper right to its lower
/// left corner, as the drawn grid's are.
/// @param u, v  0 to 1 from the left and from above
inline float on_triangles(float upper_left, float upper_right, float lower_left, float lower_right,
                          float u, float v) {
    return u + v <= 1 ? upper_left + u * (upper_right - upper_left) + v * (lower_left - upper_left)
                      : lower_right + (1 - u) * (lower_left - lower_right) +
                            (1 - v) * (upper_right - lower_right);
}

/// The heights of a DEM at spacings that double from level to level.
///
/// Level 0 are the posts. The nodes of level k lie on every 2^k-th post, counted from the first,
/// and on the last post of each row and column, so that all levels have the same rim. A node's
/// height is the mean of the nodes of the next finer level around it with weights 1 2 1 both ways,
/// over those that have a height; its coverage is the share of that weight that has one. Coverage
/// averages like area: where holes are cut at a coverage of one half, they keep their size whatever
/// the level, and heights next to them are those of their neighbours alone.
///
/// Of a DEM that memory does not hold, the finer levels are read when a block of them is asked for,
/// as means that a file's overviews speed up, and what is known of their tiles comes from the
/// coarser levels and from a sample of the posts.
class Pyramid {
  public:
    /// Makes all coarser levels down to one of at most 65 x 65 nodes.
    /// @param posts_m  level 0, NaN for holes; it must outlive this
    explicit Pyramid(const Array2d<float>& posts_m);

    /// Of a DEM of which only means are in memory.
    /// @param means   as load() makes them of the source: a power of two posts to each
    /// @param source  where finer levels are read from; both must outlive this. Of the pieces that
    ///                are sampled, each takes a quarter of the means' memory at most, or 32 MiB.
    /// @throws Error (BadInput) where the file is damaged, also from block()
    Pyramid(const Heightfield& means, const Source& source);

    /// The one or the other, by whether the heightfield has means.
    /// @param source  null: the means are all there is
    static Pyramid of(const Heightfield& field, const Source* source);

    int levels() const { return static_cast<int>(sizes_.size()); }
    int columns() const { return sizes_.front().x; }  ///< of posts
    int rows() const { return sizes_.front().y; }
    int first_in_memory() const { return first_; }  ///< the finest level that is not read
    bool has_holes() const { return has_holes_; }

    /// Nodes of a level, columns and rows.
    glm::ivec2 size(int level) const;
    /// The post that a node lies on.
    glm::ivec2 post(int level, glm::ivec2 node) const;

    /// Height of a node [m] of a level in memory, NaN where its coverage is 0. Indices beyond the
    /// rim repeat it.
    float height(int level, int column, int row) const;
    /// 0 to 1; likewise.
    float coverage(int level, int column, int row) const;

    /// Of a level in memory.
    const Array2d<float>& heights(int level) const {
        return level == 0 ? *posts_m_ : levels_[static_cast<std::size_t>(level)].height_m;
    }

    /// Nodes of a rectangle. Where the coverage is 0, the height is the mean of the eight nodes
    /// around, so that a surface meets the cut half way without a jump; 0 where those have none.
    struct Block {
        Array2d<float> height_m;
        Array2d<float> coverage;  ///< 0 to 1
    };
    /// @param first  its first node; nodes beyond the rim repeat it
    /// Safe on several threads at once.
    Block block(int level, glm::ivec2 first, int columns, int rows) const;

    /// Where a node lies among those of the next coarser level: `share` of the way from node `from`
    /// to the one after.
    struct Place {
        int from = 0;
        float share = 0;
    };
    Place column_in_coarser(int level, int column) const;
    Place row_in_coarser(int level, int row) const;

    /// Lowest and highest post of a tile, and the distance [m] in height from its posts to the
    /// surface of the level's triangles: a bound of the largest, and the root mean square as the
    /// levels' own distances give it if they are independent (within a third of the true one on the
    /// bundled DEM, tests/dem/test_pyramid.cpp).
    struct Bounds {
        float lowest_m = 0;
        float highest_m = 0;  ///< below lowest_m: the tile is a hole
        float error_m = 0;
        float rms_m = 0;

        bool empty() const { return highest_m < lowest_m; }
    };

    /// Quads along a side of a tile.
    static constexpr int kTileQuads = 64;

    /// Tiles of a level, columns and rows.
    glm::ivec2 tiles(int level) const;
    /// Of tile (x, y), which covers the nodes 64 x to 64 x + 64 and likewise y.
    Bounds bounds(int level, glm::ivec2 tile) const;

    /// The error that a share of a level's tiles does not exceed [m].
    /// @param measure  &Bounds::error_m or &Bounds::rms_m
    /// @param share    0 to 1
    float error_m(int level, float Bounds::*measure, double share) const;

  private:
    struct Level {
        Array2d<float> height_m;
        Array2d<std::uint8_t> coverage;  // 0 to 255; empty where there are no holes
        Array2d<Bounds> tiles;
    };

    void make_coarser_levels();
    void make_level();
    void bound_tiles(int level);
    /// How far a tile of a level is from the nodes of the next finer one.
    struct Misfit {
        float worst_m = 0;
        double mean_square_m2 = 0;
    };
    /// @param columns  where those nodes lie between the coarser ones
    Misfit misfit(int level, glm::ivec2 tile, const std::vector<Place>& columns) const;
    /// Of the tiles of the next finer level below a tile; none where all are holes.
    std::optional<Bounds> bounds_of_children(int level, glm::ivec2 tile) const;
    void measure_errors(int level);
    Level nodes_of_means(const Array2d<float>& means, glm::ivec2 first_mean, int level,
                         glm::ivec2 first, glm::ivec2 count) const;
    Block read_block(int level, glm::ivec2 first, int columns, int rows) const;
    void sample_errors(std::int64_t max_nodes);

    const Array2d<float>* posts_m_ = nullptr;
    const Source* source_ = nullptr;
    int first_ = 0;
    std::vector<glm::ivec2> sizes_;  // of all levels
    std::vector<Level> levels_;      // empty below first_; the heights of level 0 are posts_m_
    std::vector<Bounds> sampled_;    // errors of levels 0 to first_, the largest of the sample
    bool has_holes_ = false;
};

}  // namespace relevo::dem
