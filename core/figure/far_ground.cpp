#include "figure/far_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/error.h"
#include "base/held_notices.h"
#include "base/log.h"
#include "light/sweep/sweep.h"
#include "output/tile_plan.h"

namespace relevo::figure {
namespace {

/// Cells of means between a tile and its far ground. With 60 horizons are within 0.1 degrees, but
/// for what sweeps are off anyway (tests/light/test_nested.cpp, tests/cli/test_sun_tiles.cpp).
constexpr double kCellsAHalo = 100;

dem::Source open_quietly(const std::vector<std::string>& paths, const dem::LoadOptions& options) {
    const log::HeldNotices notices;
    return dem::Source::open(paths, options);
}

/// Heights on the grid of a window, with what is known of all posts.
std::unique_ptr<const dem::Heightfield> field_of(Array2d<float> height_m, const dem::Posts& posts,
                                                 const dem::Window& window) {
    const int columns = height_m.width(), rows = height_m.height();
    return std::make_unique<const dem::Heightfield>(dem::Heightfield{
        std::move(height_m), posts.grid().part(window, columns, rows), posts.about(), 1});
}

}  // namespace

int FarGround::means_for(const dem::Posts& posts, double halo_m, const MemoryBudget& memory) {
    const glm::dvec2 spacing_m = posts.grid().post_spacing_m();
    const int means =
        std::max(1, static_cast<int>(halo_m / kCellsAHalo / std::max(spacing_m.x, spacing_m.y)));
    const double kept = double(posts.grid().columns() / means) * (posts.grid().rows() / means);
    if (kept > static_cast<double>(memory.posts) / 4)
        bad_usage(
            fmt::format("--halo: {:.4g}: needs {:.0f} MiB for means of ground beyond, a "
                        "twelfth of --memory; use a larger --halo or --memory",
                        halo_m / 1000, kept * sizeof(float) / (1 << 20)));
    return means;
}

FarGround::FarGround(const std::vector<std::string>& paths, const dem::LoadOptions& options,
                     const dem::Posts& posts, double halo_m, const std::filesystem::path& folder,
                     bool is_planned)
    : posts_(posts),
      source_(open_quietly(paths, options)),
      halo_m_(halo_m),
      means_(means_for(posts, halo_m, options.memory)) {
    const dem::TileReport& tiles = posts.about().tiles;
    source_.allow_voids(tiles.missing.count + tiles.broken.count);
    const int columns = posts.grid().columns(), rows = posts.grid().rows();
    const dem::Window all{0, 0, columns, rows};
    std::optional<Array2d<float>> kept;
    if (is_planned) kept = output::read_heights(folder / output::kMeansFile);
    const int width = std::max(2, columns / means_), height = std::max(2, rows / means_);
    if (!kept || kept->width() != width || kept->height() != height)
        kept = source_.read(all, width, height);
    field_ = field_of(std::move(*kept), posts, all);
    around_ = std::make_shared<const dem::Posts>(*field_);
}

void FarGround::write(const std::filesystem::path& folder) const {
    output::write_heights(
        folder / output::kMeansFile, field_->grid, field_->height_m,
        fmt::format("means of {0} x {0} posts of the DEM; for the tasks of this folder", means_));
}

glm::ivec2 FarGround::width_of(const dem::Grid& grid, double halo_m) {
    return {glm::ceil(halo_m / grid.post_spacing_m())};
}

dem::Window FarGround::halo_of(const dem::Grid& grid, double halo_m, const dem::Window& tile) {
    const glm::ivec2 width = width_of(grid, halo_m);
    return common({tile.column - width.x, tile.row - width.y, tile.columns + 2 * width.x,
                   tile.rows + 2 * width.y},
                  {0, 0, grid.columns(), grid.rows()});
}

void FarGround::require_room(const dem::Grid& grid, double halo_m, const dem::Window& tile,
                             const MemoryBudget& memory) {
    const dem::Window site = halo_of(grid, halo_m, tile);
    const std::int64_t posts = std::int64_t{site.columns} * site.rows;
    if (posts <= memory.posts / 2) return;
    bad_usage(
        fmt::format("--halo: {:.4g}: a tile with its halo has {} x {} posts, half of what --memory "
                    "has room for is {}; use a smaller --halo, smaller --tiles, or --memory {}",
                    halo_m / 1000, site.columns, site.rows, memory.posts / 2,
                    MemoryBudget::mib_for_posts(2 * posts)));
}

Array2d<float> FarGround::read_site(const dem::Window& site) const {
    const dem::Window both = last_ ? common(last_site_, site) : dem::Window{};
    if (both.is_empty()) return source_.read(site, site.columns, site.rows);
    Array2d<float> height_m(site.columns, site.rows);
    const auto put = [&](const dem::Window& part, const Array2d<float>& from, int column, int row) {
        for (int y = 0; y < part.rows; ++y)
            std::copy_n(&from.at(part.column - column, part.row - row + y), part.columns,
                        &height_m.at(part.column - site.column, part.row - site.row + y));
    };
    put(both, last_->height_m, last_site_.column, last_site_.row);
    const auto read = [&](int column, int row, int end_column, int end_row) {
        const dem::Window part{column, row, end_column - column, end_row - row};
        if (!part.is_empty()) put(part, source_.read(part, part.columns, part.rows), column, row);
    };
    read(site.column, site.row, site.end_column(), both.row);
    read(site.column, both.end_row(), site.end_column(), site.end_row());
    read(site.column, both.row, both.column, both.end_row());
    read(both.end_column(), both.row, site.end_column(), both.end_row());
    return height_m;
}

FarGround::Site FarGround::site_of(const dem::Window& tile) {
    const dem::Window site = halo_of(posts_.grid(), halo_m_, tile);
    Site made;
    made.field = field_of(read_site(site), posts_, site);
    last_ = made.field;
    last_site_ = site;
    const bool is_all =
        site.columns == posts_.grid().columns() && site.rows == posts_.grid().rows();
    made.posts = dem::Posts(*made.field).in(is_all ? nullptr : around_);
    made.tile = {tile.column - site.column, tile.row - site.row, tile.columns, tile.rows};
    return made;
}

std::string FarGround::description() const {
    return fmt::format("ground beyond {:.4g} km of a tile is means of {} x {} posts",
                       halo_m_ / 1000, means_, means_);
}

double FarGround::kept_bytes(const dem::Window& tile) const {
    const dem::Window site = halo_of(posts_.grid(), halo_m_, tile);
    return double(site.columns) * site.rows * (sizeof(float) + light::Sweep::kBytesAPost) +
           double(sizeof(float) + light::Sweep::kBytesAPost) *
               static_cast<double>(field_->height_m.size());
}

}  // namespace relevo::figure
