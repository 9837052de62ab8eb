#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files_in_use.h"
#include "effect/loaded_selection.h"
#include "gl/context.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace relevo::session {

/// The plugins there are, and the parameters that they and the core have. No device is needed.
struct InstalledEffects {
    effect::Registry registry;
    std::vector<effect::Preset> presets;
    shader::ParamStore values;

    /// Reads the plugins and presets that a scene names; values are those of the plugins.
    /// @throws Error (BadInput) as effect::Registry and effect::load_preset
    explicit InstalledEffects(const scene::Effects& effects);

    /// All parameters there are, with their defaults.
    shader::ParamStore defaults() const;
};

/// Those that are on as well, with what they load, and the values that a scene gives.
struct ActiveEffects : InstalledEffects {
    effect::Switches switches;
    effect::GroundWords ground;
    effect::LoadedSelection loaded;    // points into registry
    std::vector<std::string> notices;  ///< of the settings

    using InstalledEffects::InstalledEffects;

    /// Visits the files that it was read from.
    /// @param visit  called with the path and what the file is: "the preset"
    void visit_files(
        const std::function<void(const std::filesystem::path&, const std::string&)>& visit) const;

    /// Loads the plugins and switches them.
    /// @param aloud  says with log what is not as asked
    /// @throws Error (BadInput) as effect::select_and_load and effect::apply_settings
    static std::unique_ptr<ActiveEffects> of(const scene::Effects& effects, bool aloud = true,
                                             const effect::GroundWords& ground = {});

    /// Switches off what the DEM is not for.
    /// @throws Error (BadInput) as effect::select_and_load
    void take_ground(const effect::GroundWords& words, const scene::Effects& asked,
                     bool aloud = true);

    /// Switches off those that provide a word and were not asked for by name.
    /// @returns their ids
    /// @throws Error (BadInput) as effect::select_and_load
    std::vector<std::string> switch_off_unasked(std::string_view word);

    /// Switches off, with a warning, what brings larger textures than a device takes.
    /// @throws Error (BadInput) for what was asked for by name
    void fit(const gl::DeviceInfo& device, bool aloud = true);
    /// The values of parameters with other settings, if those need neither another program nor
    /// another module; else none.
    /// @param aloud  logs notices that were not logged before
    /// @throws Error (BadInput) as effect::apply_settings
    std::optional<shader::ParamStore> values_with(const std::vector<effect::Setting>& settings,
                                                  bool aloud);
    /// For a renderer; valid as long as this is.
    render::EffectInputs inputs() const;
    /// Adds presets, and the files of all plugins. @throws Error as FilesInUse::add_input
    void add_inputs(FilesInUse& files) const;
    /// All files that it was read from, and the folders in which plugins were looked for.
    std::vector<std::filesystem::path> files_and_folders() const;
};

/// The same with these effects on, whatever was asked of them.
scene::Effects with(scene::Effects effects, const std::vector<std::string>& ids);

/// The effects of `shown` but these and what requires them. What they have pulled in stays: the
/// difference is theirs alone.
scene::Effects without(scene::Effects effects, const std::vector<std::string>& ids,
                       const ActiveEffects& shown);

}  // namespace relevo::session
