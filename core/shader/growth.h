#pragma once

#include <vector>

#include "shader/snippet.h"

namespace relevo::shader {

/// Refuses GLSL that is short and grows beyond what a driver can hold: drivers expand all macros
/// and put a copy of a function in the place of each call, and end the program where they run out
/// of memory.
/// @param files  all of a plugin's, in their order
/// @throws Error (BadInput) `shader: file:line: ...` for a function that comes to more than
///     a million words, for macros and calls nested more than 200 deep, and for an array of more
///     than 65536 elements, as far as its length can be told
void check_growth(const std::vector<Snippet>& files);

}  // namespace relevo::shader
