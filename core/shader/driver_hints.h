#pragma once

#include <string>
#include <vector>

#include "shader/driver_log.h"

namespace relevo::shader {

/// What a driver's errors are about.
struct CompiledText {
    std::string text;
    std::vector<std::string> names;   ///< of the plugins' globals, also those that `text` lacks
    std::vector<std::string> values;  ///< of parameters that are not static
};

/// What to do about a driver's error; empty if it is not known.
/// @returns "did you mean height_m?"
std::string hint_for(const Diagnostic& diagnostic, const CompiledText& compiled);

/// The errors of a log for people: of each line the first, each message once, with its hint. Lines
/// without a place are shown only if no error has one.
std::string brief_text(const DriverLog& log, const CompiledText& compiled);

}  // namespace relevo::shader
