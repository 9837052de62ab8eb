#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/frame_block.gen.h"
#include "shader/param_store.h"
#include "sky/air.h"

namespace relevo::render {

/// Samplers in lib/air.glsl.
inline constexpr const char* kAirSkyTexture = "air_sky";
inline constexpr const char* kAirBetweenTexture = "air_between";

/// Parameters of core for the atmosphere: `air.aerosol`, `air.ozone`, `air.albedo`.
std::vector<shader::Param> air_params();
/// Their values; the defaults where a store has none of them.
sky::Air air_of(const shader::ParamStore& values);

/// What the eye of a frame sees of the air, on the device: sky::EyeTables for lib/air.glsl.
class AirTextures {
  public:
    /// Computes them again if the air, the eye's height or the sun's elevation have changed, and
    /// writes their coordinates. 15 ms on two processors.
    /// @param block  has the eye and its sun
    void update(const sky::Air& air, FrameBlock& block);

    /// Null for another name, and before update().
    const gl::Texture* texture(std::string_view name) const;

  private:
    struct Of {
        sky::Air air;
        float height_m, sun_sine;
        bool operator==(const Of&) const = default;
    };
    std::optional<Of> of_;
    gl::Texture sky_, between_;
    glm::vec4 mapping_{0}, colour_{0};
};

}  // namespace relevo::render
