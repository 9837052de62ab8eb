#pragma once

#include <functional>
#include <optional>
#include <string>

#include "geo/local_frame.h"
#include "render/displacement.h"
#include "scene/view.h"
#include "session/session.h"

/// Places cameras on the drawn ground. It differs from the DEM's posts by its level of detail, its
/// triangles, filled voids and displacement by effects.
namespace relevo::session {

/// Heights of the ground that cameras aim at, exaggeration excluded: interpolated on the triangles
/// between drawn posts. On sea and river, the water level of a displacing effect. Displacement of
/// land is ignored. Keeps `dem` alive.
scene::GroundHeight heights_to_aim_at(std::shared_ptr<const LoadedDem> dem,
                                      const render::Displacement& displacement);

/// Range of eye heights [m]: from the Earth's centre to where the globe fills a field of view of 1
/// degree.
inline constexpr double kDeepestEye_m = -6.4e6, kFarthestEye_m = 9e8;

/// @param dem  its name in the message
/// @throws Error (BadInput) if the eye's height is outside that range
void check_eye_height(const scene::View& view, const std::string& dem);

/// Functions of a session that standing() needs.
struct DrawnGround {
    const geo::LocalFrame& frame;
    double exaggeration = 1;
    /// Height of the drawn ground on the vertical through a camera's eye [m], exaggerated; nullopt
    /// without ground.
    std::function<std::optional<double>(const scene::Camera&)> height_m;
    /// Camera of a view, aimed by heights_to_aim_at(). @throws Error as scene::make_camera()
    std::function<scene::Camera(const scene::View&)> camera;
};

/// The camera of a view over the drawn ground. An eye that is given above ground is placed at that
/// height within 1 cm. An orbit's eye is raised to scene::kClearance_m above ground.
/// @param keep_above_m  least height above ground for eyes with an absolute height; nullopt: not
///     raised
/// @throws Error as DrawnGround::camera
scene::Camera standing(const scene::View& view, const DrawnGround& ground,
                       std::optional<double> keep_above_m);

}  // namespace relevo::session
