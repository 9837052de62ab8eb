#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relevo::cli {

/// --only, --enable, --disable, --set, --preset and --plugin-path.
struct EffectArguments {
    std::vector<std::string> only, enable, disable, settings, presets, plugin_path;
    CLI::Option* only_option = nullptr;

    void add_to(CLI::App& verb);
    /// Puts what was given in the place of what a scene says: --only and --preset replace its own,
    /// the rest is added. @throws Error (Usage)
    void apply_to(scene::Effects& effects) const;
};

}  // namespace relevo::cli
