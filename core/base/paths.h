#pragma once

#include <filesystem>

namespace relevo {

/// Where the program's read-only files are: `../share/relevo` as seen from the program, in a build
/// tree and in an installation alike. `$RELEVO_SHARE` overrides it.
/// Holds `data/`, `plugins/` and `shaders/`.
std::filesystem::path share_dir();

/// Where the program's loadable modules are: `../lib/relevo` as seen from the program.
std::filesystem::path module_dir();

}  // namespace relevo
