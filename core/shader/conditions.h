#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shader/source.h"

/// Which parts of a file the GLSL preprocessor will leave in, as far as that can be told before it
/// runs: a function that only a switched-off branch calls need not be in the text.
namespace relevo::shader {

/// Macros by name. Empty: defined, but as a function or in a branch that could not be decided.
using Macros = std::map<std::string, std::optional<std::string>, std::less<>>;

struct Conditions {
    std::vector<bool> active;     ///< per token: may be left in
    std::vector<bool> undecided;  ///< per token: an #if, #elif, #else or #endif that has to stay
};

/// Walks through a file's directives.
/// @param macros  what is defined before the file; the file's own are added
Conditions evaluate_conditions(const Source& source, Macros& macros);

/// The value of an #if expression, if it can be told: integers, `defined`, macros with such values.
std::optional<long long> evaluate_expression(std::string_view expression, const Macros& macros);

}  // namespace relevo::shader
