#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "effect/preset.h"
#include "effect/registry.h"
#include "shader/param_store.h"

namespace relevo::effect {

/// The effects that are on.
struct Selection {
    std::vector<const Effect*> effects;     ///< in calling order; they live in the registry
    std::vector<std::string> capabilities;  ///< what they provide, sorted
    std::vector<std::string> notices;   ///< what was switched on or off beyond the asked, and why
    std::vector<std::string> warnings;  ///< what is off because something is broken, and why

    bool has(std::string_view id) const;
    std::vector<const shader::Snippet*> snippets() const;  ///< for shader::StitchInput
};

/// Effects that cannot be on, by id, and why.
using Unusable = std::map<std::string, std::string>;

/// What the DEM has, words of ground_words(). None: it is not known yet, and may have all.
using GroundWords = std::optional<std::vector<std::string>>;

/// Decides which effects are on, and in which order they are called.
///
/// On are those with `enabled_by_default` where the DEM has what their `default_where` says; each
/// preset, and then the command line, changes that: `only` puts its own list in its place, `enable`
/// adds, `disable` takes away. What `only` and `enable` name pulls in effects that provide what it
/// requires, except disabled ones. An effect whose requirement nobody provides goes off. Order:
/// behind every provider of a word in `after`; ties by id.
///
/// Of two that list a word as `exclusive`, the one that was asked for
/// last is on, the command line's after those of presets and those after the defaults (of two
/// defaults the first by id); the other goes off, with a notice.
///
/// What a preset names and is not there is a notice, so that deleting a plugin breaks no preset.
/// @param unusable  effects that cannot be on: they are off, with a warning, and so is what
///                  requires them
/// @param ground    an effect that is on although the DEM lacks what it is for is a notice
/// @throws Error (BadInput) for an id on the command line that is unknown, or both on and off; one
///         that `only` or `enable` name there and that cannot be on; a circle of `after`; two
///         providers of an exclusive hook, or of an exclusive word where both were asked for at
///         once
Selection select(const Registry& registry, const std::vector<Preset>& presets,
                 const Switches& command_line, const Unusable& unusable = {},
                 const GroundWords& ground = {});

/// Sets the values of presets, then those of the command line. Never switches an effect on.
/// @param store  has been told of all parameters there are
/// @returns notices: what a preset sets of plugins that are not there, and what the command line
///          sets of effects that are off
/// @throws Error (BadInput) for values that a parameter cannot have, and for unknown parameters: on
///         the command line all, in a preset those of plugins that are there
std::vector<std::string> apply_settings(shader::ParamStore& store, const Registry& registry,
                                        const Selection& selection,
                                        const std::vector<Preset>& presets,
                                        const std::vector<Setting>& command_line);

/// The same with absolute paths for parameters that are files, which then hold in any folder.
std::vector<Setting> with_absolute_files(std::vector<Setting> settings,
                                         const shader::ParamStore& store);

}  // namespace relevo::effect
