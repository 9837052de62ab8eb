#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

/// What the targets share. A target is a file here with one Target: docs/fuzzing.md.
namespace relevo::fuzz {

/// Gives bytes to a reader. Throwing Error is right; a crash, a leak, any other exception and a
/// call of more than 10 s are findings.
struct Target {
    using Read = void (*)(std::string_view bytes);
    Target(std::string name, Read read);
};

/// Names the target that LLVMFuzzerTestOneInput() runs; of a program with one target it is that
/// one.
/// @returns false if the program has no such target
bool choose_target(const std::string& name);

/// Calls one of several readers that get the same bytes.
template <typename Reader>
void attempt(const Reader& reader) {
    try {
        reader();
    } catch (const Error&) {
        // As the readers promise.
    }
}

/// A folder of this process alone, in which files are written.
const std::filesystem::path& folder();

/// Writes a file of these bytes there, replacing it.
std::filesystem::path file(std::string_view bytes, const std::filesystem::path& name);

}  // namespace relevo::fuzz
