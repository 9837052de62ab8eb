#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "light/raster/clearance.h"

namespace relevo::render {

/// light_margins and light_shares, computed on the device from a DEM's heights. Each invocation of
/// light_sweep.comp.glsl follows one line of light::Sweep over a tile. Geometry comes from the
/// processor, as tables of a few MB a sun.
///
/// Accuracy: shadows are those of light::Clearances::each() to the bit where the device rounds
/// sums and products as IEEE 754 does (tests/render/test_device_shadows.cpp).
class DeviceShadows {
  public:
    /// Compiles the programs.
    /// @throws Error (Failed) where the device refuses them
    DeviceShadows();

    /// The heights of a DEM, and room for its shadows: 16 bytes a post.
    class Ground {
      public:
        /// @throws Error (Failed) where the device has no memory for it
        explicit Ground(const light::SunTerrain& terrain);

        /// Heights of the shadows of a part of the disc, as the last find() left them [m].
        std::vector<float> read(light::Clearances::DeviceSweep::Part part) const;

      private:
        friend class DeviceShadows;
        const light::SunTerrain& terrain_;
        gl::Buffer height_m_;
        std::array<gl::Buffer, 3> shadow_m_;  // of DeviceSweep::Part
    };

    /// @param margins  RG16F, a texel a post of the DEM
    /// @param shares   RG8, a texel 2 x 2 posts; levels are halves. Sides that are longer stay
    /// @throws Error (Failed) where the device has no memory for the tables; (BadInput) as divide()
    light::Clearances::Found find(const light::Clearances& clearances, Ground& ground,
                                  const geo::Geodetic& place, const light::SunOverDem& sun,
                                  const gl::Texture& margins, const gl::Texture& shares);

  private:
    void sweep(const Ground& ground, const light::Clearances::DeviceSweep& sweep);
    void make_textures(const Ground& ground, bool has_disc, const gl::Texture& margins,
                       const gl::Texture& shares);

    gl::ComputeProgram sweep_, margins_, shares_;
    bool proven_ = false;  // the device has run them
};

}  // namespace relevo::render
