#pragma once

#include <vector>

#include "shader/snippet.h"

/// GLSL that a driver would not survive.
namespace relevo::shader {

/// Refuses short GLSL that grows larger than a driver's memory. Drivers expand all macros and
/// inline every call, and crash if memory runs out.
/// @param files  all of a plugin's, in their order
/// @throws Error (BadInput) `shader: file:line: ...` for a function of more than a million words
///     when expanded, for macros and calls nested more than 200 deep, and for an array of more
///     than 65536 elements, if its length is known
void check_growth(const std::vector<Snippet>& files);

/// Lines of the loops in a file that may not end, or only after a very long time, judged by their
/// heads. All loops but `for (int i = 0; i < N; ++i)` and similar ones, where N is a number up to
/// 10000 or a constant and the body does not write to i.
std::vector<int> open_loops(const Source& source);

}  // namespace relevo::shader
