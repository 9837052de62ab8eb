#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shader/line_map.h"

namespace relevo::shader {

/// One line of a driver's log.
struct Diagnostic {
    std::string severity;  ///< "error", "warning", "note"; empty for a line without a location
    LineOrigin origin;     ///< line 0: the driver named no line
    int text_line = 0;     ///< in the compiled text, from 1; 0 as above
    std::string message;

    /// "plugins/haze/haze.glsl:12: error: `x' undeclared". Lines of the stitcher are
    /// "stitched text:34: error: ...".
    std::string text() const;
};

struct DriverLog {
    std::vector<Diagnostic> diagnostics;
    std::string raw;  ///< the driver's own line

    /// All diagnostics, a line each.
    std::string text() const;
    /// The owner of the first error in a plugin's or core's file; empty if no error has a location.
    std::string blamed() const;
};

/// Reads the log of compiling a stitched text, with each line's file and line. Knows
/// `0:L(C): error: ...` (Mesa), `0(L) : error C1234: ...` (NVIDIA) and `ERROR: 0:L: ...` (Intel,
/// AMD, glslang). Other lines, as most of a link log, are unchanged. Never throws.
DriverLog parse_driver_log(std::string_view log, const LineMap& lines);

}  // namespace relevo::shader
