#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gl/ring_buffer.h"
#include "gl/vertex_array.h"
#include "render/instance_blocks.h"
#include "render/instance_mesh.h"
#include "render/terrain.h"
#include "shader/instance_set.h"

namespace relevo::render {

/// Draws instances of plugins' meshes on the ground. Nothing is done for a single instance on the
/// processor: a vertex program places them.
class Instances {
  public:
    /// @throws Error (BadInput) as mesh::read()
    explicit Instances(const std::vector<shader::InstanceSet>& sets);

    /// Draws a set with the bound program, framebuffer and textures.
    /// @param resource   names the set
    /// @param sprites    draws the level of sprites instead of meshes
    /// @param view       of the frame; its eye is the origin of positions
    /// @param pixel_rad  a pixel at the frame's centre
    void draw(std::string_view resource, bool sprites, Terrain& terrain,
              const TileSelection& selection, const LodView& view, double pixel_rad);

  private:
    struct Set {
        explicit Set(const shader::InstanceSet& of);
        shader::InstanceSet set;
        InstanceMesh mesh;
        gl::VertexArray array;
        gl::RingBuffer blocks{"instance blocks"}, draws{"instance draws"};
    };
    Set& find(std::string_view resource);
    std::vector<std::unique_ptr<Set>> sets_;
};

}  // namespace relevo::render
