#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <vector>

#include "dem/rasters.h"
#include "dem/resample.h"

// Reads rasters whose grid is not the DEM's. Beyond their edges they continue as the DEM does.

namespace relevo::dem {
namespace {

/// Heights of some posts, row after row, in a larger window of them.
struct Target {
    Window all;
    float* height_m;

    float& at(int column, int row) const {
        return height_m[std::int64_t{row - all.row} * all.columns + column - all.column];
    }
};

/// What of a window is beside another one, which it has a part in common with or not.
std::vector<Window> beside(const Window& w, const Window& inner) {
    const Window in = common(w, inner);
    if (in.is_empty()) return {w};
    return {{w.column, w.row, w.columns, in.row - w.row},
            {w.column, in.end_row(), w.columns, w.end_row() - in.end_row()},
            {w.column, in.row, in.column - w.column, in.rows},
            {in.end_column(), in.row, w.end_column() - in.end_column(), in.rows}};
}

/// The posts that are the nearest to some places, and `more` around them.
Window window_around(const std::vector<glm::dvec2>& places, int more) {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec2& at : places) {
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    if (!(low.x <= high.x)) return {};
    const glm::ivec2 first(glm::round(low)), last(glm::round(high));
    return {first.x - more, first.y - more, last.x - first.x + 1 + 2 * more,
            last.y - first.y + 1 + 2 * more};
}

bool is_in(const Window& w, const glm::dvec2& at) {
    return at.x >= w.column - 0.5 && at.y >= w.row - 0.5 && at.x <= w.end_column() - 0.5 &&
           at.y <= w.end_row() - 0.5;
}

/// Reads the posts of a raster's own grid that are in a window.
void read_own(const Piece& piece, void* dataset, const Window& posts, const Target& target) {
    std::vector<float> heights(static_cast<std::size_t>(posts.columns) *
                               static_cast<std::size_t>(posts.rows));
    piece.read(dataset, {}, posts, heights.data());
    const float* from = heights.data();
    for (int row = posts.row; row < posts.end_row(); ++row, from += posts.columns)
        std::copy_n(from, posts.columns, &target.at(posts.column, row));
}

}  // namespace

/// Some posts beyond the edges of a raster.
struct Rasters::Beyond {
    std::vector<geo::Geodetic> places;
    std::vector<glm::dvec2> on_dem;  ///< columns and rows of the DEM
    std::vector<float> height_m;     ///< NaN where none is known yet
};

void Rasters::read_level(const Piece& piece, void* dataset, const Resolution& level,
                         const Window& window, float* height_m) const {
    constexpr int kAtOnce = 256;  // posts along an edge: on a turned grid they span a square
    if (!piece.resampling) return piece.read(dataset, level, window, height_m);
    const Window whole{0, 0, piece.grid.columns(), piece.grid.rows()};
    const auto read_posts = [&](const Window& posts, float* own_m) {
        const Target target{posts, own_m};
        std::fill_n(own_m, std::ptrdiff_t{posts.columns} * posts.rows, kHole);
        if (const Window inside = common(posts, whole); !inside.is_empty())
            read_own(piece, dataset, inside, target);
        for (const Window& side : beside(posts, whole))
            for (int row = side.row; row < side.end_row(); row += kAtOnce)
                for (int column = side.column; column < side.end_column(); column += kAtOnce) {
                    const Window some = common(side, {column, row, kAtOnce, kAtOnce});
                    const std::vector<float> heights = heights_beyond(piece, some);
                    const float* from = heights.data();
                    for (int y = some.row; y < some.end_row(); ++y, from += some.columns)
                        std::copy_n(from, some.columns, &target.at(some.column, y));
                }
    };
    resample(piece, window, read_posts, height_m);
}

/// Heights of posts of a raster's grid beyond its edges: those of the topmost raster that has one.
std::vector<float> Rasters::heights_beyond(const Piece& piece, const Window& posts) const {
    std::vector<glm::dvec2> all;
    for (int row = posts.row; row < posts.end_row(); ++row)
        for (int column = posts.column; column < posts.end_column(); ++column)
            all.emplace_back(column, row);
    Beyond beyond{
        std::vector<geo::Geodetic>(all.size()), {}, std::vector<float>(all.size(), kHole)};
    piece.grid.place(all, beyond.places);
    for (const geo::Geodetic& place : beyond.places)
        beyond.on_dem.push_back(frame_.grid.post(place) - glm::dvec2(frame_.origin));
    // A tile's outer posts may be nearest to a post of the DEM beyond it.
    const std::vector<int> numbers = within(window_around(beyond.on_dem, 1));
    for (const int number : numbers | std::views::reverse)
        if (std::ranges::any_of(beyond.height_m, [](float h) { return std::isnan(h); }))
            add_beyond(number, beyond);
    return beyond.height_m;
}

/// Adds what a raster has of them, between its own posts alone.
void Rasters::add_beyond(int number, Beyond& beyond) const {
    const Piece* const piece = open(number);
    if (!piece) return;
    const Window has = common(piece->place, reach(number));
    const Window may{has.column - 1, has.row - 1, has.columns + 2, has.rows + 2};
    const glm::ivec2 raster(piece->grid.columns(), piece->grid.rows());
    const Window whole{0, 0, raster.x, raster.y};
    std::vector<glm::dvec2> wanted;  // columns and rows of the raster
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < beyond.places.size(); ++i) {
        if (!std::isnan(beyond.height_m[i]) || !is_in(may, beyond.on_dem[i])) continue;
        const glm::dvec2 at = piece->grid.post(beyond.places[i]);
        if (!is_in(whole, at)) continue;
        wanted.push_back(at);
        numbers.push_back(i);
    }
    if (wanted.empty()) return;
    const Window around = window_around(wanted, 1), inside = common(around, whole);
    std::vector<float> heights(
        static_cast<std::size_t>(around.columns) * static_cast<std::size_t>(around.rows), kHole);
    if (!read(number, *piece, [&](void* dataset) {
            read_own(*piece, dataset, inside, {around, heights.data()});
        }))
        return;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        beyond.height_m[numbers[i]] =
            tent_mean(wanted[i], glm::dvec2(1), around, heights.data(), raster);
}

}  // namespace relevo::dem
