#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Sampler in lib/ground.glsl.
inline constexpr const char* kLightByHeightTexture = "light_by_height";

/// Light over a DEM by height and by the elevation of sun or moon, on the device.
class LightByHeight {
  public:
    static constexpr int kSines = 64, kHeights = 16, kLayers = 3;  ///< as in lib/ground.glsl
    static constexpr double kAloft_m = 16000;

    /// Layer 0: HeightLight::direct(), layer 1: HeightLight::sky(), by height and sine, of the
    /// heights of the DEM. Layer 2: direct() from the sea to kAloft_m, for clouds. Rows are even in
    /// the height, columns even on the scale of frame.sun_light_domain.
    static std::vector<glm::vec4> texels(const FrameInputs& inputs, const FrameBlock& block);

    /// Computes the texture again if the light has changed, and writes where its rows are.
    /// @param block  has the heights of the DEM and the domain of the sun's light
    void update(const FrameInputs& inputs, FrameBlock& block);

    /// Null for another name, and before update().
    const gl::Texture* texture(std::string_view name) const;

  private:
    struct Of;
    std::shared_ptr<const Of> of_;
    gl::Texture texture_;
};

}  // namespace relevo::render
