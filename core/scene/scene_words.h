#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

/// Words that scenes are written with and read by.
namespace relevo::scene {

const std::vector<std::string>& refractions();  ///< of Scene::refraction
const std::vector<std::string>& encodings();    ///< of dem::Encoding, in its order

/// Stamps by their words, without the legend, which is there without being asked for.
const std::vector<std::pair<std::string_view, bool Stamps::*>>& stamp_words();

/// "06:30" of "6:30".
std::string padded_clock(const std::string& clock);

}  // namespace relevo::scene
