#pragma once

#include <glm/vec2.hpp>

#include "viewer/picture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// The measured line on the ground, faint where other ground hides it.
/// @param size_px  of the window
void draw_measurement(const Measurement& measurement, const Picture& picture, glm::vec2 size_px);

/// Profile, lengths, heights, area and line of sight of the measured line.
void measurement_panel(State& state);

}  // namespace relevo::viewer
