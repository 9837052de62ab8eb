#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "base/cache_folder.h"
#include "dem/fill_holes.h"
#include "dem/heightfield.h"
#include "dem/pyramid.h"
#include "dem/source.h"
#include "dem/water.h"

namespace relevo::dem {

/// The user's cache of averaged levels: `relevo/levels` in the folder for caches, up to 4 GiB.
CacheFolder user_level_cache();

/// What pictures of a large DEM need of all its posts.
struct Levels {
    Array2d<float> height_m;  ///< means of `reduction` x `reduction` posts, or all posts
    int reduction = 1;
    Pyramid::TileBounds bounds;  ///< of the pyramid of these heights
    Water water;
};

/// A DEM in the cache.
struct CachedDem {
    std::filesystem::path file;  ///< the first of its files; empty if the entry is damaged
    CacheFolder::Entry entry;
};
/// The one used last first.
std::vector<CachedDem> cached_dems(const CacheFolder& folder);

/// Levels of one DEM in a cache: found again as long as the options and all files that heights are
/// read from are the same. A cache that cannot be read or written changes no result: it is reported
/// with log::debug and log::info, and the DEM is read.
class LevelCache {
  public:
    /// DEMs with fewer posts are not cached: opening them takes well under a second.
    static constexpr std::int64_t kLeastPosts = std::int64_t{1} << 25;

    /// Of no use, unless LoadOptions::cached is set and changes of all files can be seen, and none
    /// has changed since they were opened.
    /// @param opened  Source::opened_files()
    /// @param paths, options  as Source::open() was called with
    /// @param holes  how voids are drawn, on which bounds and water depend
    LevelCache(const OpenedFiles& opened, std::span<const std::string> paths,
               const LoadOptions& options, Holes holes, CacheFolder folder);

    /// Whether read() is likely to find something.
    bool has(int reduction) const;

    /// @param full       of all posts
    /// @param reduction  of the heights
    std::optional<Levels> read(const Grid& full, int reduction) const;

    /// Does nothing if a file has changed since this was made.
    void write(const Heightfield& field, const Pyramid& pyramid, const Water& water) const;

  private:
    std::optional<std::string> key(const OpenedFiles* since) const;
    static std::string name_of(const std::string& key, int reduction);

    std::vector<std::string> paths_;
    LoadOptions options_;
    Holes holes_;
    CacheFolder folder_;
    std::optional<std::string> key_;
};

}  // namespace relevo::dem
