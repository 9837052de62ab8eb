#pragma once

#include <map>
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

using UsesOf = std::map<std::string, Uses, std::less<>>;

/// The names that some need, themselves included.
/// @param uses  of names; others need none
std::set<std::string> reachable(std::vector<std::string> names, const UsesOf& uses);

}  // namespace relevo::shader
