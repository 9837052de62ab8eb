#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/verb.h"
#include "scene/scene.h"

namespace relevo::cli {

/// Whether a word is meant for --set: "haze.density=0.2".
bool is_setting(std::string_view word);

/// --only, --enable, --disable, --order, --set, --preset and --plugin-path.
struct EffectArguments {
    std::vector<std::string> only, enable, disable, order, settings, presets, plugin_path;
    Option only_option;

    void add_to(Verb verb);
    /// Puts what was given in the place of what a scene says: --only and --preset replace its own,
    /// the rest is added. @throws Error (Usage)
    void apply_to(scene::Effects& effects) const;
    /// Refuses names of files that are meant for --set, which takes one value. @throws Error
    /// (Usage)
    void check_files(const std::vector<std::string>& files) const;
};

}  // namespace relevo::cli
