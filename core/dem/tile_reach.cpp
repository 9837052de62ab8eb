#include "dem/tile_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/text.h"
#include "base/units.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

/// What to add to a raster's longitudes so that they are on the turn of a grid's: tiles on both
/// sides of the antimeridian, or one that counts past 180 degrees. 0 for projected ones.
double turn_shift(double middle, const Grid& grid) {
    const double of_grid = grid.affine()((grid.columns() - 1) / 2.0, (grid.rows() - 1) / 2.0).x;
    return whole_turns(grid.crs(), of_grid - middle);
}

/// Points around a rectangle.
/// @param steps  of each side
template <typename Body>
void each_edge_point(const glm::dvec2& low, const glm::dvec2& high, int steps, const Body& body) {
    const glm::dvec2 size = high - low;
    for (int i = 0; i <= 4 * steps; ++i) {
        const double t = (i % steps) / double(steps);
        const double w = size.x, h = size.y;
        const std::array<glm::dvec2, 4> sides = {glm::dvec2(t * w, 0), glm::dvec2(w, t * h),
                                                 glm::dvec2(w - t * w, h),
                                                 glm::dvec2(0, h - t * h)};
        body(low + sides[static_cast<std::size_t>(i / steps % 4)]);
    }
}

/// What lies between two corners, in posts.
struct Range {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};
    bool finite = true;

    void add(const glm::dvec2& at) {
        finite = finite && std::abs(at.x) < kMaxPosts && std::abs(at.y) < kMaxPosts;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
};

Window window_of(const glm::dvec2& first, const glm::dvec2& last) {
    return {static_cast<int>(first.x), static_cast<int>(first.y),
            std::max(1, static_cast<int>(last.x - first.x) + 1),
            std::max(1, static_cast<int>(last.y - first.y) + 1)};
}

[[noreturn]] void refuse_not_within(const std::string& name, const Grid& grid,
                                    const std::string& reference) {
    refuse(name, fmt::format(
                     "cannot be resampled to the grid of {}: parts of it are not within {}; bring "
                     "them to one CRS with gdalwarp",
                     reference, grid.crs().name()));
}

/// The posts whose cells an extent in the grid's CRS touches.
std::optional<Window> posts_in(const Extent& e, const Grid& grid) {
    const double shift = turn_shift((e.west + e.east) / 2, grid);
    Range range;
    for (const glm::dvec2& corner : {glm::dvec2(e.west, e.south), glm::dvec2(e.east, e.south),
                                     glm::dvec2(e.west, e.north), glm::dvec2(e.east, e.north)})
        range.add(grid.affine().inverse(corner + glm::dvec2(shift, 0)));
    if (!range.finite) return std::nullopt;
    // Cells reach from half a post before their post to half a post behind it.
    return window_of(glm::floor(range.low + 0.5 + kSamePlace),
                     glm::ceil(range.high - 0.5 - kSamePlace));
}

/// The same of an extent in another CRS; a post more on each side, as its sides bend between the
/// points that are transformed.
std::optional<Window> posts_in(const Extent& e, const geo::Crs& crs, const Grid& grid) {
    constexpr int kSteps = 4;
    Range range;
    each_edge_point({e.west, e.south}, {e.east, e.north}, kSteps, [&](const glm::dvec2& point) {
        range.add(grid.post(crs.to_geodetic(point.x, point.y)));
    });
    if (!range.finite) return std::nullopt;
    return window_of(glm::ceil(range.low) - 1.0, glm::floor(range.high) + 1.0);
}

Window reach_of(const IndexedTile& tile, const TileIndex& index, const Grid& grid,
                const std::string& reference) {
    const geo::Crs& crs = tile.crs < 0 ? grid.crs() : index.crs[static_cast<std::size_t>(tile.crs)];
    const bool is_same = crs.text() == grid.crs().text();
    if (tile.posts) {
        const Grid own(tile.posts->columns, tile.posts->rows, tile.posts->affine, crs);
        constexpr double kNear = 0.5;
        if (const std::optional<Window> place =
                place_on_grid(own, grid, tile.posts_are_near ? kNear : kSamePlace))
            return *place;
        if (!is_same) return place_resampled(own, grid, printable(index.path), reference);
    }
    const std::optional<Window> found =
        is_same ? posts_in(tile.extent, grid) : posts_in(tile.extent, crs, grid);
    if (!found)
        refuse(printable(index.path),
               fmt::format("{} lies too far from the other tiles for one DEM, or not within {}",
                           printable(tile.name), grid.crs().name()));
    return *found;
}

}  // namespace

double whole_turns(const geo::Crs& crs, double offset) {
    if (!crs.is_geographic()) return 0;
    const double turn = 2 * kPi / crs.unit_si();
    return turn * std::round(offset / turn);
}

std::optional<Window> place_on_grid(const Grid& own, const Grid& grid, double off_posts) {
    if (own.crs().text() != grid.crs().text()) return std::nullopt;
    const int columns = own.columns(), rows = own.rows();
    const double shift = turn_shift(own.affine()((columns - 1) / 2.0, (rows - 1) / 2.0).x, grid);
    const auto post = [&](int column, int row) {
        return grid.affine().inverse(own.affine()(column, row) + glm::dvec2(shift, 0));
    };
    const glm::dvec2 first = glm::round(post(0, 0));
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(columns - 1, 0),
                                    glm::ivec2(0, rows - 1), glm::ivec2(columns - 1, rows - 1)}) {
        const glm::dvec2 off = post(corner.x, corner.y) - first - glm::dvec2(corner);
        if (!(std::abs(off.x) < off_posts && std::abs(off.y) < off_posts)) return std::nullopt;
    }
    if (!(std::abs(first.x) < kMaxPosts && std::abs(first.y) < kMaxPosts)) return std::nullopt;
    return Window{static_cast<int>(first.x), static_cast<int>(first.y), columns, rows};
}

Window place_resampled(const Grid& own, const Grid& grid, const std::string& name,
                       const std::string& reference) {
    constexpr int kSteps = 32;
    Range range;
    each_edge_point(
        glm::dvec2(-0.5), glm::dvec2(own.columns(), own.rows()) - 0.5, kSteps,
        [&](const glm::dvec2& edge) { range.add(grid.post(own.place(edge.x, edge.y))); });
    if (!range.finite) refuse_not_within(name, grid, reference);
    return window_of(glm::ceil(range.low), glm::floor(range.high));
}

std::vector<Window> reaches_of(const TileIndex& index, const Grid& grid,
                               const std::string& reference) {
    std::vector<Window> reaches;
    reaches.reserve(index.tiles.size());
    for (const IndexedTile& tile : index.tiles)
        reaches.push_back(reach_of(tile, index, grid, reference));
    return reaches;
}

}  // namespace relevo::dem
