#pragma once

#include <string>
#include <vector>

/// Words that scenes are written with and read by.
namespace relevo::scene {

const std::vector<std::string>& refractions();  ///< of Scene::refraction
const std::vector<std::string>& encodings();    ///< of dem::Encoding, in its order

/// "06:30" of "6:30".
std::string padded_clock(const std::string& clock);

}  // namespace relevo::scene
