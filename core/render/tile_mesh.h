#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "gl/buffer.h"
#include "gl/ring_buffer.h"
#include "gl/vertex_array.h"
#include "render/sides.h"

namespace relevo::render {

/// The vertices of tiles: one grid for the ground of all tiles, and walls at edges of the ground.
/// Each call is one draw command.
class TileMesh {
  public:
    static constexpr int kInstanceVectors =
        12;  ///< inputs 1 to 12: net_0 ... up_v of lib/tile.glsl
    using Instance = std::array<glm::vec4, kInstanceVectors>;
    struct Tile {
        TileKey key;
        std::uint8_t quadrants = 0;  ///< as TileDraw
        Instance instance;
    };

    TileMesh();

    void draw(const std::vector<Tile>& tiles);
    /// Draws walls. They are built again only if the tiles change.
    void draw_sides(const std::vector<Tile>& tiles, Sides& sides);

  private:
    using Draw = gl::VertexArray::Draw;
    void make_walls(const std::vector<Tile>& tiles, Sides& sides);
    void draw(gl::VertexArray& array, const std::vector<Instance>& instances,
              const std::vector<Draw>& draws);

    gl::Buffer grid_vertices_, grid_indices_;
    gl::VertexArray grid_;
    gl::RingBuffer instances_{"terrain tiles"}, draws_{"terrain draws"};

    struct Walls {
        std::vector<std::pair<std::uint64_t, std::uint8_t>> of;  // tiles with their quadrants
        gl::Buffer vertices, indices;
        gl::VertexArray array;
        std::vector<std::size_t> tiles;  // indices of tiles with walls
        std::vector<Draw> draws;         // one for each of them
    };
    std::optional<Walls> walls_;
};

}  // namespace relevo::render
