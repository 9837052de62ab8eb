#pragma once

#include <optional>
#include <vector>

#include "climate/cover_table.h"
#include "climate/fine_cover.h"
#include "climate/land_classes.h"
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

/// Mapping of angles of lib/climate.glsl to a texture whose outer texels' centres are on the sides
/// of a box: factor and constant from longitudes off the origin, and from latitudes.
glm::vec4 place_of(const climate::Box& box, const geo::Geodetic& origin, const glm::ivec2& texels);

/// Climate tables of a DEM's area on the device, read by lib/climate.glsl.
class ClimateVolume {
  public:
    /// @param frame                  the DEM's local frame
    /// @param lowest_m, highest_m   range of the DEM's heights
    /// @param height_m               of the DEM, in the mean around a place
    ClimateVolume(const climate::ClimateMap& map, const dem::Grid& grid,
                  const geo::LocalFrame& frame, double lowest_m, double highest_m,
                  const climate::FineCover::Heights& height_m);
    ClimateVolume(const ClimateVolume&) = delete;
    ClimateVolume& operator=(const ClimateVolume&) = delete;

    /// Updates the snow for a day of the year, 0 to 364, if it has changed.
    void set_day(int day);
    const gl::Texture& texture() const { return texture_; }
    /// At a place and height, as the texture has it; beyond the area as on its rim. After
    /// set_day().
    climate::Growing growing(const geo::Geodetic& place, float height_m) const;
    /// Writes the texture's mapping from places and heights.
    void write(GroundBlock& block) const;

  private:
    climate::CoverTable table_;
    climate::FineCover cover_;  // of the table
    gl::Texture texture_;
    std::vector<float> values_;  // of the texture's texels
    std::optional<int> day_;
    double origin_rad_;
    glm::vec4 place_, height_;
};

}  // namespace relevo::render
