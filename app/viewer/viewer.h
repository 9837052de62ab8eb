#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// The window: opens a scene and shows it until it is closed.
/// @param device  as session::Options
/// @param zone    that dates and times are shown in; none: by the DEM's place
/// @throws Error (NoDevice) without a display, and as session::Session
void run(const scene::Scene& scene, const std::string& device,
         const std::optional<sun::Zone>& zone);

}  // namespace relevo::viewer
