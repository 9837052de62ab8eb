#include "dem/pyramid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel_for.h"

namespace relevo::dem {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// Nodes of the next coarser level along a side.
int coarser(int nodes) {
    return (nodes - 1 + 1) / 2 + 1;
}

}  // namespace

Pyramid::Pyramid(const Array2d<float>& posts_m) : posts_m_(&posts_m) {
    const Array2d<float>& height_m = posts_m;
    std::atomic<bool> holes = false;
    parallel_for(0, height_m.height(), 64, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (const float h : height_m.row(row))
                if (std::isnan(h)) {
                    holes = true;
                    return;
                }
    });
    has_holes_ = holes;
    Level level;
    if (has_holes_) {
        level.coverage = Array2d<std::uint8_t>(height_m.width(), height_m.height());
        for (int row = 0; row < height_m.height(); ++row)
            for (int column = 0; column < height_m.width(); ++column)
                level.coverage.at(column, row) = std::isnan(height_m.at(column, row)) ? 0 : 255;
    }
    levels_.push_back(std::move(level));
    bound_tiles(0);
    while (std::max(size(levels() - 1).x, size(levels() - 1).y) > kTileQuads + 1) {
        make_level();
        bound_tiles(levels() - 1);
    }
}

glm::ivec2 Pyramid::size(int level) const {
    const Array2d<float>& h = heights(level);
    return {h.width(), h.height()};
}

glm::ivec2 Pyramid::post(int level, glm::ivec2 node) const {
    return {std::min(node.x << level, columns() - 1), std::min(node.y << level, rows() - 1)};
}

float Pyramid::height(int level, int column, int row) const {
    const Array2d<float>& h = heights(level);
    return h.at(std::clamp(column, 0, h.width() - 1), std::clamp(row, 0, h.height() - 1));
}

float Pyramid::coverage(int level, int column, int row) const {
    if (!has_holes_) return 1;
    const Array2d<std::uint8_t>& c = levels_[static_cast<std::size_t>(level)].coverage;
    return static_cast<float>(
               c.at(std::clamp(column, 0, c.width() - 1), std::clamp(row, 0, c.height() - 1))) /
           255.0f;
}

void Pyramid::make_level() {
    const Level& fine = levels_.back();
    const Array2d<float>& h = heights(levels() - 1);
    const int width = h.width(), height = h.height();
    const int columns = coarser(width), rows = coarser(height);
    Level coarse;
    coarse.height_m = Array2d<float>(columns, rows);
    if (has_holes_) coarse.coverage = Array2d<std::uint8_t>(columns, rows);
    parallel_for(0, rows, 16, [&](int first, int last) {
        // Weighted sums down the columns, then along them: of heights times coverage, and of
        // coverage, which is a constant where there are no holes.
        std::vector<float> sums(static_cast<std::size_t>(width)), shares(sums.size());
        for (int row = first; row < last; ++row) {
            const int y = std::min(2 * row, height - 1);
            std::fill(sums.begin(), sums.end(), 0.0f);
            std::fill(shares.begin(), shares.end(), 0.0f);
            float whole_down = 0;
            for (int dy = -1; dy <= 1; ++dy) {
                if (y + dy < 0 || y + dy >= height) continue;
                const auto w = static_cast<float>(2 - std::abs(dy));
                whole_down += w;
                const float* const from = h.row(y + dy).data();
                if (!has_holes_) {
                    for (std::size_t x = 0; x < sums.size(); ++x)
                        sums[x] += w * from[x];
                    continue;
                }
                const std::uint8_t* const covered = fine.coverage.row(y + dy).data();
                for (std::size_t x = 0; x < sums.size(); ++x) {
                    const float c = w * static_cast<float>(covered[x]);
                    sums[x] += covered[x] ? c * from[x] : 0.0f;
                    shares[x] += c;
                }
            }
            for (int column = 0; column < columns; ++column) {
                const int x = std::min(2 * column, width - 1);
                float sum = 0, share = 0, whole = 0;
                for (int dx = -1; dx <= 1; ++dx) {
                    if (x + dx < 0 || x + dx >= width) continue;
                    const auto w = static_cast<float>(2 - std::abs(dx));
                    sum += w * sums[static_cast<std::size_t>(x + dx)];
                    share += w * shares[static_cast<std::size_t>(x + dx)];
                    whole += w * whole_down;
                }
                if (!has_holes_) {
                    coarse.height_m.at(column, row) = sum / whole;
                    continue;
                }
                coarse.height_m.at(column, row) = share > 0 ? sum / share : kHole;
                coarse.coverage.at(column, row) =
                    static_cast<std::uint8_t>(std::lrint(share / whole));
            }
        }
    });
    levels_.push_back(std::move(coarse));
}

namespace {

Pyramid::Place place_in_coarser(int level, int node, int posts, int coarse_nodes) {
    const auto post = [&](int n, int l) { return std::min(n << l, posts - 1); };
    const int from = std::min(node / 2, std::max(0, coarse_nodes - 2));
    const int first = post(from, level + 1), last = post(from + 1, level + 1);
    const int here = post(node, level);
    return {from, last > first ? static_cast<float>(here - first) / static_cast<float>(last - first)
                               : 0.0f};
}

}  // namespace

Pyramid::Place Pyramid::column_in_coarser(int level, int column) const {
    return place_in_coarser(level, column, columns(), coarser(size(level).x));
}

Pyramid::Place Pyramid::row_in_coarser(int level, int row) const {
    return place_in_coarser(level, row, rows(), coarser(size(level).y));
}

Pyramid::Block Pyramid::block(int level, glm::ivec2 first, int columns, int rows) const {
    Block block{Array2d<float>(columns, rows), Array2d<float>(columns, rows, 1.0f)};
    const Array2d<float>& h = heights(level);
    for (int y = 0; y < rows; ++y) {
        const auto from = h.row(std::clamp(first.y + y, 0, h.height() - 1));
        const auto to = block.height_m.row(y);
        for (int x = 0; x < columns; ++x)
            to[static_cast<std::size_t>(x)] =
                from[static_cast<std::size_t>(std::clamp(first.x + x, 0, h.width() - 1))];
    }
    if (!has_holes_) return block;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const glm::ivec2 node = first + glm::ivec2(x, y);
            block.coverage.at(x, y) = coverage(level, node.x, node.y);
            if (!std::isnan(block.height_m.at(x, y))) continue;
            float sum = 0;
            int count = 0;
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    const float neighbour = height(level, node.x + dx, node.y + dy);
                    if (std::isnan(neighbour)) continue;
                    sum += neighbour;
                    ++count;
                }
            }
            block.height_m.at(x, y) = count ? sum / static_cast<float>(count) : 0.0f;
        }
    }
    return block;
}

glm::ivec2 Pyramid::tiles(int level) const {
    const glm::ivec2 nodes = size(level);
    return {std::max(1, (nodes.x - 2) / kTileQuads + 1),
            std::max(1, (nodes.y - 2) / kTileQuads + 1)};
}

const Pyramid::Bounds& Pyramid::bounds(int level, glm::ivec2 tile) const {
    return levels_[static_cast<std::size_t>(level)].tiles.at(tile.x, tile.y);
}

void Pyramid::bound_tiles(int level) {
    const glm::ivec2 count = tiles(level);
    levels_[static_cast<std::size_t>(level)].tiles =
        Array2d<Bounds>(count.x, count.y, {.lowest_m = 1, .highest_m = 0});
    if (level > 0) {
        measure_errors(level);
        return;
    }
    const Array2d<float>& posts = heights(0);
    parallel_for(0, count.y, 1, [&](int first, int last) {
        for (int ty = first; ty < last; ++ty) {
            for (int tx = 0; tx < count.x; ++tx) {
                float low = std::numeric_limits<float>::max(), high = -low;
                const int end = std::min((tx + 1) * kTileQuads + 1, posts.width());
                for (int y = ty * kTileQuads;
                     y < std::min((ty + 1) * kTileQuads + 1, posts.height()); ++y) {
                    const float* const row = posts.row(y).data();
                    for (int x = tx * kTileQuads; x < end; ++x) {
                        low = row[x] < low ? row[x] : low;  // false for holes
                        high = row[x] > high ? row[x] : high;
                    }
                }
                if (low <= high)
                    levels_.front().tiles.at(tx, ty) = {.lowest_m = low, .highest_m = high};
            }
        }
    });
}

void Pyramid::measure_errors(int level) {
    const glm::ivec2 count = tiles(level), finer = tiles(level - 1);
    const Array2d<float>& fine = heights(level - 1);
    const Array2d<float>& coarse = heights(level);
    Level& here = levels_[static_cast<std::size_t>(level)];
    std::vector<Place> columns;
    for (int x = 0; x < fine.width(); ++x)
        columns.push_back(column_in_coarser(level - 1, x));
    const int nodes = 2 * kTileQuads;  // of the finer level, along a tile
    parallel_for(0, count.y, 1, [&](int first, int last) {
        for (int ty = first; ty < last; ++ty) {
            for (int tx = 0; tx < count.x; ++tx) {
                Bounds bounds{.lowest_m = std::numeric_limits<float>::max(),
                              .highest_m = std::numeric_limits<float>::lowest()};
                float children_error = 0;
                double children_squares = 0;
                int children = 0;
                for (int y = 2 * ty; y <= std::min(2 * ty + 1, finer.y - 1); ++y) {
                    for (int x = 2 * tx; x <= std::min(2 * tx + 1, finer.x - 1); ++x) {
                        const Bounds& child = this->bounds(level - 1, {x, y});
                        if (child.empty()) continue;
                        bounds.lowest_m = std::min(bounds.lowest_m, child.lowest_m);
                        bounds.highest_m = std::max(bounds.highest_m, child.highest_m);
                        children_error = std::max(children_error, child.error_m);
                        children_squares += double{child.rms_m} * child.rms_m;
                        ++children;
                    }
                }
                if (children == 0) continue;
                float error = 0;
                double squares = 0;
                int measured = 0;
                const int end = std::min((tx + 1) * nodes + 1, fine.width());
                for (int y = ty * nodes; y < std::min((ty + 1) * nodes + 1, fine.height()); ++y) {
                    const Place row = row_in_coarser(level - 1, y);
                    const float* const from = fine.row(y).data();
                    const float* const upper = coarse.row(row.from).data();
                    const float* const lower =
                        coarse.row(std::min(row.from + 1, coarse.height() - 1)).data();
                    float row_squares = 0;
                    for (int x = tx * nodes; x < end; ++x) {
                        // On the coarser level's triangles, which are divided from the upper right
                        // to the lower left corner of their quad, as the terrain grid is.
                        const Place& column = columns[static_cast<std::size_t>(x)];
                        const int c = column.from, d = std::min(c + 1, coarse.width() - 1);
                        const float u = column.share, v = row.share;
                        const float surface =
                            u + v <= 1
                                ? upper[c] + u * (upper[d] - upper[c]) + v * (lower[c] - upper[c])
                                : lower[d] + (1 - u) * (lower[c] - lower[d]) +
                                      (1 - v) * (upper[d] - lower[d]);
                        const float off = std::abs(from[x] - surface);
                        if (!(off >= 0)) continue;  // in or beside a hole
                        error = std::max(error, off);
                        row_squares += off * off;
                        ++measured;
                    }
                    squares += double{row_squares};
                }
                bounds.error_m = children_error + error;
                bounds.rms_m = static_cast<float>(
                    std::sqrt(children_squares / children + squares / std::max(measured, 1)));
                here.tiles.at(tx, ty) = bounds;
            }
        }
    });
}

float Pyramid::error_m(int level, float Bounds::*measure, double share) const {
    std::vector<float> errors;
    for (const Bounds& bounds : levels_[static_cast<std::size_t>(level)].tiles)
        if (!bounds.empty()) errors.push_back(bounds.*measure);
    if (errors.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(errors.size() - 1));
    std::nth_element(errors.begin(), errors.begin() + at, errors.end());
    return errors[static_cast<std::size_t>(at)];
}

}  // namespace relevo::dem
