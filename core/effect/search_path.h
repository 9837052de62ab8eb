#pragma once

#include <filesystem>
#include <vector>

namespace relevo::effect {

/// The user's own plugin folders: `$XDG_DATA_HOME/relevo/plugins` (by default
/// `~/.local/share/relevo/plugins`) if it exists, then those of `RELEVO_PLUGIN_PATH`, which are
/// absolute and separated by colons. The user chose them, so their native modules may be loaded.
/// @throws Error (BadInput) for a folder of `RELEVO_PLUGIN_PATH` that is relative or does not exist
std::vector<std::filesystem::path> user_plugin_folders();

/// All folders that are searched for plugins, in this order: the bundled plugins, the user's own
/// folders, then `extra` (--plugin-path).
/// @throws Error as user_plugin_folders()
std::vector<std::filesystem::path> plugin_search_path(
    const std::vector<std::filesystem::path>& extra);

}  // namespace relevo::effect
