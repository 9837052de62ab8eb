#pragma once

#include <filesystem>
#include <string_view>

#include "mesh/mesh.h"

namespace relevo::mesh {

/// Throws `Error(BadInput, "mesh: file: message")`.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view message);

/// A vector with y up, turned to x east, y north, z up.
inline glm::vec3 turned(const glm::vec3& v) {
    return {v.x, -v.z, v.y};
}

/// Checks a mesh and computes missing normals.
/// @param has_normals  otherwise they are computed
/// @throws Error (BadInput) as read()
Mesh finished(const std::filesystem::path& file, Mesh mesh, bool has_normals);

}  // namespace relevo::mesh
