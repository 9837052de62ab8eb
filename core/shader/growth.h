#pragma once

#include <vector>

#include "shader/snippet.h"

namespace relevo::shader {

/// Refuses short GLSL that grows larger than a driver's memory. Drivers expand all macros and
/// inline every call, and crash if memory runs out.
/// @param files  all of a plugin's, in their order
/// @throws Error (BadInput) `shader: file:line: ...` for a function of more than a million words
///     when expanded, for macros and calls nested more than 200 deep, and for an array of more
///     than 65536 elements, if its length is known
void check_growth(const std::vector<Snippet>& files);

}  // namespace relevo::shader
