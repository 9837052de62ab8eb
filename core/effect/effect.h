#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "effect/manifest.h"
#include "shader/snippet.h"

namespace relevo::effect {

/// A plugin that has been loaded and checked: its manifest and its GLSL.
struct Effect {
    Manifest manifest;
    std::vector<shader::Snippet> snippets;  ///< one for each file, in order

    const std::string& id() const { return manifest.id; }
    bool provides(std::string_view capability) const;
    bool answers(std::string_view hook) const;
    std::vector<shader::Param> params() const;      ///< in the order of the files
    std::vector<shader::ColourRamp> ramps() const;  ///< in the order of the files
};

/// Loads a plugin's folder, and checks that manifest and GLSL are consistent.
/// @throws Error (BadInput) that names the author's file and line
Effect load_effect(const std::filesystem::path& folder, const std::filesystem::path& data_dir);

}  // namespace relevo::effect
