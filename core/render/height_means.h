#pragma once

#include <cstdint>
#include <optional>

#include "dem/heightfield.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Sampler in lib/height_means.glsl.
inline constexpr const char* kHeightMeansTexture = "height_means";

/// Heights of a whole DEM on the device, as means of ever more posts: the ground, generalised.
/// Level k has means of 2^k x 2^k texels of level 0 [m], down to a texel a side. Voids have ground
/// made up from what is around them, as rough as the rest. Levels are side by side in level 0 of
/// the texture and not its mipmaps, because Mesa's software renderer fetches from one level for
/// each 2 x 2 pixels.
///
/// Level 0 has the posts, or means of 2 x 2, 4 x 4, ... posts of DEMs with more than kMaxPosts.
class HeightMeans {
  public:
    /// @param field  must outlive this
    explicit HeightMeans(const dem::Heightfield& field) : field_(field) {}

    /// Makes the texture at the first call, and writes how many texels there are to a
    /// post, and the mean slope of the ground as a picture of the whole DEM shows it.
    void update(FrameBlock& block);
    const gl::Texture* texture() const { return texture_ ? &*texture_ : nullptr; }

    static constexpr std::int64_t kMaxPosts = std::int64_t{1} << 24;

  private:
    void make();

    const dem::Heightfield& field_;
    int reduction_ = 1;  // posts of the field to a texel, along a side
    double mean_slope_ = 0;
    std::optional<gl::Texture> texture_;
};

}  // namespace relevo::render
