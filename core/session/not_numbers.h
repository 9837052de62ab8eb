#pragma once

#include <string>

#include <glm/vec2.hpp>

#include "session/active_effects.h"

namespace relevo::session {

/// A picture whose light is no number in some pixels, and all that it was drawn from.
struct FaultyPicture {
    const scene::Effects& asked;
    const ActiveEffects& effects;
    gl::Context& context;
    render::RendererOptions options;
    render::Terrain& terrain;
    const render::Ground& ground;
    const render::FrameInputs& frame;
    int pixels = 0;  ///< that are no number, or infinite
};

/// What is wrong with a picture of which some pixels are no number.
std::string not_numbers_text(int pixels, glm::ivec2 size_px);

/// Finds the effects that make them, by drawing the picture without each in turn.
/// @throws Error (Failed) that names them, always
[[noreturn]] void refuse_not_numbers(const FaultyPicture& picture);

}  // namespace relevo::session
