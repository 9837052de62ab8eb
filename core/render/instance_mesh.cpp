#include "render/instance_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mesh/mesh.h"

namespace relevo::render {
namespace {

constexpr float kLeast_m = 1e-6F;  // sides of flat meshes

constexpr std::size_t kMostCopies = 64;

/// Colours of 8 bits in one number, which a float holds exactly.
float packed(const glm::vec3& colour) {
    const glm::vec3 bytes = round(255.0F * colour);
    return bytes.x + 256 * bytes.y + 65536 * bytes.z;
}

/// Factors that make height and width 1.
glm::vec3 to_unit(const mesh::Mesh& mesh) {
    const glm::vec3 low = mesh.low_m(), high = mesh.high_m();
    const float width = std::max({high.x - low.x, high.y - low.y, kLeast_m});
    return {1 / width, 1 / width, 1 / std::max(high.z, kLeast_m)};
}

}  // namespace

InstanceMesh::InstanceMesh(const shader::InstanceSet& set) {
    std::vector<glm::vec4> all_positions, all_normals;
    std::vector<std::uint16_t> all_indices;
    for (const shader::InstanceSet::Level& level : set.levels) {
        const mesh::Mesh mesh = mesh::read(level.mesh);
        const std::size_t count = mesh.vertices.size();
        const auto copies =
            static_cast<int>(std::clamp<std::size_t>(mesh::kMaxVertices / count, 1, kMostCopies));
        parts.push_back({static_cast<std::uint32_t>(all_indices.size()),
                         static_cast<std::uint32_t>(mesh.indices.size()),
                         static_cast<std::int32_t>(all_positions.size()), copies});
        const glm::vec3 scale = to_unit(mesh);
        for (int copy = 0; copy < copies; ++copy) {
            for (const mesh::Vertex& vertex : mesh.vertices) {
                all_positions.emplace_back(scale * vertex.position_m, copy);
                all_normals.emplace_back(normalize(vertex.normal / scale), packed(vertex.colour));
            }
            for (const std::uint16_t index : mesh.indices)
                all_indices.push_back(
                    static_cast<std::uint16_t>(index + static_cast<std::size_t>(copy) * count));
        }
    }
    positions = gl::Buffer::of<glm::vec4>(all_positions, set.resource + " positions");
    normals = gl::Buffer::of<glm::vec4>(all_normals, set.resource + " normals");
    indices = gl::Buffer::of<std::uint16_t>(all_indices, set.resource + " indices");
}

}  // namespace relevo::render
