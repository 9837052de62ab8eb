#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/files_in_use.h"
#include "effect/loaded_selection.h"
#include "gl/context.h"
#include "render/renderer.h"

namespace relevo::cli {

/// The plugins there are, those that are on, and the values of their parameters.
struct ActiveEffects {
    effect::Registry registry;
    std::vector<effect::Preset> presets;
    effect::Switches switches;
    effect::LoadedSelection loaded;  // points into registry
    shader::ParamStore values;

    /// Switches off, with a warning, what brings larger textures than a device takes.
    /// @throws Error (BadInput) for what was asked for by name
    void fit(const gl::DeviceInfo& device, bool aloud = true);
    /// For a renderer; valid as long as this is.
    render::EffectInputs inputs() const;
    /// Adds presets, and the files of all plugins. @throws Error as FilesInUse::add_input
    void add_inputs(FilesInUse& files) const;
};

/// --only, --enable, --disable, --set, --preset and --plugin-path.
struct EffectArguments {
    std::vector<std::string> only, enable, disable, settings, presets, plugin_path;
    CLI::Option* only_option = nullptr;
    std::optional<std::vector<std::string>> exactly;  ///< in the place of --only and --enable

    void add_to(CLI::App& verb);
    /// Loads the plugins and switches them.
    /// @param aloud  says on standard error what is not as asked
    std::unique_ptr<ActiveEffects> active(bool aloud = true) const;
    /// The same with these effects on, whatever was asked of them.
    EffectArguments with(const std::vector<std::string>& ids) const;
    /// The effects of `shown` but these and what requires them. What they have pulled in stays: the
    /// difference is theirs alone.
    EffectArguments without(const std::vector<std::string>& ids, const ActiveEffects& shown) const;
};

}  // namespace relevo::cli
