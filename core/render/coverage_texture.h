#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "gl/texture.h"

namespace relevo::render {

struct CoverageTexel {
    std::uint8_t value, coverage;
};

/// Texture of values times coverage, and of coverage, with mipmaps. Its sides are padded such that
/// each level has half the side of the finer one; coverage is 0 outside the posts.
class CoverageTexture {
  public:
    /// @param width, height  minimum size of level 0
    void resize(int width, int height);

    Array2d<CoverageTexel>& base() { return levels_.front(); }

    /// A new texture has coverage 0.
    const gl::Texture& make_texture(const char* name);
    /// Computes the coarser levels from base(), and writes all.
    void upload(const char* name);

    const gl::Texture* texture() const { return texture_ ? &*texture_ : nullptr; }

  private:
    glm::ivec2 size_{0};  // before padding
    std::vector<Array2d<CoverageTexel>> levels_;
    std::optional<gl::Texture> texture_;
};

}  // namespace relevo::render
