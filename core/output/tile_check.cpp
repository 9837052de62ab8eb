#include "output/tile_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/object_store.h"
#include "base/output_file.h"
#include "base/parallel_for.h"
#include "base/paths.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"

namespace relevo::output {
namespace {

namespace fs = std::filesystem;
using State = TileOnDisk::State;

/// Of two transforms, to a thousandth of a post.
bool is_same(const std::array<double, 6>& a, const std::array<double, 6>& b) {
    const double post = std::max(std::abs(b[1]) + std::abs(b[2]), std::abs(b[4]) + std::abs(b[5]));
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= 1e-3 * post)) return false;
    return true;
}

/// The last row of blocks of a band.
bool is_readable(GDALRasterBandH band) {
    int columns = 0, rows = 0;
    GDALGetBlockSize(band, &columns, &rows);
    const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
    const int first = (height - 1) / rows * rows;
    std::vector<float> values(static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(height - first));
    return GDALRasterIO(band, GF_Read, 0, first, width, height - first, values.data(), width,
                        height - first, GDT_Float32, 0, 0) == CE_None;
}

std::string metadata(GDALDatasetH dataset, const char* key) {
    const char* const value = GDALGetMetadataItem(dataset, key, nullptr);
    return value ? value : "";
}

/// Why a file is none of the plan's; empty if it is one.
std::string other_reason(GDALDatasetH dataset, const TilePlan& plan, const PlannedTile& tile) {
    const std::string digest = metadata(dataset, kDigestKey);
    if (digest.empty()) return "is no tile that relevo has made";
    if (digest != plan.digest) {
        const std::string command = metadata(dataset, kCommandKey);
        return command == plan.command
                   ? "was made of another DEM, or by another version of relevo"
                   : fmt::format("is of another command, {}", printable(command));
    }
    std::array<double, 6> transform{};
    GDALGetGeoTransform(dataset, transform.data());
    const dem::Grid grid = plan.grid.part(tile.window, tile.window.columns, tile.window.rows);
    if (GDALGetRasterXSize(dataset) != tile.window.columns ||
        GDALGetRasterYSize(dataset) != tile.window.rows ||
        !is_same(transform, grid.affine().geotransform()))
        return "is of another part of the DEM";
    return {};
}

}  // namespace

TileOnDisk tile_on_disk(const fs::path& folder, const TilePlan& plan, const PlannedTile& tile) {
    const std::string path = (folder / tile.name).string();
    if (!is_taken(path)) return {State::Missing, "is missing"};
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    const char* const drivers[] = {"GTiff", nullptr};
    // GDAL need not look for overviews and metadata in files of their own.
    const char* const all_files[] = {tile.name.c_str(), nullptr};
    if (!object_store_of(path) && !file_inside(folder, tile.name))
        return {State::Other, "is a link to a file of another folder"};
    const dem::Dataset dataset =
        dem::open_by_gdal(AllowedName(path), GDAL_OF_RASTER, drivers, all_files);
    if (!dataset)
        return {State::Damaged, fmt::format("cannot be read, {}", messages.failure(path))};
    for (int band = 1; band <= GDALGetRasterCount(dataset.get()); ++band)
        if (!is_readable(GDALGetRasterBand(dataset.get(), band)) || messages.any_failure())
            return {State::Damaged, fmt::format("cannot be read, {}", messages.failure(path))};
    if (const std::string why = other_reason(dataset.get(), plan, tile); !why.empty())
        return {State::Other, why};
    return {State::Whole, {}};
}

std::vector<TileOnDisk> tiles_on_disk(const fs::path& folder, const TilePlan& plan,
                                      const std::vector<PlannedTile>& tiles) {
    std::vector<TileOnDisk> found(tiles.size());
    parallel_for(0, static_cast<int>(tiles.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto at = static_cast<std::size_t>(i);
            found[at] = tile_on_disk(folder, plan, tiles[at]);
        }
    });
    return found;
}

}  // namespace relevo::output
