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

/// Colours of 8 bits, 0 to 2, in one number, which a float holds exactly.
float packed(const glm::vec3& colour) {
    const glm::vec3 bytes = round(clamp(127.5F * colour, 0.0F, 255.0F));
    return bytes.x + 256 * bytes.y + 65536 * bytes.z;
}

/// Factors that make height and width 1.
glm::vec3 to_unit(const mesh::Mesh& mesh) {
    const glm::vec3 low = mesh.low_m(), high = mesh.high_m();
    const float width = std::max({high.x - low.x, high.y - low.y, kLeast_m});
    return {1 / width, 1 / width, 1 / std::max(high.z, kLeast_m)};
}

/// Mean over the surface.
glm::vec3 mean_colour(const mesh::Mesh& mesh) {
    glm::vec3 sum(0);
    float area = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const mesh::Vertex& a = mesh.vertices[mesh.indices[i]];
        const mesh::Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        const mesh::Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const float size = length(cross(b.position_m - a.position_m, c.position_m - a.position_m));
        sum += size * (a.colour + b.colour + c.colour) / 3.0F;
        area += size;
    }
    return area > 0 ? max(sum / area, 1e-3F) : glm::vec3(1);
}

mesh::Mesh point_mesh() {
    mesh::Mesh mesh;
    mesh.vertices.push_back({.position_m = {0, 0, 1}});
    mesh.indices.push_back(0);
    return mesh;
}

/// All vertices of a set.
struct Arrays {
    std::vector<glm::vec4> positions, normals;
    std::vector<std::uint16_t> indices;

    InstanceMesh::Part add(const mesh::Mesh& mesh) {
        const std::size_t count = mesh.vertices.size();
        const auto copies =
            static_cast<int>(std::clamp<std::size_t>(mesh::kMaxVertices / count, 1, kMostCopies));
        const InstanceMesh::Part part{static_cast<std::uint32_t>(indices.size()),
                                      static_cast<std::uint32_t>(mesh.indices.size()),
                                      static_cast<std::int32_t>(positions.size()), copies};
        const glm::vec3 scale = to_unit(mesh), mean = mean_colour(mesh);
        for (int copy = 0; copy < copies; ++copy) {
            for (const mesh::Vertex& vertex : mesh.vertices) {
                positions.emplace_back(scale * vertex.position_m, copy);
                normals.emplace_back(normalize(vertex.normal / scale),
                                     packed(vertex.colour / mean));
            }
            for (const std::uint16_t index : mesh.indices)
                indices.push_back(
                    static_cast<std::uint16_t>(index + static_cast<std::size_t>(copy) * count));
        }
        return part;
    }
};

}  // namespace

InstanceMesh::InstanceMesh(const shader::InstanceSet& set) {
    Arrays arrays;
    point = arrays.add(point_mesh());
    for (const shader::InstanceSet::Level& level : set.levels) {
        std::vector<Part>& parts = levels.emplace_back();
        if (level.is_sprite()) parts.push_back(point);
        for (const std::filesystem::path& file : level.meshes)
            parts.push_back(arrays.add(mesh::read(file)));
    }
    positions = gl::Buffer::of<glm::vec4>(arrays.positions, set.resource + " positions");
    normals = gl::Buffer::of<glm::vec4>(arrays.normals, set.resource + " normals");
    indices = gl::Buffer::of<std::uint16_t>(arrays.indices, set.resource + " indices");
}

}  // namespace relevo::render
