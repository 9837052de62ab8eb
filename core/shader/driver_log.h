#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shader/line_map.h"

namespace relevo::shader {

/// One line of a driver's log.
struct Diagnostic {
    std::string severity;  ///< "error", "warning", "note"; empty for a line without a place
    LineOrigin origin;     ///< line 0: the driver named no line of the text
    int text_line = 0;     ///< in the compiled text, from 1; 0 as above
    std::string message;

    /// "plugins/haze/haze.glsl:12: error: `x' undeclared". Lines that the stitcher wrote are
    /// "stitched text:34: error: ...".
    std::string text() const;
};

struct DriverLog {
    std::vector<Diagnostic> diagnostics;
    std::string raw;  ///< as the driver gave it

    /// All diagnostics, a line each.
    std::string text() const;
    /// The owner of the first error in a plugin's or core's file; empty if no error has a place.
    std::string blamed() const;
};

/// Reads a log of compiling a stitched text, and puts every line where its author wrote it. Knows
/// `0:L(C): error: ...` (Mesa), `0(L) : error C1234: ...` (NVIDIA) and `ERROR: 0:L: ...` (Intel,
/// AMD, glslang); other lines, as most of a link log, stay as they are. Never throws.
DriverLog parse_driver_log(std::string_view log, const LineMap& lines);

}  // namespace relevo::shader
