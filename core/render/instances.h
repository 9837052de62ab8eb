#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gl/ring_buffer.h"
#include "gl/vertex_array.h"
#include "render/instance_blocks.h"
#include "render/instance_mesh.h"
#include "render/instance_shadows.h"
#include "render/pass_context.h"
#include "shader/instance_set.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Draws instances of plugins' meshes on the ground. Nothing is done for a single instance on the
/// processor: a vertex program places them.
class Instances {
  public:
    /// @param values  of the parameters; must outlive this
    /// @throws Error (BadInput) as mesh::read()
    Instances(const std::vector<shader::InstanceSet>& sets, const shader::ParamStore& values);

    /// Draws a set with the bound program, framebuffer and textures.
    /// @param resource  names the set
    /// @param sprites   draws the level of sprites instead of meshes
    void draw(std::string_view resource, bool sprites, PassContext& frame);

    /// Decides which shadow maps the frame must draw, and writes their places into its block.
    void place_shadows(PassContext& frame);
    /// Draws a set into the shadow maps that are due. They are the bound framebuffer's depth.
    void draw_shadows(std::string_view resource, PassContext& frame);
    /// The contents of the shadow maps are lost.
    void forget_shadows() { shadows_.forget(); }

  private:
    struct Set {
        explicit Set(const shader::InstanceSet& of);
        shader::InstanceSet set;
        InstanceMesh mesh;
        gl::VertexArray array;
        gl::RingBuffer blocks{"instance blocks"}, draws{"instance draws"};
    };
    struct Batch;
    Set& find(std::string_view resource);
    static void draw(Set& set, const Batch& batch, bool points);
    std::vector<std::unique_ptr<Set>> sets_;
    const shader::ParamStore& values_;
    InstanceShadows shadows_;
};

}  // namespace relevo::render
