#include "render/tile_mesh.h"

#include <span>

#include "render/tile_grid.h"

namespace relevo::render {
namespace {

constexpr int kGridBinding = 0, kInstanceBinding = 1;
constexpr int kComponents = 4;  // of a vector

}  // namespace

TileMesh::TileMesh()
    : grid_vertices_(gl::Buffer::of<float>(tile_grid_vertices(), "terrain grid")),
      grid_indices_(gl::Buffer::of<std::uint16_t>(tile_grid_indices(), "terrain grid indices")) {
    grid_.attributes(kGridBinding, grid_vertices_, 0, 1, 2, false);
    grid_.attributes(kInstanceBinding, 1, kInstanceVectors, kComponents, true);
    grid_.indices(grid_indices_);
}

void TileMesh::draw(const std::vector<Tile>& tiles) {
    // Whole tiles first, then each quadrant of partly drawn tiles.
    constexpr std::uint8_t kWhole = 0xf;
    std::vector<Instance> instances;
    std::vector<Draw> draws;
    const auto add = [&](unsigned first_index, unsigned indices, const auto& is_wanted) {
        const auto first = static_cast<unsigned>(instances.size());
        for (const Tile& tile : tiles)
            if (is_wanted(tile)) instances.push_back(tile.instance);
        const auto count = static_cast<unsigned>(instances.size()) - first;
        if (count > 0) draws.push_back({indices, count, first_index, 0, first});
    };
    add(0, 4 * kQuadrantIndices, [](const Tile& tile) { return tile.quadrants == kWhole; });
    for (unsigned quadrant = 0; quadrant < 4; ++quadrant)
        add(quadrant * kQuadrantIndices, kQuadrantIndices, [&](const Tile& tile) {
            return tile.quadrants != kWhole && (tile.quadrants >> quadrant & 1) != 0;
        });
    draw(grid_, instances, draws);
}

void TileMesh::draw_sides(const std::vector<Tile>& tiles, Sides& sides) {
    make_walls(tiles, sides);
    std::vector<Instance> instances;
    instances.reserve(walls_->tiles.size());
    for (const std::size_t tile : walls_->tiles)
        instances.push_back(tiles[tile].instance);
    draw(walls_->array, instances, walls_->draws);
}

void TileMesh::make_walls(const std::vector<Tile>& tiles, Sides& sides) {
    std::vector<std::pair<std::uint64_t, std::uint8_t>> of;
    of.reserve(tiles.size());
    for (const Tile& tile : tiles)
        of.emplace_back(tile.key.packed(), tile.quadrants);
    if (walls_ && walls_->of == of) return;
    walls_.emplace();
    std::vector<glm::vec4> vertices;
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto first_vertex = static_cast<std::int32_t>(vertices.size()) / Sides::kVectors;
        const auto first_index = static_cast<std::uint32_t>(indices.size());
        sides.add(tiles[i].key, tiles[i].quadrants, vertices, indices);
        const auto count = static_cast<std::uint32_t>(indices.size()) - first_index;
        if (count == 0) continue;
        const auto instance = static_cast<std::uint32_t>(walls_->tiles.size());
        walls_->draws.push_back({count, 1, first_index, first_vertex, instance});
        walls_->tiles.push_back(i);
    }
    walls_->of = std::move(of);
    if (indices.empty()) return;
    walls_->vertices = gl::Buffer::of<glm::vec4>(vertices, "terrain sides");
    walls_->indices = gl::Buffer::of<std::uint16_t>(indices, "terrain sides indices");
    walls_->array.attributes(kGridBinding, walls_->vertices, 1 + kInstanceVectors, Sides::kVectors,
                             kComponents, false);
    walls_->array.attributes(kInstanceBinding, 1, kInstanceVectors, kComponents, true);
    walls_->array.indices(walls_->indices);
}

void TileMesh::draw(gl::VertexArray& array, const std::vector<Instance>& instances,
                    const std::vector<Draw>& draws) {
    if (draws.empty()) return;
    array.feed(kInstanceBinding,
               instances_.write(std::as_bytes(std::span(instances)), sizeof(glm::vec4)),
               sizeof(Instance));
    array.draw(draws_.write(std::as_bytes(std::span(draws)), sizeof(std::uint32_t)));
}

}  // namespace relevo::render
