#pragma once

#include <optional>
#include <vector>

#include "effect/native_module.h"
#include "effect/selection.h"
#include "effect/texture_files.h"

namespace relevo::effect {

/// A selection with what its effects bring beside their GLSL.
struct LoadedSelection {
    Selection selection;
    std::vector<NativeModule> modules;    ///< in the selection's order
    std::vector<LoadedTexture> textures;  ///< in the selection's order
    Unusable unusable;                    ///< what was wanted and cannot be on
};

/// Selects as select() does, and loads textures and modules. An effect whose files cannot be used
/// is off, with a warning, and so is what requires it.
/// @param values  of all parameters, for the modules' trial
/// @param limits  of the device, where it is known
/// @param loaded  of a selection before, not to be loaded and tried again
/// @throws Error as select()
LoadedSelection select_and_load(const Registry& registry, const std::vector<Preset>& presets,
                                const Switches& command_line, const shader::ParamStore& values,
                                const std::optional<TextureLimits>& limits = {},
                                LoadedSelection loaded = {}, const GroundWords& ground = {});

}  // namespace relevo::effect
