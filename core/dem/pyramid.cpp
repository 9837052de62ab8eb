#include "dem/pyramid.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <glm/common.hpp>

#include "base/parallel_for.h"

namespace relevo::dem {
namespace {

constexpr float kVoid_m = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kWhole = 255;

/// Nodes of the next coarser level along a side.
int coarser(int nodes) {
    return (nodes - 1 + 1) / 2 + 1;
}

/// Weighted mean of valid heights, and their fraction of the weight.
class NodeMean {
  public:
    void add(float weight, float height_m) {
        whole_ += weight;
        if (std::isnan(height_m)) return;
        sum_ += weight * height_m;
        covered_ += weight;
    }
    float height_m() const { return covered_ > 0 ? sum_ / covered_ : kVoid_m; }
    std::uint8_t coverage() const {
        return static_cast<std::uint8_t>(whole_ > 0 ? std::lrint(kWhole * covered_ / whole_) : 0);
    }

  private:
    float sum_ = 0, covered_ = 0, whole_ = 0;
};

}  // namespace

Pyramid::Pyramid(const Array2d<float>& posts_m)
    : posts_m_(&posts_m), sizes_{{posts_m.width(), posts_m.height()}} {
    std::atomic<bool> has_voids = false;
    parallel_for(0, rows(), 64, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (const float h : posts_m.row(row))
                if (std::isnan(h)) {
                    has_voids = true;
                    return;
                }
    });
    has_voids_ = has_voids;
    Level level;
    if (has_voids_) {
        level.coverage = Array2d<std::uint8_t>(columns(), rows());
        for (int row = 0; row < rows(); ++row)
            for (int column = 0; column < columns(); ++column)
                level.coverage.at(column, row) = std::isnan(posts_m.at(column, row)) ? 0 : kWhole;
    }
    levels_.push_back(std::move(level));
    make_coarser_levels();
}

Pyramid::Pyramid(const Heightfield& means, const Source& source, const MemoryBudget& memory,
                 Voids voids, const TileBounds* known)
    : source_(&source),
      fills_voids_(voids == Voids::Filled),
      sizes_{{source.grid().columns(), source.grid().rows()}} {
    assert(means.reduction >= 2);
    first_ = std::bit_width(static_cast<unsigned>(means.reduction));
    levels_.resize(static_cast<std::size_t>(first_));
    for (int level = 0; level < first_; ++level)
        sizes_.emplace_back(coarser(sizes_.back().x), coarser(sizes_.back().y));
    // A mean says nothing of single posts without a height: that there may be some costs little.
    has_voids_ = true;
    levels_.push_back(nodes_of_means(means.height_m, {0, 0}, first_, {0, 0}, sizes_.back()));
    // A piece has its levels, too.
    constexpr std::int64_t kLeast = 1 << 16;
    if (known)
        sampled_ = known->sampled;
    else
        sample_errors(std::max(kLeast, memory.work_bytes / std::int64_t{2 * sizeof(float)}));
    make_coarser_levels(known);
}

Pyramid Pyramid::of(const Heightfield& field, const Source* source, const MemoryBudget& memory,
                    Voids voids, const TileBounds* known) {
    return source && field.reduction > 1 ? Pyramid(field, *source, memory, voids, known)
                                         : Pyramid(field.height_m);
}

void Pyramid::make_coarser_levels(const TileBounds* known) {
    settle_tiles(known);
    while (std::max(sizes_.back().x, sizes_.back().y) > kTileQuads + 1) {
        make_level();
        settle_tiles(known);
    }
}

void Pyramid::settle_tiles(const TileBounds* known) {
    const int level = levels() - 1;
    if (known)
        levels_.back().tiles = known->tiles[static_cast<std::size_t>(level - first_)];
    else
        bound_tiles(level);
}

Pyramid::TileBounds Pyramid::tile_bounds() const {
    TileBounds all{sampled_, {}};
    for (int level = first_; level < levels(); ++level)
        all.tiles.push_back(levels_[static_cast<std::size_t>(level)].tiles);
    return all;
}

glm::ivec2 Pyramid::size(int level) const {
    return sizes_[static_cast<std::size_t>(level)];
}

glm::ivec2 Pyramid::post(int level, glm::ivec2 node) const {
    const auto at = [level](int index, int posts) {
        return static_cast<int>(std::min<std::int64_t>(std::int64_t{index} << level, posts - 1));
    };
    return {at(node.x, columns()), at(node.y, rows())};
}

float Pyramid::height(int level, int column, int row) const {
    const Array2d<float>& h = heights(level);
    return h.at(std::clamp(column, 0, h.width() - 1), std::clamp(row, 0, h.height() - 1));
}

float Pyramid::coverage(int level, int column, int row) const {
    if (!has_voids_) return 1;
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
    if (has_voids_) coarse.coverage = Array2d<std::uint8_t>(columns, rows);
    parallel_for(0, rows, 16, [&](int first, int last) {
        // Weighted sums down the columns, then along them: of heights times coverage, and of
        // coverage, which is a constant without voids.
        std::vector<float> sums(static_cast<std::size_t>(width)), shares(sums.size());
        for (int row = first; row < last; ++row) {
            const int y = std::min(2 * row, height - 1);
            std::ranges::fill(sums, 0.0f);
            std::ranges::fill(shares, 0.0f);
            float whole_down = 0;
            for (int dy = -1; dy <= 1; ++dy) {
                if (y + dy < 0 || y + dy >= height) continue;
                const auto w = static_cast<float>(2 - std::abs(dy));
                whole_down += w;
                const float* const from = h.row(y + dy).data();
                if (!has_voids_) {
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
                if (!has_voids_) {
                    coarse.height_m.at(column, row) = sum / whole;
                    continue;
                }
                coarse.height_m.at(column, row) = share > 0 ? sum / share : kVoid_m;
                coarse.coverage.at(column, row) =
                    static_cast<std::uint8_t>(std::lrint(share / whole));
            }
        }
    });
    levels_.push_back(std::move(coarse));
    sizes_.emplace_back(columns, rows);
}

namespace {

/// Of the eight neighbours and the node itself, those that have a height; 0 if none has.
template <typename HeightAt>
float mean_around(const HeightAt& height_at) {
    float sum = 0;
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const float neighbour = height_at(dx, dy);
            if (std::isnan(neighbour)) continue;
            sum += neighbour;
            ++count;
        }
    }
    return count ? sum / static_cast<float>(count) : 0.0f;
}

Pyramid::Place place_in_coarser(int level, int node, int posts, int coarse_nodes) {
    const auto post = [&](int n, int l) {
        return static_cast<int>(std::min<std::int64_t>(std::int64_t{n} << l, posts - 1));
    };
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
    if (level < first_) return read_block(level, first, columns, rows);
    Block block{Array2d<float>(columns, rows), Array2d<float>(columns, rows, 1.0f)};
    const Array2d<float>& h = heights(level);
    for (int y = 0; y < rows; ++y) {
        const auto from = h.row(std::clamp(first.y + y, 0, h.height() - 1));
        const auto to = block.height_m.row(y);
        for (int x = 0; x < columns; ++x)
            to[static_cast<std::size_t>(x)] =
                from[static_cast<std::size_t>(std::clamp(first.x + x, 0, h.width() - 1))];
    }
    if (!has_voids_) return block;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const glm::ivec2 node = first + glm::ivec2(x, y);
            block.coverage.at(x, y) = coverage(level, node.x, node.y);
            if (!std::isnan(block.height_m.at(x, y))) continue;
            block.height_m.at(x, y) = mean_around(
                [&](int dx, int dy) { return height(level, node.x + dx, node.y + dy); });
        }
    }
    return block;
}

Pyramid::Level Pyramid::nodes_of_means(const Array2d<float>& means, glm::ivec2 first_mean,
                                       int level, glm::ivec2 first, glm::ivec2 count) const {
    // A node lies where two means meet, half a post towards the second; their weights put the
    // middle of what they cover on it.
    const int side = 1 << (level - 1);  // of a mean [posts]
    const float before = 0.5f * static_cast<float>(side - 1) / static_cast<float>(side);
    const std::array<float, 2> weight{before, 1 - before};
    // The last nodes may lie beyond what the means cover: the last of these stand for it.
    const glm::ivec2 last_mean = size(0) / side - 1;
    Level nodes{Array2d<float>(count.x, count.y), Array2d<std::uint8_t>(count.x, count.y), {}};
    parallel_for(0, count.y, 64, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < count.x; ++x) {
                NodeMean mean;
                for (int j = 0; j < 2; ++j) {
                    const int row = std::min(2 * (first.y + y) - 1 + j, last_mean.y) - first_mean.y;
                    if (row < 0 || row >= means.height()) continue;
                    for (int i = 0; i < 2; ++i) {
                        const int column =
                            std::min(2 * (first.x + x) - 1 + i, last_mean.x) - first_mean.x;
                        if (column < 0 || column >= means.width()) continue;
                        mean.add(weight[static_cast<std::size_t>(i)] *
                                     weight[static_cast<std::size_t>(j)],
                                 means.at(column, row));
                    }
                }
                nodes.height_m.at(x, y) = mean.height_m();
                nodes.coverage.at(x, y) = mean.coverage();
            }
        }
    });
    return nodes;
}

Array2d<float> Pyramid::read_filled(const Window& window, int side) const {
    const glm::ivec2 size(window.columns / side, window.rows / side);
    Array2d<float> read = source_->read(window, size.x, size.y);
    if (!fills_voids_) return read;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            if (std::isnan(read.at(x, y)))
                read.at(x, y) = between_nodes(glm::dvec2(window.column, window.row) +
                                              glm::dvec2(x, y) * double(side) + 0.5 * (side - 1));
    return read;
}

float Pyramid::between_nodes(const glm::dvec2& post) const {
    const glm::ivec2 last = size(first_) - 1;
    const glm::dvec2 at = glm::clamp(post / double(1 << first_), glm::dvec2(0), glm::dvec2(last));
    const glm::ivec2 low = glm::min(glm::ivec2(at), glm::max(last - 1, 0)),
                     high = glm::min(low + 1, last);
    const glm::vec2 share(at - glm::dvec2(low));
    const auto across = [&](int row) {
        return glm::mix(height(first_, low.x, row), height(first_, high.x, row), share.x);
    };
    return glm::mix(across(low.y), across(high.y), share.y);
}

Pyramid::Block Pyramid::read_block(int level, glm::ivec2 first, int columns, int rows) const {
    // One node more on each side, for the means next to voids; then nodes on the DEM alone.
    const glm::ivec2 last = size(level) - 1;
    const glm::ivec2 from = glm::clamp(first - 1, glm::ivec2(0), last);
    const glm::ivec2 to = glm::clamp(first + glm::ivec2(columns, rows), glm::ivec2(0), last);
    const glm::ivec2 count = to - from + 1;
    const glm::ivec2 posts = size(0);

    Level nodes;
    if (level < 2) {
        // Posts, or their means with weights 1 2 1.
        const glm::ivec2 low = glm::max(post(level, from) - level, glm::ivec2(0));
        const glm::ivec2 high = glm::min(post(level, to) + level, posts - 1);
        const Window window{low.x, low.y, high.x - low.x + 1, high.y - low.y + 1};
        const Array2d<float> read = read_filled(window, 1);
        nodes = {Array2d<float>(count.x, count.y), Array2d<std::uint8_t>(count.x, count.y), {}};
        for (int y = 0; y < count.y; ++y) {
            for (int x = 0; x < count.x; ++x) {
                const glm::ivec2 at = post(level, from + glm::ivec2(x, y)) - low;
                NodeMean mean;
                for (int dy = -level; dy <= level; ++dy) {
                    for (int dx = -level; dx <= level; ++dx) {
                        const glm::ivec2 p = at + glm::ivec2(dx, dy);
                        if (p.x < 0 || p.y < 0 || p.x >= read.width() || p.y >= read.height())
                            continue;
                        mean.add(static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy))),
                                 read.at(p.x, p.y));
                    }
                }
                nodes.height_m.at(x, y) = mean.height_m();
                nodes.coverage.at(x, y) = mean.coverage();
            }
        }
    } else {
        const int side = 1 << (level - 1);
        const glm::ivec2 means = posts / side;
        const glm::ivec2 low = glm::clamp(2 * from - 1, glm::ivec2(0), means - 1);
        const glm::ivec2 high = glm::clamp(2 * to, low, means - 1);
        const glm::ivec2 size = high - low + 1;
        const Array2d<float> read =
            read_filled({low.x * side, low.y * side, size.x * side, size.y * side}, side);
        nodes = nodes_of_means(read, low, level, from, count);
    }

    Block block{Array2d<float>(columns, rows), Array2d<float>(columns, rows)};
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const glm::ivec2 at = glm::clamp(first + glm::ivec2(x, y), glm::ivec2(0), last) - from;
            block.coverage.at(x, y) = static_cast<float>(nodes.coverage.at(at.x, at.y)) / kWhole;
            const float h = nodes.height_m.at(at.x, at.y);
            block.height_m.at(x, y) = !std::isnan(h) ? h : mean_around([&](int dx, int dy) {
                return nodes.height_m.at(std::clamp(at.x + dx, 0, count.x - 1),
                                         std::clamp(at.y + dy, 0, count.y - 1));
            });
        }
    }
    return block;
}

}  // namespace relevo::dem
