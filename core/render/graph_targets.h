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

/// The memory of a plan on the device, for frames of one size.
class GraphTargets {
  public:
    GraphTargets() = default;
    /// @throws Error (Failed) if the device has no memory for it, or cannot draw to a combination
    /// @param pool  that textures come from; must outlive this
    GraphTargets(const FrameGraph& graph, const Plan& plan, int width_px, int height_px,
                 TexturePool& pool);

    /// A texture that the graph has allocated; null: there is none of that name.
    gl::Texture* texture(std::string_view resource);
    /// A buffer that the graph has allocated; null: there is none of that name.
    const gl::Buffer* buffer(std::string_view resource) const;
    /// What a step of the plan draws to; null if it draws to nothing.
    const gl::Framebuffer* framebuffer(std::size_t step) const;

    /// Fills the memory of the resources that begin in a step with NaN, so that a test shows who
    /// reads what no pass has written.
    void poison(const FrameGraph& graph, const Plan::Step& step);

  private:
    struct Named {
        std::string name;
        int memory;  ///< index in textures_ and buffers_
    };
    int memory_of(std::string_view resource) const;
    gl::Framebuffer make_framebuffer(const Pass& pass);

    std::vector<Named> names_;
    std::vector<TexturePool::Lease> textures_;
    std::vector<gl::Buffer> buffers_;
    std::vector<gl::Framebuffer> framebuffers_;
};

}  // namespace relevo::render
