#pragma once

#include <string>
#include <string_view>
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
