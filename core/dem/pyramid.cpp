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
    const int columns = coarser(h.width()), rows = coarser(h.height());
    Level coarse;
    coarse.height_m = Array2d<float>(columns, rows);
    if (has_holes_) coarse.coverage = Array2d<std::uint8_t>(columns, rows);
    parallel_for(0, rows, 16, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const int y = std::min(2 * row, h.height() - 1);
            for (int column = 0; column < columns; ++column) {
                const int x = std::min(2 * column, h.width() - 1);
                float sum = 0, weight = 0, covered = 0, whole = 0;
                for (int dy = -1; dy <= 1; ++dy) {
                    if (y + dy < 0 || y + dy >= h.height()) continue;
                    for (int dx = -1; dx <= 1; ++dx) {
                        if (x + dx < 0 || x + dx >= h.width()) continue;
                        const float w = static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
                        const float c = has_holes_
                                            ? static_cast<float>(fine.coverage.at(x + dx, y + dy))
                                            : 255.0f;
                        whole += w;
                        covered += w * c;
                        if (c > 0) {
                            sum += w * c * h.at(x + dx, y + dy);
                            weight += w * c;
                        }
                    }
                }
                coarse.height_m.at(column, row) = weight > 0 ? sum / weight : kHole;
                if (has_holes_)
                    coarse.coverage.at(column, row) =
                        static_cast<std::uint8_t>(std::lrint(covered / whole));
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

float Pyramid::surface(int level, int column, int row) const {
    // The point of the finer level's node (column, row) on this level's triangles, which are
    // divided from the upper right to the lower left corner of their quad, as core's terrain grid
    // is.
    const auto [x, tx] = column_in_coarser(level - 1, column);
    const auto [y, ty] = row_in_coarser(level - 1, row);
    const float upper_right = height(level, x + 1, y), lower_left = height(level, x, y + 1);
    if (tx + ty <= 1) {
        const float upper_left = height(level, x, y);
        return upper_left + tx * (upper_right - upper_left) + ty * (lower_left - upper_left);
    }
    const float lower_right = height(level, x + 1, y + 1);
    return lower_right + (1 - tx) * (lower_left - lower_right) +
           (1 - ty) * (upper_right - lower_right);
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
    Level& here = levels_[static_cast<std::size_t>(level)];
    here.tiles = Array2d<Bounds>(count.x, count.y, {.lowest_m = 1, .highest_m = 0});
    const int nodes = level == 0 ? kTileQuads : 2 * kTileQuads;  // of the level below, along a tile
    const glm::ivec2 below = size(std::max(level - 1, 0));
    parallel_for(0, count.y, 1, [&](int first, int last) {
        for (int ty = first; ty < last; ++ty) {
            for (int tx = 0; tx < count.x; ++tx) {
                Bounds bounds{.lowest_m = std::numeric_limits<float>::max(),
                              .highest_m = std::numeric_limits<float>::lowest()};
                float children_error = 0, own_error = 0;
                double children_squares = 0, own_squares = 0;
                int children = 0, own = 0;
                if (level > 0) {
                    const glm::ivec2 finer = tiles(level - 1);
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
                }
                for (int y = ty * nodes; y <= std::min((ty + 1) * nodes, below.y - 1); ++y) {
                    for (int x = tx * nodes; x <= std::min((tx + 1) * nodes, below.x - 1); ++x) {
                        const float h = heights(std::max(level - 1, 0)).at(x, y);
                        if (std::isnan(h)) continue;
                        if (level == 0) {
                            bounds.lowest_m = std::min(bounds.lowest_m, h);
                            bounds.highest_m = std::max(bounds.highest_m, h);
                        } else {
                            const float error = std::abs(h - surface(level, x, y));
                            if (std::isnan(error)) continue;  // beside holes
                            own_error = std::max(own_error, error);
                            own_squares += double{error} * error;
                            ++own;
                        }
                    }
                }
                bounds.error_m = children_error + own_error;
                bounds.rms_m = static_cast<float>(std::sqrt(
                    children_squares / std::max(children, 1) + own_squares / std::max(own, 1)));
                if (bounds.empty()) bounds = {.lowest_m = 1, .highest_m = 0};
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
