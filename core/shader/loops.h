#pragma once

#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// Lines of the loops in a file that may not end, or only after a very long time, judged by their
/// heads. All loops but `for (int i = 0; i < N; ++i)` and similar ones, where N is a number up to
/// 10000 or a constant and the body does not write to i.
std::vector<int> open_loops(const Source& source);

}  // namespace relevo::shader
