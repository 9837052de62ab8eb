#pragma once

#include <string>
#include <vector>

#include "effect/registry.h"

namespace relevo::effect {

/// A mistake in a plugin.
struct Finding {
    bool is_error = false;  ///< else a warning: the plugin works, but probably not as meant
    std::string text;       ///< "plugins/dust/dust.glsl:7: what is wrong; what to do"
    bool operator==(const Finding&) const = default;
};

/// Mistakes that the files of a loaded plugin show: loops that may never end, parameters that no
/// hook reads, capability words that no installed plugin provides, and texture reads with
/// derivatives that are not there, and hooks that paint the ground in direct light alone.
/// @param registry  the installed plugins, and this one
std::vector<Finding> lint(const Effect& effect, const Registry& registry);

}  // namespace relevo::effect
