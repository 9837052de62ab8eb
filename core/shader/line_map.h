#pragma once

#include <string>
#include <vector>

namespace relevo::shader {

/// The source of a line of a program's text.
struct LineOrigin {
    std::string owner;  ///< plugin id, "core", or empty for a line of the stitcher
    std::string file;   ///< empty for a line of the stitcher
    int line = 0;       ///< in that file, from 1
};

/// One origin for each physical line of a text; line n is element n - 1.
using LineMap = std::vector<LineOrigin>;

}  // namespace relevo::shader
