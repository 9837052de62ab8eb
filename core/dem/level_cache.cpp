#include "dem/level_cache.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/log.h"
#include "base/paths.h"
#include "base/sha256.h"
#include "dem/file_state.h"
#include "dem/versions.h"

namespace relevo::dem {
namespace {

constexpr int kFormat = 2;  ///< of the files; another one is not read
constexpr std::int64_t kMostBytes = std::int64_t{4} << 30;
constexpr std::size_t kLongestKey = std::size_t{1} << 26;

/// Numbers in front of the arrays, which say how long those are.
struct Sizes {
    std::int32_t width = 0, height = 0, reduction = 0, sampled = 0, tiled_levels = 0, lakes = 0,
                 assumptions = 0, has_sea_floor = 0;
    std::int64_t water_runs = 0, sea_posts = 0, lake_posts = 0;
    double lowest_sea_m = 0;
};
static_assert(std::is_trivially_copyable_v<Pyramid::Bounds>);

/// Posts of one kind, row after row.
struct WaterRun {
    std::int64_t posts;
    std::int64_t kind;
};

std::vector<WaterRun> runs_of(const Array2d<WaterKind>& kinds) {
    std::vector<WaterRun> runs;
    for (const WaterKind kind : kinds) {
        const auto value = static_cast<std::int64_t>(kind);
        if (runs.empty() || runs.back().kind != value) runs.push_back({0, value});
        ++runs.back().posts;
    }
    return runs;
}

bool unpack(const std::vector<WaterRun>& runs, Array2d<WaterKind>& kinds) {
    std::int64_t at = 0;
    for (const WaterRun& run : runs) {
        if (run.posts < 0 || run.posts > std::ssize(kinds) - at || run.kind < 0 ||
            run.kind > static_cast<std::int64_t>(WaterKind::Lake))
            return false;
        std::fill_n(kinds.begin() + at, run.posts, static_cast<WaterKind>(run.kind));
        at += run.posts;
    }
    return at == std::ssize(kinds);
}

void write_tiles(CacheWriter& file, const Array2d<Pyramid::Bounds>& tiles) {
    const std::array<std::int32_t, 2> size{tiles.width(), tiles.height()};
    file.write_values(size.data(), size.size());
    file.write_values(tiles.data(), tiles.size());
}

/// @param most  tiles
bool read_tiles(CacheReader& file, std::int64_t most, Array2d<Pyramid::Bounds>& tiles) {
    std::array<std::int32_t, 2> size{};
    if (!file.read_values(size.data(), size.size()) || size[0] < 1 || size[1] < 1 ||
        std::int64_t{size[0]} * size[1] > most)
        return false;
    tiles = Array2d<Pyramid::Bounds>(size[0], size[1]);
    return file.read_values(tiles.data(), tiles.size());
}

void write_levels(CacheWriter& file, const Heightfield& field, const Pyramid::TileBounds& bounds,
                  const Water& water) {
    const std::vector<WaterRun> runs = runs_of(water.kind);
    const Sizes sizes{field.height_m.width(),
                      field.height_m.height(),
                      field.reduction,
                      static_cast<std::int32_t>(bounds.sampled.size()),
                      static_cast<std::int32_t>(bounds.tiles.size()),
                      water.lakes,
                      static_cast<std::int32_t>(water.assumptions.size()),
                      water.has_sea_floor ? 1 : 0,
                      std::ssize(runs),
                      water.sea_posts,
                      water.lake_posts,
                      water.lowest_sea_m};
    file.write_values(&sizes, 1);
    file.write_values(field.height_m.data(), field.height_m.size());
    file.write_values(bounds.sampled.data(), bounds.sampled.size());
    for (const Array2d<Pyramid::Bounds>& tiles : bounds.tiles)
        write_tiles(file, tiles);
    file.write_values(runs.data(), runs.size());
    for (const std::string& sentence : water.assumptions)
        file.write_text(sentence);
}

/// @returns false if the file is damaged
bool read_water(CacheReader& file, const Sizes& sizes, Water& water) {
    water.lakes = sizes.lakes;
    water.has_sea_floor = sizes.has_sea_floor != 0;
    water.sea_posts = sizes.sea_posts;
    water.lake_posts = sizes.lake_posts;
    water.lowest_sea_m = sizes.lowest_sea_m;
    if (sizes.water_runs < 0 || sizes.water_runs > std::int64_t{sizes.width} * sizes.height)
        return false;
    std::vector<WaterRun> runs(static_cast<std::size_t>(sizes.water_runs));
    if (!file.read_values(runs.data(), runs.size())) return false;
    if (!runs.empty()) {
        water.kind = Array2d<WaterKind>(sizes.width, sizes.height, WaterKind::None);
        if (!unpack(runs, water.kind)) return false;
    }
    for (int i = 0; i < sizes.assumptions; ++i) {
        const std::optional<std::string> sentence = file.read_text(1 << 12);
        if (!sentence) return false;
        water.assumptions.push_back(*sentence);
    }
    return true;
}

/// @param width, height  that the heights must have
/// @returns nullopt if the file is damaged
std::optional<Levels> read_levels(CacheReader& file, int width, int height, int reduction) {
    constexpr int kMostLevels = 40;
    Sizes sizes;
    if (!file.read_values(&sizes, 1) || sizes.width != width || sizes.height != height ||
        sizes.reduction != reduction || sizes.sampled < 0 || sizes.sampled > kMostLevels ||
        sizes.tiled_levels < 1 || sizes.tiled_levels > kMostLevels)
        return std::nullopt;
    Levels levels{.height_m = Array2d<float>(width, height), .reduction = reduction};
    if (!file.read_values(levels.height_m.data(), levels.height_m.size())) return std::nullopt;
    levels.bounds.sampled.resize(static_cast<std::size_t>(sizes.sampled));
    if (!file.read_values(levels.bounds.sampled.data(), levels.bounds.sampled.size()))
        return std::nullopt;
    levels.bounds.tiles.resize(static_cast<std::size_t>(sizes.tiled_levels));
    for (Array2d<Pyramid::Bounds>& tiles : levels.bounds.tiles)
        if (!read_tiles(file, std::ssize(levels.height_m), tiles)) return std::nullopt;
    if (!read_water(file, sizes, levels.water)) return std::nullopt;
    return levels;
}

}  // namespace

CacheFolder user_level_cache() {
    const std::filesystem::path caches = user_folder("XDG_CACHE_HOME", ".cache");
    return {caches.empty() ? caches : caches / "relevo/levels", kMostBytes};
}

std::vector<CachedDem> cached_dems(const CacheFolder& folder) {
    std::vector<CachedDem> dems;
    for (CacheFolder::Entry& entry : folder.entries()) {
        std::optional<CacheReader> file = folder.peek(entry.path.filename().string());
        const std::string key = file ? file->read_text(kLongestKey).value_or("") : "";
        // Lines of files begin with an absolute path.
        const std::size_t begin = key.find("\n/"), end = key.find('\t', begin);
        dems.push_back({end == std::string::npos ? "" : key.substr(begin + 1, end - begin - 1),
                        std::move(entry)});
    }
    return dems;
}

LevelCache::LevelCache(const OpenedFiles& opened, std::span<const std::string> paths,
                       const LoadOptions& options, Holes holes, CacheFolder folder)
    : paths_(paths.begin(), paths.end()),
      options_(options),
      holes_(holes),
      folder_(std::move(folder)),
      key_(options.cached ? key(&opened) : std::nullopt) {}

std::optional<std::string> LevelCache::key(const OpenedFiles* since) const {
    const std::optional<std::string> state = state_of_files(paths_, since);
    if (!state || state->size() > kLongestKey / 2) return std::nullopt;
    return fmt::format("levels {} of relevo {}, GDAL {}\nholes {}\nsample {}\n{}{}", kFormat,
                       RELEVO_VERSION, gdal_version(), static_cast<int>(holes_),
                       options_.memory.work_bytes, text_of(options_), *state);
}

std::string LevelCache::name_of(const std::string& key, int reduction) {
    return sha256_of_text(fmt::format("{}reduction {}\n", key, reduction));
}

bool LevelCache::has(int reduction) const {
    return key_ && folder_.peek(name_of(*key_, reduction)).has_value();
}

std::optional<Levels> LevelCache::read(const Grid& full, int reduction) const {
    if (!key_) return std::nullopt;
    const std::string name = name_of(*key_, reduction);
    std::optional<CacheReader> file = folder_.open(name);
    if (!file) return std::nullopt;
    // What the name stands for is compared, too: a file may have been renamed.
    const bool is_of_dem = file->read_text(kLongestKey) == key_;
    std::optional<Levels> levels;
    if (is_of_dem)
        levels = read_levels(*file, full.columns() / reduction, full.rows() / reduction, reduction);
    if (levels)
        log::debug(
            fmt::format("averaged levels are read from {}", (folder_.folder() / name).string()));
    else
        log::info(fmt::format("{}: damaged, so the DEM is read again",
                              (folder_.folder() / name).string()));
    return levels;
}

void LevelCache::write(const Heightfield& field, const Pyramid& pyramid, const Water& water) const {
    if (!key_) return;
    const auto bytes = static_cast<std::int64_t>(field.height_m.size() * sizeof(float));
    const std::string failure =
        folder_.write(name_of(*key_, field.reduction), bytes, [&](CacheWriter& file) {
            file.write_text(*key_);
            write_levels(file, field, pyramid.tile_bounds(), water);
            return key(nullptr) == key_;
        });
    if (!failure.empty())
        log::info(fmt::format("{}: averaged levels are not kept, {}", folder_.folder().string(),
                              failure));
}

}  // namespace relevo::dem
