#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gl/texture.h"

namespace relevo::render {

/// Render targets of one context. A returned texture is reused for the next request of its kind,
/// format and size, so that renderers that take turns allocate nothing.
class TexturePool {
  public:
    /// Returns a texture to its pool, which must still exist.
    struct Return {
        TexturePool* pool = nullptr;
        void operator()(gl::Texture* texture) const;
    };
    using Lease = std::unique_ptr<gl::Texture, Return>;

    /// A texture with one level and unspecified contents and sampling.
    /// @throws Error (Failed) as gl::Texture
    Lease take(gl::TextureKind kind, gl::Format format, gl::Extent extent, std::string_view label);

    /// Deletes textures that are not in use.
    void trim() { free_.clear(); }

  private:
    void give(gl::Texture* texture);

    std::vector<std::unique_ptr<gl::Texture>> free_;
};

}  // namespace relevo::render
