#include "render/ground_in_view.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/pages.h"

namespace relevo::render {
namespace {

constexpr double kRounding_m = 0.01;  // of positions on the device

/// Places between which a vertex or a block's corner is drawn [m].
struct Column {
    glm::dvec3 low, high;
};

/// Directions of a perspective view's four edges.
std::array<glm::dvec3, 4> edges_of(const LodView& view) {
    const auto normal = [&](int i) { return glm::dvec3(view.planes[static_cast<std::size_t>(i)]); };
    std::array<glm::dvec3, 4> edges;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 edge = cross(normal(1 + i % 2), normal(3 + i / 2));
        edges[static_cast<std::size_t>(i)] = dot(edge, normal(0)) < 0 ? -edge : edge;
    }
    return edges;
}

/// A tile's blocks of quads, halved both ways down to single quads.
class Blocks {
  public:
    Blocks(const dem::Pyramid& pyramid, const TileKey& key, const PatchNet& net,
           double morph_start_m, const Displacement& displacement, const LodView& view)
        : heights_(height_page(pyramid, key.level, key.at)),
          morph_start_m_(morph_start_m),
          posts_a_quad_(1 << key.level),
          span_(span_on_dem(pyramid, key.at * (kTileQuads << key.level), kTileQuads << key.level)),
          net_(net),
          displacement_(displacement),
          view_(view),
          edges_(edges_of(view)) {
        const auto& p = net.position_m;
        bulge_m_ = (length(p[2]) + length(p[6]) + length(p[5]) + length(p[7]) + length(p[8])) / 16;
    }

    /// @param first  column and row of the first quad
    /// @param side   quads, a power of two
    bool is_in_view(glm::ivec2 first, int side) const {
        if (side == 1) return is_quad_in_view(first);
        const auto range = range_m(first, side);
        const auto corner = [&](int x, int y) {
            return column(first + side * glm::ivec2(x, y), range);
        };
        const std::array corners{corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)};
        const double share = static_cast<double>(side) / kTileQuads;
        if (is_beyond_a_plane(corners, margin_m() + share * share * bulge_m_)) return false;
        const int half = side / 2;
        for (int q = 0; q < 4; ++q)
            if (is_in_view(first + half * glm::ivec2(q & 1, q >> 1), half)) return true;
        return false;
    }

  private:
    double margin_m() const { return kRounding_m + displacement_.aside_m; }

    const float* texel(glm::ivec2 node) const {
        return &heights_[static_cast<std::size_t>(4 *
                                                  ((node.y + 1) * kHeightPage_px + node.x + 1))];
    }

    /// Lowest and highest of a block's vertices, morphed or not [m].
    std::pair<double, double> range_m(glm::ivec2 first, int side) const {
        float low_m = std::numeric_limits<float>::infinity(), high_m = -low_m;
        for (int y = first.y; y <= first.y + side; ++y)
            for (int x = first.x; x <= first.x + side; ++x) {
                const float* const vertex = texel({x, y});
                low_m = std::min({low_m, vertex[0], vertex[2]});
                high_m = std::max({high_m, vertex[0], vertex[2]});
            }
        return {low_m, high_m};
    }

    Column column(glm::ivec2 node, std::pair<double, double> range_m) const {
        const glm::dvec2 at = glm::dvec2(glm::min(posts_a_quad_ * node, span_)) / glm::dvec2(span_);
        const auto [low_m, high_m] = displacement_.range_m(range_m.first, range_m.second);
        return {net_.place(at.x, at.y, low_m * view_.exaggeration),
                net_.place(at.x, at.y, high_m * view_.exaggeration)};
    }

    Column vertex(glm::ivec2 node) const {
        const float height_m = texel(node)[0], morphed_m = texel(node)[2];
        const Column still = column(node, {height_m, height_m});
        if (std::max(length(still.low - *view_.eye_m), length(still.high - *view_.eye_m)) <
            morph_start_m_)
            return still;
        return column(node, std::minmax(height_m, morphed_m));
    }

    bool is_quad_in_view(glm::ivec2 first) const {
        const Column upper_right = vertex(first + glm::ivec2(1, 0));
        const Column lower_left = vertex(first + glm::ivec2(0, 1));
        return is_triangle_in_view({vertex(first), lower_left, upper_right}) ||
               is_triangle_in_view({vertex(first + 1), upper_right, lower_left});
    }

    bool is_triangle_in_view(const std::array<Column, 3>& corners) const {
        if (is_beyond_a_plane(corners, margin_m())) return false;
        const auto& [a, b, c] = corners;
        glm::dvec3 normal = cross(b.high - a.high, c.high - a.high);
        const double area = length(normal);
        if (area == 0) return true;
        normal *= (dot(normal, a.high - a.low + net_.vertical[0]) < 0 ? -1 : 1) / area;
        // From above a triangle nothing of it is seen upwards.
        return dot(normal, *view_.eye_m - a.high) < margin_m() ||
               std::ranges::any_of(edges_,
                                   [&](const glm::dvec3& edge) { return dot(normal, edge) < 0; });
    }

    template <std::size_t N>
    bool is_beyond_a_plane(const std::array<Column, N>& corners, double margin_m) const {
        return std::ranges::any_of(view_.planes, [&](const glm::dvec4& plane) {
            const auto is_beyond = [&](const glm::dvec3& point) {
                return dot(glm::dvec3(plane), point) + plane.w < -margin_m;
            };
            return std::ranges::all_of(
                corners, [&](const Column& c) { return is_beyond(c.low) && is_beyond(c.high); });
        });
    }

    std::vector<float> heights_;
    double morph_start_m_;
    int posts_a_quad_;
    glm::ivec2 span_;
    const PatchNet& net_;
    const Displacement& displacement_;
    const LodView& view_;
    std::array<glm::dvec3, 4> edges_;
    double bulge_m_ = 0;  // of the whole tile's ground over the plane through its corners
};

}  // namespace

bool is_ground_in_view(const dem::Pyramid& pyramid, const TileDraw& tile, const PatchNet& net,
                       double morph_start_m, const Displacement& displacement,
                       const LodView& view) {
    const Blocks blocks(pyramid, tile.key, net, morph_start_m, displacement, view);
    constexpr int kHalf = kTileQuads / 2;
    for (int q = 0; q < 4; ++q)
        if (tile.quadrants >> q & 1 && blocks.is_in_view(kHalf * glm::ivec2(q & 1, q >> 1), kHalf))
            return true;
    return false;
}

}  // namespace relevo::render
