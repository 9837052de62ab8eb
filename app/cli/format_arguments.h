#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/verb.h"
#include "image/image.h"
#include "session/session.h"

namespace relevo::cli {

/// What picture files are, as far as their names do not say it.
struct FormatArguments {
    std::string format;
    std::optional<int> bits, quality;
    std::vector<std::string> layers;

    /// @param with_format  also --format, for a picture on standard output
    void add_to(Verb verb, bool with_format);

    /// @param output  as -o names it. @throws Error (Usage) for --format of a file, and for a
    /// terminal
    image::Encoding encoding(const std::string& output = {}) const;
    static bool is_standard_output(const std::string& output) { return output == "-"; }
    /// A name whose ending is the format.
    std::filesystem::path named(const std::string& output) const;
    /// @throws Error (BadInput) for unknown layers
    session::PictureFormat picture() const;
};

/// The file that -o means: "-" is standard output.
std::string to_file(const std::string& output);

}  // namespace relevo::cli
