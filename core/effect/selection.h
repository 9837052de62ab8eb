#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "effect/preset.h"
#include "effect/registry.h"
#include "shader/param_store.h"
#include "shader/stitch.h"

namespace relevo::effect {

/// The effects that are on.
struct Selection {
    std::vector<const Effect*> effects;     ///< in calling order; they live in the registry
    std::vector<std::string> capabilities;  ///< that they provide, sorted
    std::vector<std::string> notices;       ///< effects that were also switched on or off, and why
    std::vector<std::string> warnings;      ///< effects that are off because something is broken
    /// Effects that the command line names and that are off because a requirement is not met: whole
    /// error messages.
    std::vector<std::string> refused;
    /// As shader::StitchInput::over_overlay.
    std::optional<std::vector<std::string>> over_overlay{};
    bool lit_overlay_is_over_all = true;

    bool has(std::string_view id) const;
    std::vector<const shader::Snippet*> snippets() const;
    std::vector<shader::PluginPass> passes() const;
    /// What the stitcher takes from the effects.
    shader::StitchInput stitch_input() const;
};

/// Effects that cannot be on, by id, and why.
using Unusable = std::map<std::string, std::string>;

/// Features of the DEM, of ground_words(). None: not known yet, all are assumed.
using GroundWords = std::optional<std::vector<std::string>>;

/// Decides which effects are on, and their calling order.
///
/// Effects with `enabled_by_default` are on, if the DEM has the features of their `default_where`.
/// Each preset, and then the command line, changes that: `only` replaces the list, `enable` adds to
/// it, `disable` removes from it. Effects that `only` and `enable` name switch on providers of
/// their requirements, except disabled ones. An effect whose requirement has no provider is off.
/// Order: after every provider of a word in `after`; ties by id. Effects in `order` are in that
/// order whatever their `after`.
///
/// Of two effects with the same `exclusive` word, the one that was requested last is on, the other
/// is off, with a notice. The order is defaults, presets, command line (of two defaults the first
/// by id is on).
///
/// An unknown plugin in a preset is a notice: deleting a plugin breaks no preset.
/// @param unusable  effects that cannot be on: they are off, with a warning, and so are effects
///                  that require them
/// @param ground    an effect that is on is a notice if the DEM lacks its feature
/// @throws Error (BadInput) for an id on the command line that is unknown, both on and off, or
/// twice
///         in `order`; one that `only` or `enable` name there and that cannot be on; a cycle of
///         `after`; two providers of an exclusive hook, or of an exclusive word if both were
///         requested at once
Selection select(const Registry& registry, const std::vector<Preset>& presets,
                 const Switches& command_line, const Unusable& unusable = {},
                 const GroundWords& ground = {});

/// Sets the values of presets, then those of the command line. Never switches an effect on.
/// @param store  with all parameters declared
/// @returns notices: values of unknown plugins in a preset, and values that the command line sets
///          for effects that are off
/// @throws Error (BadInput) for values that a parameter cannot have, and for unknown parameters (in
///         a preset only those of known plugins)
std::vector<std::string> apply_settings(shader::ParamStore& store, const Registry& registry,
                                        const Selection& selection,
                                        const std::vector<Preset>& presets,
                                        const std::vector<Setting>& command_line);

/// The same with absolute paths for parameters that are files.
std::vector<Setting> with_absolute_files(std::vector<Setting> settings,
                                         const shader::ParamStore& store);

}  // namespace relevo::effect
