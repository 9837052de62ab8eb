#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/files_in_use.h"
#include "effect/native_module.h"
#include "effect/selection.h"
#include "render/renderer.h"

namespace relevo::cli {

/// The plugins there are, those that are on, and the values of their parameters.
struct ActiveEffects {
    effect::Registry registry;
    effect::Selection selection;  // points into registry
    std::vector<effect::NativeModule> modules;
    shader::ParamStore values;
    std::vector<std::string> preset_files;

    /// For a renderer; valid as long as this is.
    render::EffectInputs inputs() const;
    /// Adds presets, and the files of all plugins. @throws Error as FilesInUse::add_input
    void add_inputs(FilesInUse& files) const;
};

/// --only, --enable, --disable, --set, --preset and --plugin-path.
struct EffectArguments {
    std::vector<std::string> only, enable, disable, settings, presets, plugin_path;
    CLI::Option* only_option = nullptr;

    void add_to(CLI::App& verb);
    /// Loads the plugins and switches them.
    /// @param aloud  says on standard error what is not as asked
    std::unique_ptr<ActiveEffects> active(bool aloud = true) const;
    /// The same with these effects on, or off, whatever was asked of them.
    EffectArguments with(const std::vector<std::string>& ids) const;
    EffectArguments without(const std::vector<std::string>& ids) const;
};

}  // namespace relevo::cli
