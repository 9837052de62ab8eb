#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "dem/source.h"

namespace relevo::dem {

/// Posts of a source in square tiles, of which those used last are kept in memory.
///
/// Safe on several threads at once: tiles are dealt out to shards, each with a lock of its own, and
/// what is asked for is copied, so that no thread holds a tile that another one wants to replace.
class TileCache {
  public:
    static constexpr int kSide = 64;  ///< posts

    /// @param source     must outlive this
    /// @param max_posts  that are kept, but at least one tile is
    TileCache(const Source& source, std::int64_t max_posts);

    /// Copies a window, row by row. @throws Error (BadInput) where the file is damaged
    void copy(const Window& window, float* height_m);

    std::int64_t posts() const;  ///< that are kept now

  private:
    struct Tile {
        std::int64_t index;
        Array2d<float> height_m;
    };
    struct Shard {
        std::mutex mutex;
        std::list<Tile> tiles;  // the one used last at the front
        std::unordered_map<std::int64_t, std::list<Tile>::iterator> by_index;
    };
    const Tile& tile(Shard& shard, std::int64_t index, const Window& place);

    const Source& source_;
    std::int64_t columns_ = 0;  // of tiles
    std::size_t each_ = 1;      // tiles that a shard keeps
    std::vector<std::unique_ptr<Shard>> shards_;
};

}  // namespace relevo::dem
