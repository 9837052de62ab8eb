#pragma once

#include <set>
#include <string>
#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// What a piece of GLSL mentions beyond what it declares itself.
struct Uses {
    std::set<std::string, std::less<>> names;  ///< every identifier, fields behind a dot left out
    std::set<std::string, std::less<>> calls;  ///< those with a ( behind them
};

/// The names in an item that reach outside it: a function's own arguments and local variables are
/// not among them, in the scope where they hold.
/// @param active  per token of the source, evaluate_conditions().active
Uses uses_of(const Source& source, const Item& item, const std::vector<bool>& active);

}  // namespace relevo::shader
