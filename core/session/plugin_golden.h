#pragma once

#include <filesystem>
#include <string>

#include "image/image.h"

/// The golden test of a plugin: the bundled DEM drawn with it on the software device.
namespace relevo::session {

/// Share of values that may differ by more than 1/255, and the largest difference [1/255].
inline constexpr double kGoldenShare = 0.0002;
inline constexpr double kGoldenWorst = 3;

/// Draws the bundled DEM with one plugin and what it requires.
/// @param id  the plugin; empty: without plugins
/// @throws Error as Session, and for pixels that are NaN or infinite
image::Image8 draw_with_plugin(const std::filesystem::path& folder, const std::string& id);

/// What the golden test found.
struct GoldenResult {
    std::string text;         ///< a sentence
    bool is_written = false;  ///< golden.png was written
};

/// Compares a plugin's picture with `folder/golden.png`, or writes that file.
/// @throws Error (Differ) if they differ: the picture is then in `folder/found.png`
/// @throws Error (BadInput) if there is no plugin or no golden.png, and as draw_with_plugin()
GoldenResult test_plugin(const std::filesystem::path& folder, bool update);

}  // namespace relevo::session
