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

/// Installed plugins with the parameters of plugins and core. Needs no device.
struct InstalledEffects {
    effect::Registry registry;
    std::vector<effect::Preset> presets;
    shader::ParamStore values;

    /// Reads the plugins and presets that `effects` names; parameters get their defaults.
    /// @throws Error (BadInput) as effect::Registry and effect::load_preset
    explicit InstalledEffects(const scene::Effects& effects);

    /// All parameters with their default values.
    shader::ParamStore defaults() const;

    /// A file that a text names.
    struct ChosenFile {
        std::string address;  ///< "drape.file"
        std::filesystem::path file;
    };
    /// Files that the texts of `set` name: those of kind `file`, and colour files of rasters.
    std::vector<ChosenFile> chosen_files(const shader::ParamStore& set) const;
};

/// Installed effects, those of them that are switched on, their loaded files, and a scene's
/// parameter values.
struct ActiveEffects : InstalledEffects {
    effect::Switches switches;
    effect::GroundWords ground;
    effect::LoadedSelection loaded;    // points into registry
    bool constants = false;            ///< StitchInput::constants
    bool mapped = false;               ///< a map of land cover has been given: HAS_mapped
    bool houses = false;               ///< they are found by heights: HAS_houses
    std::vector<std::string> notices;  ///< notices of apply_settings(), already logged

    using InstalledEffects::InstalledEffects;

    /// Visits each file that was read: presets, manifests, GLSL, textures, modules.
    /// @param visit  called with the path and a description of the file: "the preset"
    void visit_files(
        const std::function<void(const std::filesystem::path&, const std::string&)>& visit) const;

    /// Loads the plugins and switches effects on.
    /// @param report  logs warnings and notices
    /// @throws Error (BadInput) as effect::select_and_load and effect::apply_settings
    static std::unique_ptr<ActiveEffects> of(const scene::Effects& effects, bool report = true,
                                             const effect::GroundWords& ground = {});

    /// Switches off effects that do not apply to the DEM.
    /// @throws Error (BadInput) as effect::select_and_load
    void take_ground(const effect::GroundWords& words, const scene::Effects& asked,
                     bool report = true);

    /// Switches off effects that provide `word` unless they were enabled by id.
    /// @returns the ids of effects that were on
    /// @throws Error (BadInput) as effect::select_and_load
    std::vector<std::string> switch_off_unasked(std::string_view word);

    /// Switches off, with a warning, effects whose textures exceed the device's limits.
    /// @throws Error (BadInput) if such an effect was enabled by id
    void fit(const gl::DeviceInfo& device, bool report = true);
    /// The parameter values under other settings; nullopt if these change a static parameter or a
    /// text, which needs another program or module.
    /// @param report  logs notices that were not logged before
    /// @throws Error (BadInput) as effect::apply_settings
    std::optional<shader::ParamStore> values_with(const std::vector<effect::Setting>& settings,
                                                  bool report);
    /// Inputs of a renderer; they point into this object.
    render::EffectInputs inputs() const;
    /// Adds all files that were read as inputs. @throws Error as FilesInUse::add_input
    void add_inputs(FilesInUse& files) const;
    /// All files that were read, and the folders that were searched for plugins.
    std::vector<std::filesystem::path> files_and_folders() const;
};

/// `effects` with `ids` enabled, even if they were disabled.
scene::Effects with(scene::Effects effects, const std::vector<std::string>& ids);

/// The effects that are on in `shown`, without `ids` and the effects that require them. Effects
/// that `ids` require stay on, so that only `ids` differ.
scene::Effects without(scene::Effects effects, const std::vector<std::string>& ids,
                       const ActiveEffects& shown);

}  // namespace relevo::session
