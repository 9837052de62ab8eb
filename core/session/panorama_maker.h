#pragma once

#include <glm/mat3x3.hpp>

#include "geo/local_frame.h"
#include "scene/camera.h"
#include "scene/panorama.h"

namespace relevo::session {

/// From the axes of scene::PanoramaMap, east, north and up at a camera's eye, to the local frame.
glm::dmat3 eye_axes(const geo::LocalFrame& frame, const scene::Camera& camera);

/// Where the pixels of a scene's panorama look. @param camera  of the scene; its direction is the
/// panorama's middle
scene::PanoramaMap panorama_map(const scene::Scene& scene, const geo::LocalFrame& frame,
                                const scene::Camera& camera);

}  // namespace relevo::session
