#include "mesh/surface.h"

#include <unordered_map>

namespace relevo::mesh {
namespace {

std::uint64_t key_of(const LatticePoint& point) {
    return static_cast<std::uint64_t>(point.row) << 32 | static_cast<std::uint32_t>(point.column);
}

}  // namespace

Surface solid(const GridMesh& top, const GridMesh& bottom,
              const std::function<glm::dvec3(const LatticePoint&)>& place_m, double base_m) {
    Surface result;
    result.corners = top.corners;
    for (const LatticePoint& point : top.points)
        result.position_m.emplace_back(place_m(point));
    const auto below = static_cast<std::uint32_t>(top.points.size());
    std::unordered_map<std::uint64_t, std::uint32_t> bottom_of;
    for (const LatticePoint& point : bottom.points) {
        const glm::dvec3 at = place_m(point);
        bottom_of.emplace(key_of(point), static_cast<std::uint32_t>(result.position_m.size()));
        result.position_m.emplace_back(at.x, at.y, base_m);
    }
    for (std::size_t i = 0; i < bottom.corners.size(); i += 3)
        for (const std::size_t k : {0, 2, 1})
            result.corners.push_back(below + bottom.corners[i + k]);
    for (const auto& [a, b] : top.border) {
        const std::uint32_t c = bottom_of.at(key_of(top.points[b]));
        const std::uint32_t d = bottom_of.at(key_of(top.points[a]));
        result.corners.insert(result.corners.end(), {b, a, d, b, d, c});
    }
    return result;
}

double volume_m3(const Surface& surface) {
    if (surface.position_m.empty()) return 0;
    // Relative to a vertex: far from the origin differences of large numbers would be left.
    const glm::dvec3 origin(surface.position_m.front());
    double sum = 0;
    for (std::size_t i = 0; i < surface.corners.size(); i += 3) {
        const auto at = [&](std::size_t k) {
            return glm::dvec3(surface.position_m[surface.corners[i + k]]) - origin;
        };
        sum += glm::dot(at(0), glm::cross(at(1), at(2)));
    }
    return sum / 6;
}

}  // namespace relevo::mesh
