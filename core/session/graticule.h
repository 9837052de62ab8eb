#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "chart/stamps.h"
#include "geo/local_frame.h"
#include "scene/map_view.h"
#include "session/seen_ground.h"

namespace relevo::session {

/// Meridians and parallels drawn over the ground of an image.
struct Graticule {
    double latitude_step_deg = 0, longitude_step_deg = 0;  ///< 0: no lines
    /// Opacity at each pixel, 0 to 1, rows from the top: of the lines, and of the dark outline that
    /// keeps them legible on bright ground.
    Array2d<float> line, edge;
    std::vector<chart::Stamps::Label> labels;
};

/// Draws the lines from the ground position of each pixel: hidden ground has no lines, and water
/// has them on its surface. Lines fade out where they are few pixels apart.
/// @param frame      the frame of the camera and of `seen`
/// @param is_ground  true if a point in `frame` [m] is ground, not a wall below the DEM's edge
Graticule make_graticule(const SeenGround& seen, const geo::LocalFrame& frame,
                         const std::function<bool(const glm::dvec3& point_m)>& is_ground);

/// The same of a map, as lines.
struct MapGraticule {
    chart::Drawing drawing;  ///< of the map's size [px]
    std::vector<chart::Stamps::Label> labels;
};

/// Draws the lines all over a map, also where it has no ground. @param unit_px  as
/// chart::stamp_scale()
MapGraticule make_graticule(const scene::MapView& map, double unit_px);

/// The smallest step of 1", 2", 5", ... 30 degrees that divides a range by at most `most` lines.
double graticule_step_deg(double range_deg, int most);

/// "47°30'N", "8°E", "0°"; minutes and seconds only if the step has any.
std::string latitude_text(double latitude_deg, double step_deg);
std::string longitude_text(double longitude_deg, double step_deg);

/// Draws the lines over an RGB image of the same size.
void draw_lines(const Graticule& graticule, image::Image8& picture);

}  // namespace relevo::session
