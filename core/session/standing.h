#pragma once

#include <functional>
#include <optional>
#include <string>

#include "geo/local_frame.h"
#include "render/displacement.h"
#include "scene/view.h"
#include "session/session.h"

/// Where the eye stands. Figures come from the DEM's posts. Cameras follow the ground as it is
/// drawn, which differs from them by its level of detail, by its triangles between posts, by filled
/// voids, and by what effects displace.
namespace relevo::session {

/// Heights to aim cameras at: those of the posts that are drawn, on the triangles between them; on
/// water, of the level that an effect lifts its floor to. Within the level of detail of the drawn
/// ground, but for effects that displace land. Keeps the DEM.
scene::GroundHeight heights_to_aim_at(std::shared_ptr<const LoadedDem> dem,
                                      const render::Displacement& displacement);

/// Heights that an eye may have [m]: the centre of the Earth, and from where a globe fills a
/// picture of 1 degree.
inline constexpr double kDeepestEye_m = -6.4e6, kFarthestEye_m = 9e8;

/// @param dem  as the message names it
/// @throws Error (BadInput) for an eye beyond these
void check_eye_height(const scene::View& view, const std::string& dem);

/// What standing() asks of a session.
struct DrawnGround {
    const geo::LocalFrame& frame;
    double exaggeration = 1;
    /// Height of the drawn ground on the vertical through a camera's eye [m], exaggerated; none
    /// where no ground is drawn.
    std::function<std::optional<double>(const scene::Camera&)> height_m;
    /// Makes a view's camera by heights to aim at. @throws Error as scene::make_camera()
    std::function<scene::Camera(const scene::View&)> camera;
};

/// The camera of a view on the drawn ground: an eye that is given above the ground is that far
/// above it, within 1 cm; an orbit's eye is no nearer above it than scene::kClearance_m.
/// @param keep_above_m  eyes with a height of their own are raised to be so far above it; none:
///                      they stay where they are given
/// @throws Error as DrawnGround::camera
scene::Camera standing(const scene::View& view, const DrawnGround& ground,
                       std::optional<double> keep_above_m);

}  // namespace relevo::session
