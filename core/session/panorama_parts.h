#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "scene/panorama.h"
#include "session/picture_tiles.h"

/// The perspective frames that a panorama is made of.
namespace relevo::session {

/// A rectangle of a panorama, and the frame that shows it.
struct PanoramaPart {
    PictureRect rect;  ///< of the panorama, from its upper left corner
    /// Right, up and forward of the frame's camera, in the axes of scene::PanoramaMap.
    glm::dmat3 axes{1};
    /// Size of the picture around the camera's axis that the frame is a part of [px]. Its pixels
    /// are as large as the panorama's on the horizon where they are largest, on the axis.
    glm::ivec2 picture_px{0};
    PictureRect frame;  ///< of that picture, from its lower left corner
    double fov_y_rad = 0;

    /// Image position of a direction in the frame, from its upper left corner [px].
    glm::dvec2 project(const glm::dvec3& direction, double px_per_rad) const;
};

/// Parts are at most this wide and, if equirectangular, high: pixels at the edge of a frame are
/// then up to 1.1 times finer than on its axis.
inline constexpr double kPart_deg = 36;

/// Parts that cover a panorama.
/// @param margin_px    of each frame around what it shows of the panorama
/// @param most_px      pixels of a frame, where parts of a few columns allow it
/// @throws Error (BadInput) if a frame would have more than `max_side_px`
std::vector<PanoramaPart> parts_of(const scene::PanoramaMap& map, int margin_px, double most_px,
                                   int max_side_px);

}  // namespace relevo::session
