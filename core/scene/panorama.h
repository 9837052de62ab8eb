#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.h"

/// Pictures all around the eye.
namespace relevo::scene {

/// Where the pixels of a panorama look. Directions are unit vectors at the eye: x east, y north, z
/// up. Image positions are in pixels from the upper left corner, the first pixel's centre is at
/// (0.5, 0.5). Pixels are square on the horizon.
///
/// Columns are azimuths in equal steps. Rows are elevations e in equal steps of e (equirectangular)
/// or of tan e (cylindrical). Source: J. Snyder, Map Projections: A Working Manual, USGS
/// Professional Paper 1395, 1987, page 90; cylindrical is the central cylindrical projection.
class PanoramaMap {
  public:
    /// @param view         with a panorama
    /// @param picture_px   that check_panorama() allows
    /// @param heading_rad  azimuth of the middle column, clockwise from true north
    /// @param pitch_rad    elevation of the middle row, or as near to it as kSteepest_deg and the
    ///     poles allow
    PanoramaMap(const View& view, const glm::ivec2& picture_px, double heading_rad,
                double pitch_rad);

    bool is_equirectangular() const { return kind_ == Panorama::Equirectangular; }
    const glm::ivec2& picture_px() const { return picture_px_; }
    double px_per_rad() const { return px_per_rad_; }  ///< on the horizon
    double azimuth_rad(double x_px) const;             ///< of a column
    double elevation_rad(double y_px) const;           ///< of a row
    glm::dvec3 direction(const glm::dvec2& at_px) const;
    /// The image position of a direction, outside of the picture too; the nearest to its middle
    /// column. nullopt where the projection has none.
    std::optional<glm::dvec2> project(const glm::dvec3& direction) const;

  private:
    /// Rows from the horizon, upwards [px / px_per_rad()].
    double rise(double elevation_rad) const;

    Panorama kind_;
    glm::ivec2 picture_px_;
    double px_per_rad_, heading_rad_;
    double top_ = 0;  // rise() of the upper edge
};

/// Highest and lowest elevation of a cylindrical panorama: at 90 degrees it would have no end.
inline constexpr double kSteepest_deg = 85;

/// Size of a panorama where none is given [px]: 8192 columns for a cylindrical turn, 4096 for an
/// equirectangular one. Vertically the lens's field of view; without one kDefaultFov_deg, and of an
/// equirectangular one all from the nadir to the zenith.
glm::ivec2 default_panorama_px(const View& view);

/// Vertical field of view of a perspective picture whose pixels are as those of a panorama.
/// @param aspect  width / height of the panorama
double perspective_fov_y_rad(const View& view, double aspect);

/// @throws Error (BadInput) for a panorama without an eye, or of more rows than elevations
void check_panorama(const Scene& scene);

}  // namespace relevo::scene
