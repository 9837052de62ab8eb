#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "gl/buffer.h"
#include "shader/instance_set.h"

namespace relevo::render {

/// The meshes of an InstanceSet on the device, as instance.vert.glsl reads them: each with height 1
/// and width 1, standing on z = 0.
struct InstanceMesh {
    struct Part {
        std::uint32_t first_index = 0, indices = 0;
        std::int32_t first_vertex = 0;
    };
    gl::Buffer positions, normals;  ///< one vector a vertex
    gl::Buffer indices;
    std::vector<Part> parts;  ///< by level

    /// @throws Error (BadInput) as mesh::read()
    explicit InstanceMesh(const shader::InstanceSet& set);
};

}  // namespace relevo::render
