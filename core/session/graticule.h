#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "chart/stamps.h"
#include "geo/local_frame.h"
#include "session/seen_ground.h"

namespace relevo::session {

/// Lines of equal latitude and of equal longitude on the ground that a picture shows.
struct Graticule {
    double latitude_step_deg = 0, longitude_step_deg = 0;  ///< 0: no lines
    /// Opacity of the lines at each pixel, rows from the top, 0 to 1, and of the dark edge that
    /// lets them be seen on light ground.
    Array2d<float> line, edge;
    std::vector<chart::Stamps::Label> labels;
};

/// Draws where they are seen: a pixel's place is that of the ground in it, so that what is hidden
/// is hidden and water has its lines on its surface. Lines that stand nearer than some pixels to
/// each other fade.
/// @param frame      the camera's
/// @param is_ground  whether a point of it is ground, and not a wall below its edge
Graticule make_graticule(const SeenGround& seen, const geo::LocalFrame& frame,
                         const std::function<bool(const glm::dvec3& point_m)>& is_ground);

/// Degrees between lines of which at most `most` lie in a range: 1", 2", 5", ... 30 degrees.
double graticule_step_deg(double range_deg, int most);

/// "47°30'N", "8°E", "0°"; as many parts as the step needs.
std::string latitude_text(double latitude_deg, double step_deg);
std::string longitude_text(double longitude_deg, double step_deg);

/// Lays the lines on a picture, RGB, of the same size.
void draw_lines(const Graticule& graticule, image::Image8& picture);

}  // namespace relevo::session
