#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "dem/grid.h"
#include "geo/local_frame.h"
#include "scene/camera.h"

/// Orthographic pictures from above. They lie on the CRS of the DEM: x runs to the right and y
/// upwards, whichever way the DEM's own rows and columns run.
namespace relevo::scene {

struct Scene;

/// Where the pixels of a map lie, in units of the DEM's CRS.
struct MapArea {
    double left = 0, top = 0;         ///< x and y of the upper left corner
    double pixel_x = 1, pixel_y = 1;  ///< sides of a pixel, both above 0
    int width_px = 1, height_px = 1;  ///< of the map

    /// As GDAL has it: from columns and rows of the map, (0, 0) its upper left corner, to x and y.
    std::array<double, 6> geotransform() const { return {left, pixel_x, 0, top, 0, -pixel_y}; }
    /// x and y of a position in the map [px], (0, 0) the upper left corner.
    glm::dvec2 point(const glm::dvec2& at_px) const {
        return {left + at_px.x * pixel_x, top - at_px.y * pixel_y};
    }
    bool operator==(const MapArea&) const = default;
};

/// The map of all cells of a DEM. Without a pixel size its edges are those of the outermost cells.
/// @param pixel      side of a pixel [CRS units]; 0: from the size
/// @param size_px    of the map
MapArea map_area(const dem::Grid& grid, double pixel, const glm::ivec2& size_px);

/// Size of the map of all cells [px]: with pixels of a size, or the largest one of square pixels
/// within a room.
/// @param pixel  as map_area()
/// @throws Error (BadInput) for sides above kMaxSide_px
glm::ivec2 map_size(const dem::Grid& grid, double pixel, const glm::ivec2& room_px);

/// Sets the size of a scene's picture, if that is a map: map_size().
/// @throws Error (BadInput) as that, and for a resolution of what is no map
void fit_map(Scene& scene, const dem::Grid& grid);

/// A map of a DEM: where its pixels are on the grid and on the Earth. Positions in the map [px] are
/// from its upper left corner, rightwards and down. Immutable; safe on several threads.
class MapView {
  public:
    MapView(dem::Grid grid, const geo::LocalFrame& frame, const MapArea& area);

    const MapArea& area() const { return area_; }
    const dem::Grid& grid() const { return grid_; }
    glm::dvec2 size_px() const { return {area_.width_px, area_.height_px}; }

    /// Column and row of the DEM, with fractions.
    glm::dvec2 post(const glm::dvec2& at_px) const;
    /// Position in the map of a column and row.
    glm::dvec2 pixel(const glm::dvec2& post) const;
    /// Position in the map of a point in the local frame [m].
    glm::dvec2 pixel_of(const glm::dvec3& point_m) const;
    /// The point at a height above the ellipsoid [m], in the local frame [m].
    glm::dvec3 point_m(const glm::dvec2& at_px, double height_m) const;
    /// The vertical there, in the local frame.
    glm::dvec3 up(const glm::dvec2& at_px) const;
    /// Sides of a pixel on the ellipsoid: to the right and upwards [m].
    glm::dvec2 pixel_m(const glm::dvec2& at_px) const;

  private:
    dem::Grid grid_;
    geo::LocalFrame frame_;
    MapArea area_;
};

/// How high the eye of a map stands above the ellipsoid, in halves of its longer side. Rays from
/// there differ by at most 2 degrees from parallel ones. Only shading notices: places in the map
/// are the grid's.
inline constexpr double kMapEye = 30;

/// The camera of a map: straight above its middle, with Camera::map.
Camera map_camera(const dem::Grid& grid, const geo::LocalFrame& frame, const MapArea& area);

/// The side of a map that counts as the camera's where the time is chosen by it [deg]: the lower
/// edge.
inline constexpr double kMapSide_deg = 180;

}  // namespace relevo::scene
