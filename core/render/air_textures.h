#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/frame_block.h"
#include "shader/param_store.h"
#include "sky/air.h"
#include "sky/eye_tables.h"

namespace relevo::sky {
class Atmosphere;
}

namespace relevo::render {

/// Samplers in lib/air.glsl.
inline constexpr const char* kAirSkyTexture = "air_sky";
inline constexpr const char* kAirBetweenTexture = "air_between";

/// Parameters of core for the atmosphere: `air.aerosol`, `air.ozone`, `air.albedo`, `air.ground`.
std::vector<shader::Param> air_params();
/// Their values; the defaults where a store has none of them.
sky::Air air_of(const shader::ParamStore& values);
/// FrameInputs::atmosphere: null where `air.ground` is off, or in a store without it.
std::shared_ptr<const sky::Atmosphere> ground_air_of(const shader::ParamStore& values);

/// What lights the air over an eye.
struct AirLight {
    double sun_sine = 0;   ///< of the sun's geometric elevation at the eye
    double sun_share = 1;  ///< of its light, less than 1 in an eclipse
    double moon_sine = 0;
    glm::vec3 moon{0};  ///< irradiance outside the atmosphere; 0 unless the moon lights the night
    bool operator==(const AirLight&) const = default;
};
/// @param eye_up  vertical at the eye
AirLight air_light(const FrameInputs& inputs, const glm::dvec3& eye_up);

/// Where air is seen from, and what of it.
struct AirView {
    double height_m = 0;  ///< of the eye
    AirLight light{};
    sky::EyeParts parts{};  ///< what the frame's programs read: other tables keep what they have
    bool operator==(const AirView&) const = default;
};

/// What the eye of a frame sees of the air, on the device: sky::EyeTables for lib/air.glsl.
class AirTextures {
  public:
    /// Computes them again if the air, the eye's height or the light have changed noticeably
    /// (sky::nearest_eye_height_m()), and writes their coordinates into the block. 10 ms on two
    /// processors for both parts, 20 at night with the moon.
    void update(const sky::Air& air, const AirView& view, SkyBlock& block);

    /// Null for another name, and before update().
    const gl::Texture* texture(std::string_view name) const;

  private:
    struct Of {
        sky::Air air;
        AirView view;
        bool operator==(const Of&) const = default;
    };
    std::optional<Of> of_;
    gl::Texture sky_, between_;
    glm::vec4 mapping_{0};
    glm::vec3 colour_{0};
};

}  // namespace relevo::render
