#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "base/parallel_for.h"
#include "dem/pyramid.h"

/// How high tiles are, and how far their nodes and those of coarser levels are from each other.
namespace relevo::dem {
namespace {

/// Pieces of a DEM, each way, whose posts are read to learn how far the levels are from them.
constexpr int kBlockSamples = 3;

}  // namespace

/// Levels up to `top` are compared with the posts of pieces that have 64 quads of that level. Where
/// pieces for all levels would be too large, coarser ones are compared in larger pieces with means
/// that lie as close as the nodes of `top`, and so on.
/// @param max_nodes  posts or means of a piece
void Pyramid::sample_errors(std::int64_t max_nodes) {
    sampled_.resize(static_cast<std::size_t>(first_ + 1));
    const glm::ivec2 posts = size(0);
    const auto side_of = [&](int level) {  // of a piece [posts]
        const std::int64_t side = (std::int64_t{kTileQuads} << level) + 1;
        return glm::ivec2(std::min<std::int64_t>(side, posts.x),
                          std::min<std::int64_t>(side, posts.y));
    };
    const auto nodes = [&](int level, int base) {
        const glm::ivec2 count = side_of(level) >> base;
        return std::int64_t{count.x} * count.y;
    };
    for (int base = 0, top = 0; base < first_; base = top) {
        top = first_;
        while (top > base + 1 && nodes(top, base) > max_nodes)
            --top;
        const glm::ivec2 count = side_of(top) >> base, side = count << base;
        const Bounds below = sampled_[static_cast<std::size_t>(base)];
        for (int j = 0; j < kBlockSamples; ++j) {
            for (int i = 0; i < kBlockSamples; ++i) {
                const auto at = [](int room, int index) {
                    return static_cast<int>(std::int64_t{room} * index / (kBlockSamples - 1));
                };
                const Array2d<float> read = source_->read(
                    {at(posts.x - side.x, i), at(posts.y - side.y, j), side.x, side.y}, count.x,
                    count.y);
                const Pyramid part(read);
                for (int level = base; level <= top; ++level) {
                    Bounds& sampled = sampled_[static_cast<std::size_t>(level)];
                    // A level that the piece has no more is as far from the posts as its last one.
                    const int own = std::min(level - base, part.levels() - 1);
                    sampled.error_m = std::max(
                        sampled.error_m, below.error_m + part.error_m(own, &Bounds::error_m, 1));
                    sampled.rms_m =
                        std::max(sampled.rms_m,
                                 std::hypot(below.rms_m, part.error_m(own, &Bounds::rms_m, 1)));
                }
            }
        }
    }
}

glm::ivec2 Pyramid::tiles(int level) const {
    const glm::ivec2 nodes = size(level);
    return {std::max(1, (nodes.x - 2) / kTileQuads + 1),
            std::max(1, (nodes.y - 2) / kTileQuads + 1)};
}

Pyramid::Bounds Pyramid::bounds(int level, glm::ivec2 tile) const {
    if (level >= first_) return levels_[static_cast<std::size_t>(level)].tiles.at(tile.x, tile.y);
    const int up = first_ - level;
    const glm::ivec2 last = tiles(first_) - 1;
    Bounds bounds = levels_[static_cast<std::size_t>(first_)].tiles.at(
        std::min(tile.x >> up, last.x), std::min(tile.y >> up, last.y));
    const Bounds& sampled = sampled_[static_cast<std::size_t>(level)];
    bounds.error_m = sampled.error_m;
    bounds.rms_m = sampled.rms_m;
    return bounds;
}

void Pyramid::bound_tiles(int level) {
    const glm::ivec2 count = tiles(level);
    levels_[static_cast<std::size_t>(level)].tiles =
        Array2d<Bounds>(count.x, count.y, {.lowest_m = 1, .highest_m = 0});
    if (level > first_) {
        measure_errors(level);
        return;
    }
    // Posts lie above and below their means by no more than the sample has shown.
    const Bounds off = first_ > 0 ? sampled_.back() : Bounds{};
    const Array2d<float>& posts = heights(level);
    parallel_for(0, count.y, 1, [&](int first, int last) {
        for (int ty = first; ty < last; ++ty) {
            for (int tx = 0; tx < count.x; ++tx) {
                float low = std::numeric_limits<float>::max(), high = -low;
                const int end = std::min((tx + 1) * kTileQuads + 1, posts.width());
                for (int y = ty * kTileQuads;
                     y < std::min((ty + 1) * kTileQuads + 1, posts.height()); ++y) {
                    const float* const row = posts.row(y).data();
                    for (int x = tx * kTileQuads; x < end; ++x) {
                        low = row[x] < low ? row[x] : low;  // false for voids
                        high = row[x] > high ? row[x] : high;
                    }
                }
                if (low <= high)
                    levels_.back().tiles.at(tx, ty) = {.lowest_m = low - off.error_m,
                                                       .highest_m = high + off.error_m,
                                                       .error_m = off.error_m,
                                                       .rms_m = off.rms_m};
            }
        }
    });
}

std::optional<Pyramid::Bounds> Pyramid::bounds_of_children(int level, glm::ivec2 tile) const {
    const glm::ivec2 finer = tiles(level - 1);
    Bounds all{.lowest_m = std::numeric_limits<float>::max(),
               .highest_m = std::numeric_limits<float>::lowest()};
    double squares = 0;
    int children = 0;
    for (int y = 2 * tile.y; y <= std::min(2 * tile.y + 1, finer.y - 1); ++y) {
        for (int x = 2 * tile.x; x <= std::min(2 * tile.x + 1, finer.x - 1); ++x) {
            const Bounds child = bounds(level - 1, {x, y});
            if (child.empty()) continue;
            all.lowest_m = std::min(all.lowest_m, child.lowest_m);
            all.highest_m = std::max(all.highest_m, child.highest_m);
            all.error_m = std::max(all.error_m, child.error_m);
            squares += double{child.rms_m} * child.rms_m;
            ++children;
        }
    }
    if (children == 0) return std::nullopt;
    all.rms_m = static_cast<float>(std::sqrt(squares / children));
    return all;
}

Pyramid::Misfit Pyramid::misfit(int level, glm::ivec2 tile,
                                const std::vector<Place>& columns) const {
    const Array2d<float>& fine = heights(level - 1);
    const Array2d<float>& coarse = heights(level);
    const int nodes = 2 * kTileQuads;  // of the finer level, along a tile
    Misfit found;
    double squares = 0;
    int measured = 0;
    const int end = std::min((tile.x + 1) * nodes + 1, fine.width());
    for (int y = tile.y * nodes; y < std::min((tile.y + 1) * nodes + 1, fine.height()); ++y) {
        const Place row = row_in_coarser(level - 1, y);
        const float* const from = fine.row(y).data();
        const float* const upper = coarse.row(row.from).data();
        const float* const lower = coarse.row(std::min(row.from + 1, coarse.height() - 1)).data();
        float row_squares = 0;
        for (int x = tile.x * nodes; x < end; ++x) {
            // On the coarser level's triangles.
            const Place& column = columns[static_cast<std::size_t>(x)];
            const int c = column.from, d = std::min(c + 1, coarse.width() - 1);
            const float surface =
                on_triangles(upper[c], upper[d], lower[c], lower[d], column.share, row.share);
            const float off = std::abs(from[x] - surface);
            if (!(off >= 0)) continue;  // in or next to a void
            found.worst_m = std::max(found.worst_m, off);
            row_squares += off * off;
            ++measured;
        }
        squares += double{row_squares};
    }
    found.mean_square_m2 = squares / std::max(measured, 1);
    return found;
}

void Pyramid::measure_errors(int level) {
    const glm::ivec2 count = tiles(level);
    Level& here = levels_[static_cast<std::size_t>(level)];
    std::vector<Place> columns;
    for (int x = 0; x < heights(level - 1).width(); ++x)
        columns.push_back(column_in_coarser(level - 1, x));
    parallel_for(0, count.y, 1, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < count.x; ++x) {
                std::optional<Bounds> bounds = bounds_of_children(level, {x, y});
                if (!bounds) continue;
                const Misfit off = misfit(level, {x, y}, columns);
                bounds->error_m += off.worst_m;
                bounds->rms_m = static_cast<float>(
                    std::sqrt(double{bounds->rms_m} * bounds->rms_m + off.mean_square_m2));
                here.tiles.at(x, y) = *bounds;
            }
    });
}

float Pyramid::error_m(int level, float Bounds::*measure, double quantile) const {
    if (level < first_) return sampled_[static_cast<std::size_t>(level)].*measure;
    std::vector<float> errors;
    for (const Bounds& bounds : levels_[static_cast<std::size_t>(level)].tiles)
        if (!bounds.empty()) errors.push_back(bounds.*measure);
    if (errors.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(errors.size() - 1));
    std::nth_element(errors.begin(), errors.begin() + at, errors.end());
    return errors[static_cast<std::size_t>(at)];
}

}  // namespace relevo::dem
