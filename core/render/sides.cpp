#include "render/sides.h"

#include <algorithm>
#include <cmath>

#include "render/pages.h"

namespace relevo::render {
namespace {

constexpr std::size_t kMostKept = 4096;  // cached tiles

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

std::vector<SideEdge> Sides::find(const TileKey& key) const {
    const glm::ivec2 first_post = key.at * (kTileQuads << key.level);
    const glm::vec2 span(span_on_dem(*pyramid_, first_post, kTileQuads << key.level));
    const glm::ivec2 quads(static_cast<int>(std::ceil(std::ldexp(span.x, -key.level))),
                           static_cast<int>(std::ceil(std::ldexp(span.y, -key.level))));
    const glm::ivec2 last = pyramid_->tiles(key.level) - 1;
    std::vector<SideEdge> edges;
    const glm::vec2 rim(-1);
    for (int i = 0; i < quads.x; ++i) {
        const auto across = [&](int y, int quad) {
            edges.push_back({{i, y}, {i + 1, y}, rim, quadrant_of(i, quad)});
        };
        if (key.at.y == 0) across(0, 0);
        if (key.at.y == last.y) across(quads.y, quads.y - 1);
    }
    for (int i = 0; i < quads.y; ++i) {
        const auto down = [&](int x, int quad) {
            edges.push_back({{x, i}, {x, i + 1}, rim, quadrant_of(quad, i)});
        };
        if (key.at.x == 0) down(0, 0);
        if (key.at.x == last.x) down(quads.x, quads.x - 1);
    }
    if (!pyramid_->has_voids()) return edges;

    const std::vector<float> page = height_page(*pyramid_, key.level, key.at);
    const auto coverage = [&](glm::ivec2 at, bool coarser) {
        const int texel = (at.y + 1) * kHeightPage_px + at.x + 1;
        return page[static_cast<std::size_t>(4 * texel + (coarser ? 3 : 1))];
    };
    const auto is_cut = [&](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        float least = 1, most = 0;
        for (const glm::ivec2 corner : {a, b, c})
            for (const bool coarser : {false, true}) {
                least = std::min(least, coverage(corner, coarser));
                most = std::max(most, coverage(corner, coarser));
            }
        return least < 0.5f && most >= 0.5f;
    };
    for (int y = 0; y < quads.y; ++y) {
        for (int x = 0; x < quads.x; ++x) {
            // Triangulated like the drawn grid.
            const glm::ivec2 a(x, y), b(x + 1, y), c(x, y + 1), d(x + 1, y + 1);
            if (is_cut(a, c, b)) edges.push_back({a, c, b, quadrant_of(x, y)});
            if (is_cut(b, c, d)) edges.push_back({b, c, d, quadrant_of(x, y)});
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
