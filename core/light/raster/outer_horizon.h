#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "light/raster/sun_plan.h"

namespace relevo::light {

/// From posts of a grid to those of another one. Where both have one CRS that is linear.
class OtherGrid {
  public:
    OtherGrid(const dem::Grid& from, const dem::Grid& to);
    glm::dvec2 post(double column, double row) const;

  private:
    const dem::Grid& from_;
    const dem::Grid& to_;
    glm::dvec2 middle_;
    bool is_linear_ = false;
    glm::dvec2 origin_{0}, a_column_{0}, a_row_{0};
};

/// The horizon that the ground of a wider and coarser DEM makes for the posts of a site, in one
/// direction.
///
/// Far ground rises the more over the horizon the lower an eye is, so that at each post of the
/// wider DEM the horizon is kept for eyes at heights from the lowest post to the highest one of the
/// window. It comes from shadows: ground that shades a height from a sun of some elevation is the
/// horizon there. Between heights and between posts it is linear. Accuracy:
/// tests/light/test_nested.cpp.
class OuterHorizon {
  public:
    /// @param around  the direction over the wider DEM
    /// @param site    its terrain; outlives this
    /// @param window  posts of the site that will be asked for
    OuterHorizon(const PlannedSun& around, const SunTerrain& site, const Window& window);

    /// Raises the horizons of posts next to each other in a row.
    /// @param height_m  of the posts
    /// @param tangent   of their horizons
    void raise(int row, int column, int count, const float* height_m, float* tangent) const;

  private:
    static constexpr int kHeights = 33;

    /// Shadows under the lowest post are of no account.
    float floor_m() const { return lowest_m_ - 10 * step_m_ - 1; }
    /// That of the highest sun that is hidden from any post, or a little more.
    double highest_tangent(const PlannedSun& around, double steepest) const;
    bool is_shaded(const PlannedSun& around, double tangent) const;
    void find_heights(const SunTerrain& site, const Window& window);
    void add_tile(const PlannedSun& around, const SunTile& tile,
                  const std::vector<double>& tangents);
    void keep_horizons(const SunTerrain& terrain, const SunTile& tile, const Window& part,
                       const std::vector<double>& tangents, const std::vector<float>& shadows_m);
    float* horizons_at(int column, int row) {
        return &tangents_[(static_cast<std::size_t>(row - window_.row) *
                               static_cast<std::size_t>(window_.columns) +
                           static_cast<std::size_t>(column - window_.column)) *
                          kHeights];
    }

    OtherGrid other_;
    Window window_;                    // of the wider DEM
    float lowest_m_ = 0, step_m_ = 1;  // of the heights that are kept
    float highest_ = -1;               // of all horizons that are kept
    std::vector<float> tangents_;      // of each post of the window, of each height
};

}  // namespace relevo::light
