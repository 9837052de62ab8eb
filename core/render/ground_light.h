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

/// What ground leaves in sight of the sky, found beside other work: a driver's compiler, for one.
struct SkyFound;
using SkyAhead = std::shared_future<std::shared_ptr<const SkyFound>>;
/// @param field  outlives what is found
SkyAhead find_sky_ahead(const dem::Heightfield& field, double exaggeration);

/// Where shadows are computed.
enum class ShadowsOn {
    Processor,
    Device,  ///< slower than the processor on a software renderer
};

/// What shaders read of the light that comes to the ground past the ground around it, for every
/// post, as textures over the whole DEM. shaders/lib/sun_share.glsl and shaders/lib/openness.glsl
/// read them.
///
/// - "light_margins": how high the ground is above the edge of the shadow of the sun's upper limb
///   (r) and of its lower one (g) [m, as it is drawn], kHole in holes. Between posts they are
///   linear, so that what is drawn coarser than the posts has the shadows of the posts all the
///   same.
/// - "light_shares": how much of the disc is seen, times coverage (r), and coverage (g): means of
///   2 x 2, 4 x 4, ... posts in its levels, for pixels that hold several.
/// - "light_sky": how much of the sky an endless slope as inclined sees is seen (r), times coverage
///   (g), with levels.
///
/// Margins are those of means of 2 x 2, 4 x 4, ... posts where no pixel of the picture is finer,
/// and of a DEM of more than kMostPosts posts; the sky's of one of more than kMostSkyPosts.
class GroundLight {
  public:
    /// @param field  outlives this
    /// @param frame  the DEM's local frame; outlives this
    /// @param sky    of the same field; may be none, and of another exaggeration
    /// @param where  shadows are computed. A device that fails is reported once, and the processor
    ///     takes over
    GroundLight(const dem::Heightfield& field, const geo::LocalFrame& frame, SkyAhead sky = {},
                ShadowsOn where = ShadowsOn::Processor);
    GroundLight(GroundLight&&) noexcept;
    GroundLight& operator=(GroundLight&&) noexcept;
    ~GroundLight();

    /// Has margins and shares be those of a sun. Nothing is done where they are.
    /// @param pixel_posts  posts along the side of the picture's finest pixel of ground
    /// @throws Error (BadInput) for a refraction that no air has
    void follow(const SunLight& sun, double exaggeration, double pixel_posts = 1);
    /// Towards the sun that margins and shares are of, as SunLight; none while there are none.
    std::optional<glm::dvec3> followed() const;
    /// Whether margins and shares were computed on the device.
    bool is_of_device() const;
    /// Has the sky be there. Nothing is done where it is.
    void look_up(double exaggeration);

    /// Null for what has not been asked for.
    const gl::Texture* texture(std::string_view name) const;
    /// Sets what frame.glsl says of it.
    void describe(FrameBlock& block) const;

    static constexpr float kHole = 65504;  ///< the greatest half
    static constexpr int kMostPosts = 1 << 25, kFewPosts = 1 << 20, kMostSkyPosts = 1 << 18;
    static constexpr int kSkyDirections = 16;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
