#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gl/texture.h"

namespace relevo::render {

/// Textures that frames are drawn to, of one context. One that is returned is used again for the
/// next request of its kind, format and size, so that renderers which take turns allocate nothing.
class TexturePool {
  public:
    /// Returns the texture to its pool, which must still exist.
    struct Return {
        TexturePool* pool = nullptr;
        void operator()(gl::Texture* texture) const;
    };
    using Lease = std::unique_ptr<gl::Texture, Return>;

    /// A texture with one level, whose contents and sampling are unspecified.
    /// @throws Error (Failed) as gl::Texture
    Lease take(gl::TextureKind kind, gl::Format format, gl::Extent extent, std::string_view label);

    /// Destroys what is not in use.
    void trim() { free_.clear(); }

  private:
    void give(gl::Texture* texture);

    std::vector<std::unique_ptr<gl::Texture>> free_;
};

}  // namespace relevo::render
