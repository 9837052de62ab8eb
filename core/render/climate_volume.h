#pragma once

#include <optional>

#include "climate/cover_table.h"
#include "dem/grid.h"
#include "geo/local_frame.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// The sampler of lib/climate.glsl.
inline constexpr const char* kClimateTexture = "climate_table";

/// The box of the Earth that a grid lies in; with a pole in it all longitudes. Longitudes run
/// `origin` +- 180 degrees, so that no box is cut at the date line.
climate::Box box_of(const dem::Grid& grid, const geo::Geodetic& origin);

/// The climate's tables over a DEM on the device, for lib/climate.glsl.
class ClimateVolume {
  public:
    /// @param frame  the DEM's local frame
    ClimateVolume(const climate::ClimateMap& map, const dem::Grid& grid,
                  const geo::LocalFrame& frame, double lowest_m, double highest_m);

    /// Takes the snow of a day, 0 to 364; the same day again costs nothing.
    void set_day(int day);
    const gl::Texture& texture() const { return texture_; }
    /// Says where places and heights are in the texture.
    void write(FrameBlock& block) const;

  private:
    climate::CoverTable table_;
    gl::Texture texture_;
    std::optional<int> day_;
    glm::vec4 place_, height_;
};

}  // namespace relevo::render
