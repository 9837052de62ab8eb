#include "mesh/mesh.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/text.h"
#include "mesh/builder.h"

namespace relevo::mesh {
namespace {

/// Longer sides are mistakes of units [m].
constexpr float kMaxSide_m = 10000;

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void compute_normals(Mesh& mesh) {
    for (Vertex& vertex : mesh.vertices)
        vertex.normal = glm::vec3(0);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Vertex& a = mesh.vertices[mesh.indices[i]];
        Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const glm::vec3 area = cross(b.position_m - a.position_m, c.position_m - a.position_m);
        for (Vertex* const vertex : {&a, &b, &c})
            vertex->normal += area;
    }
}

}  // namespace

void fail(const std::filesystem::path& file, std::string_view message) {
    bad_input(fmt::format("mesh: {}: {}", printable(file.string()), message));
}

glm::vec3 Mesh::low_m() const {
    glm::vec3 low = vertices.front().position_m;
    for (const Vertex& vertex : vertices)
        low = min(low, vertex.position_m);
    return low;
}

glm::vec3 Mesh::high_m() const {
    glm::vec3 high = vertices.front().position_m;
    for (const Vertex& vertex : vertices)
        high = max(high, vertex.position_m);
    return high;
}

Mesh finished(const std::filesystem::path& file, Mesh mesh, bool has_normals) {
    if (mesh.indices.empty()) fail(file, "expected triangles but got none");
    for (Vertex& vertex : mesh.vertices) {
        if (!is_finite(vertex.position_m) || !is_finite(vertex.normal) || !is_finite(vertex.colour))
            fail(file, "expected finite numbers but got NaN or infinity");
        vertex.colour = clamp(vertex.colour, 0.0F, 1.0F);
    }
    const glm::vec3 side_m = mesh.high_m() - mesh.low_m();
    const float longest_m = std::max({side_m.x, side_m.y, side_m.z});
    if (!(longest_m > 0 && longest_m <= kMaxSide_m))
        fail(file,
             fmt::format("expected a size of up to {} m but got {:g} m", kMaxSide_m, longest_m));
    if (mesh.low_m().z < 0 && mesh.high_m().z <= 0)
        fail(file, "expected vertices above y = 0, where the mesh stands on the ground");
    if (!has_normals) compute_normals(mesh);
    for (Vertex& vertex : mesh.vertices) {
        const float length = glm::length(vertex.normal);
        vertex.normal =
            length > 0 && std::isfinite(length) ? vertex.normal / length : glm::vec3(0, 0, 1);
    }
    return mesh;
}

Mesh read(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    if (ending != ".obj" && ending != ".gltf" && ending != ".glb")
        fail(file, "expected a file that ends in .obj, .gltf or .glb");
    const std::string bytes = read_text(file, "mesh");
    return ending == ".obj" ? parse_obj(file, bytes) : parse_gltf(file, bytes);
}

}  // namespace relevo::mesh
