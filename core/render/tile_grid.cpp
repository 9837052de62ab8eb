#include "render/tile_grid.h"

namespace relevo::render {

/// Rounding leaves gaps of up to one rasteriser step between tiles. Skirts extend this far [quads]
/// under the neighbouring tile.
constexpr float kSkirt_quads = 1.0f / 128.0f;

std::vector<float> tile_grid_vertices() {
    std::vector<float> vertices;
    const auto coordinate = [](int i) {
        if (i == 0) return -kSkirt_quads;
        if (i == kGridSide - 1) return kTileQuads + kSkirt_quads;
        return static_cast<float>(i - 1);
    };
    for (int y = 0; y < kGridSide; ++y)
        for (int x = 0; x < kGridSide; ++x) {
            vertices.push_back(coordinate(x));
            vertices.push_back(coordinate(y));
        }
    return vertices;
}

std::vector<std::uint16_t> tile_grid_indices() {
    std::vector<std::uint16_t> indices;
    for (int q = 0; q < 4; ++q)
        for (int j = 0; j < kQuadrantQuads; ++j)
            for (int i = 0; i < kQuadrantQuads; ++i) {
                const int x = (q & 1) * kQuadrantQuads + i, y = (q >> 1) * kQuadrantQuads + j;
                const int a = y * kGridSide + x, b = a + 1, c = a + kGridSide, d = c + 1;
                for (const int index : {a, c, b, b, c, d})
                    indices.push_back(static_cast<std::uint16_t>(index));
            }
    return indices;
}

}  // namespace relevo::render
