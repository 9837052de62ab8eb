#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "gl/buffer.h"
#include "shader/instance_set.h"

namespace relevo::render {

/// The meshes of an InstanceSet on the device, as instance.vert.glsl reads them: each with height 1
/// and width 1, standing on z = 0; w is the number of the copy. Colours have a mean of 1 over each
/// mesh, so that levels are equally bright.
struct InstanceMesh {
    /// Copies of a mesh, or of a point, for the cells of a row. Meshes of few vertices that are
    /// instanced one by one take most of the time for each instance, on GPUs too.
    struct Part {
        std::uint32_t first_index = 0, indices = 0;  ///< of one copy
        std::int32_t first_vertex = 0;
        int copies = 1;
    };
    gl::Buffer positions, normals;  ///< one vector a vertex
    gl::Buffer indices;
    std::vector<std::vector<Part>> levels;  ///< by level and kind; sprites have no kind
    Part point;                             ///< of sprites and of shadows

    /// @throws Error (BadInput) as mesh::read()
    explicit InstanceMesh(const shader::InstanceSet& set);
};

}  // namespace relevo::render
