#pragma once

#include "effect/preset.h"
#include "effect/registry.h"
#include "weather/facts.h"

namespace relevo::effect {

/// Name of the preset, which no file has.
inline constexpr const char* kWeatherPreset = "weather";

/// What plugins take from the weather, as a preset without a file: effects that its words switch
/// on, and parameters that its figures set. A figure beyond a parameter's range is the end of it.
Preset weather_preset(const Registry& registry, const weather::Facts& facts);

}  // namespace relevo::effect
