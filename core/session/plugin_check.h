#pragma once

#include <functional>
#include <string>
#include <vector>

#include "effect/plugin_lint.h"

namespace relevo::session {

struct PluginCheckOptions {
    std::vector<std::string> paths;        ///< plugins to check, or folders of plugins
    std::vector<std::string> plugin_path;  ///< further ones that they need, as in scene::Effects
    std::string device = "auto";           ///< as session::Options
};

struct PluginCheckTotals {
    std::vector<std::string> checked;  ///< ids
    int errors = 0, warnings = 0;
};

/// Called with each mistake when it is found, each once.
using OnFinding = std::function<void(const effect::Finding&)>;
/// Called with the share that is done, 0 to 1.
using OnCheckProgress = std::function<void(double)>;

/// Finds mistakes in plugins. Reports those of the loader and of effect::lint(). Then draws the
/// bundled DEM with each plugin: alone, with the effects that are on by default, and with each
/// bundled effect of which either wants or requires a word that the other provides; from outside
/// and on the ground, by day and with the sun 10 degrees below the horizon. Programs with the other
/// bundled effects, whose functions are those of the plugin and theirs, are only stitched. Reports
/// what the stitcher and the driver reject, and pixels that are NaN or infinite. A plugin is drawn
/// up to the first selection that does not compile.
/// @throws Error (BadInput) for a path without a plugin; (NoDevice) as Session
PluginCheckTotals check_plugins(const PluginCheckOptions& options, const OnFinding& on_finding,
                                const OnCheckProgress& on_progress);

}  // namespace relevo::session
