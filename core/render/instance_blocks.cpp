#include "render/instance_blocks.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/log.h"
#include "render/tile_grid.h"

namespace relevo::render {
namespace {

/// Blocks are divided until they are small as seen from the eye, or have few cells: what a block
/// has outside of the view is drawn for nothing, and each block costs a draw.
constexpr double kFewCells = 25;
constexpr double kSmall = 0.25;  // diagonal, as a share of the distance
/// Sites of a frame, of which some 400000 are within the range on any other DEM.
constexpr double kMostCellsInAll = 4e6;

class Finder {
  public:
    Finder(const shader::InstanceSet& set, Terrain& terrain, const InstanceView& view)
        : set_(set), terrain_(terrain), view_(view) {}

    /// @param quadrants  as TileDraw
    void add_tile(const TileMesh::Tile& tile, int quadrants) {
        tile_ = tile.instance;
        const glm::dvec2 first(tile_[3].w, tile_[4].w);
        const double posts_a_quad = tile_[5].w;
        const glm::dvec2 end = first + posts_a_quad * glm::dvec2(tile_[0].w, tile_[1].w);
        const double half = posts_a_quad * kTileQuads / 2;
        for (int q = 0; q < 4; ++q) {
            const glm::dvec2 low = first + half * glm::dvec2(q & 1, q >> 1);
            if (quadrants >> q & 1) add(low, min(low + half, end));
        }
    }

    std::vector<InstanceBlock> take() { return std::move(blocks_); }

  private:
    /// @param low, high  posts, half open
    void add(const glm::dvec2& low, const glm::dvec2& high) {
        if (low.x >= high.x || low.y >= high.y) return;
        std::optional<Box> box = terrain_.box(low, high, view_.view.exaggeration);
        if (!box) return;
        box->low -= set_.height_m;
        box->high += set_.height_m;
        const double nearest_m = box->distance(*view_.view.eye_m);
        const double diagonal_m = length(box->high - box->low);
        if (nearest_m > view_.range_m || terrain_.hidden(*box, view_.view)) return;
        const glm::dvec2 cells = (high - low) * view_.cells_per_post;
        if (cells.x * cells.y > kFewCells && diagonal_m > kSmall * nearest_m) {
            const glm::dvec2 middle = 0.5 * (low + high);
            add(low, middle);
            add({middle.x, low.y}, {high.x, middle.y});
            add({low.x, middle.y}, {middle.x, high.y});
            add(middle, high);
            return;
        }
        emit(low, high, *box, nearest_m);
    }

    void emit(const glm::dvec2& low, const glm::dvec2& high, const Box& box, double nearest_m) {
        const glm::dvec2 all = (high - low) * view_.cells_per_post;
        if ((cells_ += all.x * all.y) > kMostCellsInAll) return report_crowded();
        // As in the program, whose numbers are floats.
        const glm::dvec2 first = floor(low * view_.cells_per_post);
        const glm::ivec2 count(floor(high * view_.cells_per_post) - first + 1.0);
        InstanceBlock block{.tile = tile_,
                            .cells = glm::vec4(first, 0, view_.range_m),
                            .count = count,
                            .nearest_m = nearest_m,
                            .farthest_m = nearest_m + length(box.high - box.low),
                            .box = box};
        block.tile[8].w = static_cast<float>(low.x);
        block.tile[9].w = static_cast<float>(low.y);
        block.tile[10].w = static_cast<float>(high.x);
        block.tile[11].w = static_cast<float>(high.y);
        blocks_.push_back(block);
    }

    /// Once: at a pole of a DEM in degrees, where cells are narrow.
    void report_crowded() const {
        static std::once_flag once;
        std::call_once(once, [&] {
            log::warning(fmt::format("{}: more than {:.0f} sites near the eye; some are omitted",
                                     set_.resource, kMostCellsInAll));
        });
    }

    double cells_ = 0;
    const shader::InstanceSet& set_;
    Terrain& terrain_;
    const InstanceView& view_;
    TileMesh::Instance tile_{};
    std::vector<InstanceBlock> blocks_;
};

}  // namespace

double instance_range_m(const shader::InstanceSet& set, double pixel_rad) {
    return std::min(set.height_m / (kLowest_px * pixel_rad), kMostCells * set.spacing_m);
}

InstanceView::InstanceView(const shader::InstanceSet& set, const Terrain& terrain, LodView of,
                           double pixel)
    : view(std::move(of)),
      pixel_rad(pixel),
      range_m(instance_range_m(set, pixel)),
      cells_per_post(terrain.grid().post_spacing_m() / set.spacing_m) {}

std::vector<InstanceBlock> instance_blocks(const shader::InstanceSet& set, Terrain& terrain,
                                           const TileSelection& selection,
                                           const InstanceView& view) {
    Finder finder(set, terrain, view);
    for (const TileMesh::Tile& tile : terrain.tiles_of(selection, *view.view.eye_m))
        finder.add_tile(tile, tile.quadrants);
    return finder.take();
}

}  // namespace relevo::render
