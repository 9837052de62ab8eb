#include "render/sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>

#include "dem/runs.h"
#include "render/pages.h"

// The vertex program places the walls at the edges of the drawn ground, so that no level of detail
// has a gap. Rejected: a mesh made on the processor, a level of detail for walls alone, and walls
// made of the ground's skirts. They have gaps or miss voids. Walls are culled from behind, so that
// the backdrop is visible through a void.
namespace relevo::render {
namespace {

constexpr std::size_t kMostKept = 4096;                     // cached tiles
constexpr std::int64_t kMostNodes = std::int64_t{1} << 24;  // of the level that parts are found in
constexpr int kNarrow = 8;  // narrower parts of the ground than the DEM by this have no walls

constexpr int kOpen = 1;  ///< a void that reaches the DEM's edge
constexpr int kWide = 2;  ///< ground that is wide enough for walls

int quadrant_of(int x, int y) {
    return (2 * x >= kTileQuads ? 1 : 0) + (2 * y >= kTileQuads ? 2 : 0);
}

}  // namespace

const std::vector<SideEdge>& Sides::edges(const TileKey& key) {
    const auto known = edges_.find(key.packed());
    if (known != edges_.end()) return known->second;
    if (edges_.size() >= kMostKept) edges_.clear();
    return edges_.emplace(key.packed(), find(key)).first->second;
}

void Sides::find_parts() {
    first_parts_ = pyramid_->first_in_memory();
    const auto nodes = [&] { return pyramid_->size(first_parts_); };
    while (std::int64_t{nodes().x} * nodes().y > kMostNodes)
        ++first_parts_;
    const glm::ivec2 size = nodes();
    const auto is_ground = [&](int x, int y) {
        return pyramid_->coverage(first_parts_, x, y) >= 0.5f;
    };
    dem::Runs runs(size.y);
    for (int y = 0; y < size.y; ++y) {
        runs.begin_row();
        for (int x = 0; x < size.x; ++x) {
            const int first = x;
            const bool ground = is_ground(first, y);
            while (x + 1 < size.x && is_ground(x + 1, y) == ground)
                ++x;
            runs.add(y, first, x, [&](int above) { return is_ground(above, y - 1) == ground; });
        }
    }
    struct Part {
        glm::ivec2 low{std::numeric_limits<int>::max()}, high{-1};
    };
    std::vector<Part> parts(static_cast<std::size_t>(runs.size()));
    for (int i = 0; i < runs.size(); ++i) {
        Part& part = parts[static_cast<std::size_t>(runs.root(i))];
        const dem::Run& run = runs.at(i);
        part.low = glm::min(part.low, glm::ivec2(run.first, run.row));
        part.high = glm::max(part.high, glm::ivec2(run.last, run.row));
    }
    Array2d<std::uint8_t> bits(size.x, size.y, 0);
    for (int i = 0; i < runs.size(); ++i) {
        const auto& [low, high] = parts[static_cast<std::size_t>(runs.root(i))];
        const dem::Run& run = runs.at(i);
        const bool open = low.x == 0 || low.y == 0 || high.x == size.x - 1 || high.y == size.y - 1;
        const glm::ivec2 sides = kNarrow * (high - low + 1);
        const bool wide = sides.x >= size.x || sides.y >= size.y;
        const int of_void = open ? kOpen : 0, of_ground = wide ? kWide : 0;
        std::fill_n(&bits.at(run.first, run.row), run.last - run.first + 1,
                    static_cast<std::uint8_t>(is_ground(run.first, run.row) ? of_ground : of_void));
    }
    parts_.push_back(std::move(bits));
    for (int level = first_parts_ + 1; level < pyramid_->levels(); ++level) {
        const Array2d<std::uint8_t>& fine = parts_.back();
        const glm::ivec2 last(fine.width() - 1, fine.height() - 1);
        Array2d<std::uint8_t> coarse(pyramid_->size(level).x, pyramid_->size(level).y, 0);
        for (int y = 0; y < coarse.height(); ++y)
            for (int x = 0; x < coarse.width(); ++x)
                for (int i = 0; i < 9; ++i) {
                    const glm::ivec2 near(2 * x + i % 3 - 1, 2 * y + i / 3 - 1);
                    const glm::ivec2 at = glm::clamp(near, glm::ivec2(0), last);
                    coarse.at(x, y) |= fine.at(at.x, at.y);
                }
        parts_.push_back(std::move(coarse));
    }
}

int Sides::parts_at(int level, glm::ivec2 node) const {
    const int finer = std::max(first_parts_ - level, 0);
    const auto index = static_cast<std::size_t>(std::max(level - first_parts_, 0));
    const Array2d<std::uint8_t>& parts = parts_[std::min(index, parts_.size() - 1)];
    int bits = 0;
    for (const int x : {node.x >> finer, (node.x + (1 << finer) - 1) >> finer})
        for (const int y : {node.y >> finer, (node.y + (1 << finer) - 1) >> finer})
            bits |= parts.at(std::min(x, parts.width() - 1), std::min(y, parts.height() - 1));
    return bits;
}

std::vector<SideEdge> Sides::find(const TileKey& key) {
    const glm::ivec2 first_post = key.at * (kTileQuads << key.level);
    const glm::vec2 span(span_on_dem(*pyramid_, first_post, kTileQuads << key.level));
    const glm::ivec2 quads(static_cast<int>(std::ceil(std::ldexp(span.x, -key.level))),
                           static_cast<int>(std::ceil(std::ldexp(span.y, -key.level))));
    const glm::ivec2 last = pyramid_->tiles(key.level) - 1;
    if (pyramid_->has_voids() && parts_.empty()) find_parts();
    const auto parts_of = [&](glm::ivec2 corner) {
        return parts_at(key.level, key.at * kTileQuads + corner);
    };
    std::vector<SideEdge> edges;
    const glm::vec2 rim(-1);
    const auto add_on_rim = [&](glm::ivec2 a, glm::ivec2 b, int quadrant) {
        if (parts_.empty() || ((parts_of(a) | parts_of(b)) & kWide) != 0)
            edges.push_back({a, b, rim, quadrant});
    };
    for (int i = 0; i < quads.x; ++i) {
        const int low = quads.y;
        if (key.at.y == 0) add_on_rim({i, 0}, {i + 1, 0}, quadrant_of(i, 0));
        if (key.at.y == last.y) add_on_rim({i + 1, low}, {i, low}, quadrant_of(i, low - 1));
    }
    for (int i = 0; i < quads.y; ++i) {
        const int right = quads.x;
        if (key.at.x == 0) add_on_rim({0, i + 1}, {0, i}, quadrant_of(0, i));
        if (key.at.x == last.x) add_on_rim({right, i}, {right, i + 1}, quadrant_of(right - 1, i));
    }
    if (parts_.empty()) return edges;

    const std::vector<float> page = height_page(*pyramid_, key.level, key.at);
    const auto coverage = [&](glm::ivec2 at, bool coarser) {
        const int texel = (at.y + 1) * kHeightPage_px + at.x + 1;
        return page[static_cast<std::size_t>(4 * texel + (coarser ? 3 : 1))];
    };
    const auto has_wall = [&](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        int grounds = 0, coarser_grounds = 0, parts = 0;
        for (const glm::ivec2 corner : {a, b, c}) {
            grounds += coverage(corner, false) >= 0.5f;
            coarser_grounds += coverage(corner, true) >= 0.5f;
            parts |= parts_of(corner);
        }
        if (grounds % 3 != 0) return parts == (kOpen | kWide);
        if (grounds == coarser_grounds) return false;
        // Cut as far as it morphs.
        for (const glm::ivec2 corner : {a, b, c})
            for (const int up : {0, 1})
                parts |= parts_at(key.level + 1, (key.at * kTileQuads + corner + up) >> 1);
        return parts == (kOpen | kWide);
    };
    for (int y = 0; y < quads.y; ++y) {
        for (int x = 0; x < quads.x; ++x) {
            // Triangulated like the drawn grid.
            const glm::ivec2 a(x, y), b(x + 1, y), c(x, y + 1), d(x + 1, y + 1);
            if (has_wall(a, c, b)) edges.push_back({a, c, b, quadrant_of(x, y)});
            if (has_wall(b, c, d)) edges.push_back({b, c, d, quadrant_of(x, y)});
        }
    }
    return edges;
}

void Sides::add(const TileKey& key, std::uint8_t quadrants, std::vector<glm::vec4>& vertices,
                std::vector<std::uint16_t>& indices) {
    const std::size_t before = vertices.size();
    // Two vertices, above and below. Without voids, adjacent walls of the DEM's edge share them.
    std::unordered_map<int, std::uint16_t> shared;
    const auto pair_at = [&](const SideEdge& edge, bool other) {
        const bool alone = edge.third.x >= 0 || pyramid_->has_voids();
        const glm::vec2 at = other ? edge.b : edge.a;
        const auto next = static_cast<std::uint16_t>((vertices.size() - before) / kVectors);
        const int place = static_cast<int>(at.y) * kHeightPage_px + static_cast<int>(at.x);
        if (!alone) {
            const auto [known, fresh] = shared.try_emplace(place, next);
            if (!fresh) return known->second;
        }
        for (const float down : {0.0f, 1.0f}) {
            vertices.emplace_back(alone ? edge.a : at, alone ? edge.b : at);
            vertices.emplace_back(edge.third, other ? 1 : 0, down);
        }
        return next;
    };
    for (const SideEdge& edge : edges(key)) {
        if (!(quadrants >> edge.quadrant & 1)) continue;
        const int a = pair_at(edge, false), b = pair_at(edge, true);
        for (const int index : {a, b, a + 1, a + 1, b, b + 1})
            indices.push_back(static_cast<std::uint16_t>(index));
    }
}

}  // namespace relevo::render
