#pragma once

#include <string>
#include <vector>

namespace relevo::shader {

/// Where a line of a program's text comes from.
struct LineOrigin {
    std::string owner;  ///< plugin id, "core", or empty for what the stitcher wrote itself
    std::string file;   ///< empty for what the stitcher wrote itself
    int line = 0;       ///< in that file, from 1
};

/// One origin for each physical line of a text; line n is element n - 1.
using LineMap = std::vector<LineOrigin>;

}  // namespace relevo::shader
