#pragma once

#include <set>
#include <string>
#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// The names that an item uses and does not declare.
struct Uses {
    std::set<std::string, std::less<>> names;  ///< every identifier but fields after a dot
    std::set<std::string, std::less<>> calls;  ///< those with a ( after them
};

/// Names of an item that refer to globals. A function's arguments and local variables are excluded
/// within their scope.
/// @param active  per token of the source, evaluate_conditions().active
Uses uses_of(const Source& source, const Item& item, const std::vector<bool>& active);

}  // namespace relevo::shader
