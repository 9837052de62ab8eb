#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "render/graph/plan.h"
#include "render/texture_pool.h"

namespace relevo::render {

/// Textures, buffers and framebuffers of a plan, for one frame size.
class GraphTargets {
  public:
    GraphTargets() = default;
    /// @throws Error (Failed) if the device is out of memory, or does not support a combination of
    ///     targets
    /// @param pool  source of textures; must outlive this
    GraphTargets(const FrameGraph& graph, const Plan& plan, int width_px, int height_px,
                 TexturePool& pool);

    /// An allocated texture, or null.
    gl::Texture* texture(std::string_view resource);
    /// An allocated buffer, or null.
    const gl::Buffer* buffer(std::string_view resource) const;
    /// Binds an allocated texture or buffer for samplers. @returns false if there is none
    bool bind(std::string_view resource, unsigned unit);
    /// Sets a texture or buffer to zero, and binds it as image or storage block 0.
    void begin_output(std::string_view resource);
    /// The framebuffer of a plan's step, or null.
    const gl::Framebuffer* framebuffer(std::size_t step) const;

    /// Fills resources whose lifetime begins in a step with NaN, so that tests detect reads of
    /// unwritten memory.
    void poison(const FrameGraph& graph, const Plan::Step& step);

  private:
    struct Named {
        std::string name;
        int memory;  ///< index into textures_ and buffers_
    };
    int memory_of(std::string_view resource) const;
    gl::Framebuffer make_framebuffer(const Pass& pass);

    std::vector<Named> names_;
    std::vector<TexturePool::Lease> textures_;
    std::vector<gl::Buffer> buffers_;
    std::vector<gl::BufferTexture> views_;  // of buffers_
    std::vector<gl::Framebuffer> framebuffers_;
};

}  // namespace relevo::render
