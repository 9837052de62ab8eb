#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "dem/heightfield.h"
#include "geo/local_frame.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Sky-view factors of a DEM.
struct SkyView;
using SkyViewFuture = std::shared_future<std::shared_ptr<const SkyView>>;
/// Computes sky-view factors in the background, for example while the shaders compile.
/// @param field  must outlive the computation
SkyViewFuture compute_sky_view_async(const dem::Heightfield& field, double exaggeration);

/// Where shadows are computed.
enum class ShadowsOn {
    Processor,
    Device,  ///< slower than the processor on a software renderer
};

/// Sun and sky light of each post after occlusion by terrain, as textures over the whole DEM.
/// shaders/lib/sun_share.glsl and shaders/lib/openness.glsl read them.
///
/// - "light_clearance": shadow clearance [m] of the sun's upper limb (r) and lower limb (g), in
///   exaggerated heights; kVoidClearance in voids. Linear between posts, so that coarse levels of
///   detail have the shadows of the posts.
/// - "light_fraction": visible fraction of the solar disc, times coverage (r), and coverage (g).
///   Level k has means of 2^(k+1) x 2^(k+1) posts, for pixels that cover several posts.
/// - "light_sky": sky-view factor relative to that of an unobstructed slope, times coverage (r),
///   and coverage (g), with mipmaps.
///
/// Posts are reduced to means of 2 x 2, 4 x 4, ... posts for DEMs of more posts than kMaxPosts or
/// than memory has room for, and where no pixel of the frame is finer than the means. The sky-view
/// factor has at most kMaxSkyPosts posts.
class GroundLight {
  public:
    /// @param field  must outlive this
    /// @param frame  the DEM's local frame; must outlive this
    /// @param sky    sky-view factors of the same field; may be invalid or for another exaggeration
    /// @param where  a device that fails is reported once, and the processor takes over
    /// @param max_posts  for which shadows are computed, kMaxPosts or fewer
    GroundLight(const dem::Heightfield& field, const geo::LocalFrame& frame, SkyViewFuture sky = {},
                ShadowsOn where = ShadowsOn::Processor, std::int64_t max_posts = kMaxPosts);
    GroundLight(GroundLight&&) noexcept;
    GroundLight& operator=(GroundLight&&) noexcept;
    ~GroundLight();

    /// Recomputes the shadow textures if the sun, the air, the exaggeration or the reduction
    /// changed.
    /// @param pixel_posts  posts along a side of the frame's finest pixel of ground
    /// @throws Error (BadInput) for a refraction that no air has
    void update_shadows(const SunLight& sun, double exaggeration, double pixel_posts = 1);
    /// Direction to the sun of the shadow textures, as SunLight; nullopt before update_shadows().
    std::optional<glm::dvec3> shadow_sun() const;
    /// True if the shadow textures were computed on the device.
    bool is_computed_on_device() const;
    /// Recomputes the sky-view texture if the exaggeration changed.
    void update_sky_view(double exaggeration);

    /// Null before the first update of that texture, and for other names.
    const gl::Texture* texture(std::string_view name) const;
    /// Sets the members of frame.glsl that locate the textures on the DEM.
    void describe(FrameBlock& block) const;

    static constexpr float kVoidClearance = 65504;  ///< the greatest half float
    static constexpr int kMaxPosts = 1 << 25, kMaxSkyPosts = 1 << 18;
    /// Large pixels reduce the posts no further than to this number or fewer.
    static constexpr int kCoarsePosts = 1 << 20;
    static constexpr int kSkyDirections = 16;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
