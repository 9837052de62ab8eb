#pragma once

#include <memory>

#include "render/frame_block.h"
#include "sky/sun_rays.h"

namespace relevo::render {

/// Light of sun, moon and sky at one height above the sea. It is that of FrameInputs::atmosphere,
/// which draws the sky too; without one that of the formulas of sun/daylight.h, whose sky is the
/// same at all heights and over the whole DEM.
/// Units as in frame.glsl. Figures: tests/render/test_height_light.cpp.
class HeightLight {
  public:
    /// @param inputs  must outlive this
    HeightLight(const FrameInputs& inputs, double height_m);

    /// Share of the light of sun or moon that passes the air.
    /// @param sine  of the light's geometric elevation there
    /// @param bent  refraction at the height over that of the light; of the formulas
    glm::dvec3 passed(const SunLight& light, double sine, double bent = 1) const;

    /// Irradiance on a surface that faces sun or moon.
    glm::dvec3 direct(const SunLight& light, double sine, double bent = 1) const;

    /// Irradiance of level ground by the sky. @param sine  of inputs.direct_light(), as above
    glm::dvec3 sky(double sine) const;

  private:
    const FrameInputs& inputs_;
    double height_m_;
    std::shared_ptr<const sky::SunRays> rays_;  ///< null: the formulas
};

}  // namespace relevo::render
