#pragma once

#include <string>
#include <vector>

#include "light/point/doubt.h"

namespace relevo::report {

constexpr int kDoubtDirections = 1440;  ///< of a profile that doubts are looked for in

/// Warns, once each, of directions in which the blocking ridge may lie beyond the DEM, and of those
/// in which it may stand in a hole.
void warn_of(const light::Doubt& doubt);

/// "from azimuth 64 (ENE) to 88 (E), and at azimuth 97 (E)", of directions that a reader tells
/// apart; empty without any.
std::string sectors_text(const std::vector<light::Sector>& sectors);

/// "8:23:05", of any length.
std::string hours_text(double seconds);

}  // namespace relevo::report
