#pragma once

#include <optional>

#include "climate/cover_table.h"
#include "dem/grid.h"
#include "geo/local_frame.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Sampler in lib/climate.glsl.
inline constexpr const char* kClimateTexture = "climate_table";

/// Bounding box of a grid in geographic coordinates; all longitudes if it contains a pole.
/// Longitudes are within 180 degrees of `origin`, so that no box is split at the date line.
climate::Box box_of(const dem::Grid& grid, const geo::Geodetic& origin);

/// Climate tables of a DEM's area on the device, read by lib/climate.glsl.
class ClimateVolume {
  public:
    /// @param frame                  the DEM's local frame
    /// @param lowest_m, highest_m   range of the DEM's heights
    ClimateVolume(const climate::ClimateMap& map, const dem::Grid& grid,
                  const geo::LocalFrame& frame, double lowest_m, double highest_m);

    /// Updates the snow for a day of the year, 0 to 364, if it has changed.
    void set_day(int day);
    const gl::Texture& texture() const { return texture_; }
    /// Writes the texture's mapping from places and heights.
    void write(FrameBlock& block) const;

  private:
    climate::CoverTable table_;
    gl::Texture texture_;
    std::optional<int> day_;
    glm::vec4 place_, height_;
};

}  // namespace relevo::render
