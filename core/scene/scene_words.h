#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

/// Words that scenes are written with and read by.
namespace relevo::scene {

/// Stamps by their words, without the legend, which is there without being asked for.
const std::vector<std::pair<std::string_view, bool Stamps::*>>& stamp_words();

/// An angle as people gave it: the shortest of degrees that are read as the same bits.
double written_deg(double angle_rad);

/// "06:30" of "6:30".
std::string padded_clock(const std::string& clock);

}  // namespace relevo::scene
