#pragma once

#include <string>

#include "scene/scene.h"

namespace relevo::viewer {

/// The window: opens a scene and shows it until it is closed. Dates and times are shown in the
/// scene's zone, which is the DEM's where it names none.
/// @param device  as session::Options
/// @throws Error (NoDevice) without a display, and as session::Session
void run(const scene::Scene& scene, const std::string& device);

}  // namespace relevo::viewer
