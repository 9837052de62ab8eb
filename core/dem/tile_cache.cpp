#include "dem/tile_cache.h"

#include <algorithm>

namespace relevo::dem {
namespace {

constexpr std::int64_t kLeastTiles =
    16;  // of a shard, so that neighbours do not drive each other out
constexpr std::int64_t kMaxShards = 64;

}  // namespace

TileCache::TileCache(const Source& source, std::int64_t max_posts)
    : source_(source), columns_((source.grid().columns() + kSide - 1) / kSide) {
    const std::int64_t tiles = std::max<std::int64_t>(1, max_posts / (kSide * kSide));
    const std::int64_t shards = std::clamp<std::int64_t>(tiles / kLeastTiles, 1, kMaxShards);
    each_ = static_cast<std::size_t>(tiles / shards);
    for (std::int64_t i = 0; i < shards; ++i)
        shards_.push_back(std::make_unique<Shard>());
}

/// With the shard's lock held.
const TileCache::Tile& TileCache::tile(Shard& shard, std::int64_t index, const Window& place) {
    const auto found = shard.by_index.find(index);
    if (found != shard.by_index.end()) {
        shard.tiles.splice(shard.tiles.begin(), shard.tiles, found->second);
        return shard.tiles.front();
    }
    Tile fresh{index, source_.read(place, place.columns, place.rows)};
    if (shard.tiles.size() >= each_) {
        shard.by_index.erase(shard.tiles.back().index);
        shard.tiles.pop_back();
    }
    shard.tiles.push_front(std::move(fresh));
    shard.by_index[index] = shard.tiles.begin();
    return shard.tiles.front();
}

std::int64_t TileCache::posts() const {
    std::int64_t sum = 0;
    for (const auto& shard : shards_) {
        const std::lock_guard lock(shard->mutex);
        for (const Tile& tile : shard->tiles)
            sum += static_cast<std::int64_t>(tile.height_m.size());
    }
    return sum;
}

void TileCache::copy(const Window& window, float* height_m) {
    const Grid& grid = source_.grid();
    const int end_column = window.column + window.columns, end_row = window.row + window.rows;
    for (int row = window.row / kSide * kSide; row < end_row; row += kSide)
        for (int column = window.column / kSide * kSide; column < end_column; column += kSide) {
            const std::int64_t index = std::int64_t{row / kSide} * columns_ + column / kSide;
            // Fibonacci hashing: a line in any direction meets all shards alike.
            const std::uint64_t mixed =
                static_cast<std::uint64_t>(index) * 0x9e3779b97f4a7c15u >> 32;
            Shard& shard = *shards_[mixed % shards_.size()];
            const int first_column = std::max(column, window.column);
            const int columns = std::min(column + kSide, end_column) - first_column;
            const std::lock_guard lock(shard.mutex);
            const Tile& found = tile(shard, index,
                                     {column, row, std::min(kSide, grid.columns() - column),
                                      std::min(kSide, grid.rows() - row)});
            for (int r = std::max(row, window.row); r < std::min(row + kSide, end_row); ++r)
                std::copy_n(&found.height_m.at(first_column - column, r - row), columns,
                            height_m + std::ptrdiff_t{r - window.row} * window.columns +
                                (first_column - window.column));
        }
}

}  // namespace relevo::dem
