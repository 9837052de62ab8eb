#pragma once

#include <optional>
#include <vector>

#include "effect/native_module.h"
#include "effect/selection.h"
#include "effect/texture_files.h"

namespace relevo::effect {

/// A selection with the textures and modules of its effects.
struct LoadedSelection {
    Selection selection;
    std::vector<NativeModule> modules;    ///< in the selection's order
    std::vector<LoadedTexture> textures;  ///< in the selection's order
    Unusable unusable;                    ///< wanted effects that cannot be on
};

/// Selects as select() does, and loads textures and modules. An effect whose files cannot be used
/// is off, with a warning, and so are effects that require it.
/// @param values  of all parameters, for the modules' trial
/// @param limits  of the device, if it is known
/// @param loaded  an earlier selection, whose files are not loaded and tried again
/// @throws Error as select()
LoadedSelection select_and_load(const Registry& registry, const std::vector<Preset>& presets,
                                const Switches& command_line, const shader::ParamStore& values,
                                const std::optional<TextureLimits>& limits = {},
                                LoadedSelection loaded = {}, const GroundWords& ground = {});

}  // namespace relevo::effect
