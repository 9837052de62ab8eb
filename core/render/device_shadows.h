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

/// Computes light_clearance and light_fraction of GroundLight on the device. Each invocation of
/// light_sweep.comp.glsl processes one line of light::Sweep over a tile. The processor provides the
/// geometry as tables, a few MB for each sun.
///
/// Accuracy: shadows are bitwise equal to those of light::Clearances::each() if the device rounds
/// sums and products as IEEE 754 (tests/render/test_device_shadows.cpp).
class DeviceShadows {
  public:
    /// Compiles the programs.
    /// @throws Error (Failed) if the device rejects them
    DeviceShadows();

    /// Buffers for the heights of a DEM and its shadows: 16 bytes a post.
    class Ground {
      public:
        /// @throws Error (Failed) if the device has too little memory
        explicit Ground(const light::SunTerrain& terrain);

        /// Shadow heights [m] of a part of the disc, from the last find().
        std::vector<float> read(light::Clearances::DeviceSweep::Part part) const;

      private:
        friend class DeviceShadows;
        const light::SunTerrain& terrain_;
        gl::Buffer height_m_;
        std::array<gl::Buffer, 3> shadow_m_;  // of DeviceSweep::Part
    };

    /// @param clearance  RG16F, a texel for each post of the DEM
    /// @param fraction   RG8, 2 x 2 posts a texel, with mipmaps. Texels without posts are not
    /// written
    /// @throws Error (Failed) if the device has too little memory for the tables; (BadInput) as
    ///     divide()
    light::Clearances::Found find(const light::Clearances& clearances, Ground& ground,
                                  const geo::Geodetic& place, const light::SunOverDem& sun,
                                  const gl::Texture& clearance, const gl::Texture& fraction);

  private:
    void sweep(const Ground& ground, const light::Clearances::DeviceSweep& sweep);
    void write_textures(const Ground& ground, bool has_disc, const gl::Texture& clearance,
                        const gl::Texture& fraction);

    gl::ComputeProgram sweep_, clearance_, fraction_;
    bool proven_ = false;  // the device has run them
};

}  // namespace relevo::render
