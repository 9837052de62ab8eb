#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "session/active_effects.h"

namespace relevo::session {

/// A picture with non-finite radiance, and all that it was drawn from.
struct FaultyPicture {
    const scene::Effects& asked;
    const ActiveEffects& effects;
    gl::Context& context;
    render::RendererOptions options;
    render::Terrain& terrain;
    const render::Ground& ground;
    const render::FrameInputs& frame;
    int pixels = 0;  ///< with NaN or infinite radiance
};

/// Message about a picture with non-finite pixels.
std::string non_finite_text(int pixels, glm::ivec2 size_px);

/// Where an effect makes pixels NaN or infinite.
struct NonFiniteCause {
    std::string file;      ///< of the hook
    int line = 0;          ///< that first writes the value; else that of the hook
    std::string function;  ///< "dust_on_material"
    std::string value;     ///< "s.diffuse", "radiance"; empty: the returned value, or unknown
};

/// Finds the hook of an effect, and of a Surface the first member, without which fewer pixels are
/// NaN or infinite.
std::optional<NonFiniteCause> find_cause(const FaultyPicture& picture, const std::string& id);

/// Finds the effect that makes pixels non-finite by drawing the picture without each effect in
/// turn.
/// @throws Error (Failed) that names the effect, always
[[noreturn]] void report_non_finite(const FaultyPicture& picture);

}  // namespace relevo::session
