#pragma once

#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// Lines of the loops in a file that may go on for ever, or for very long, as far as their heads
/// tell: all but `for (int i = 0; i < N; ++i)` and its like, where N is a number up to 10000 or a
/// constant and nothing inside writes to i.
std::vector<int> open_loops(const Source& source);

}  // namespace relevo::shader
