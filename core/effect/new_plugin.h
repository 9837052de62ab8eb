#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "effect/registry.h"

namespace relevo::effect {

/// A plugin to write.
struct NewPlugin {
    std::string id;
    bool native = false;   ///< with the source of a module
    std::string copied{};  ///< id of an installed effect to copy; empty: a template
};

/// The files of a new plugin: names and contents.
using PluginFiles = std::vector<std::pair<std::string, std::string>>;

/// Writes a plugin into the new folder `into / id`.
/// @param registry  the installed effects
/// @returns the files
/// @throws Error (BadInput) for an invalid id and one that is taken, for an effect that cannot be
/// copied,
///         and if the folder exists or cannot be written. Then nothing is left of it
std::vector<std::filesystem::path> write_new_plugin(const NewPlugin& plugin,
                                                    const std::filesystem::path& into,
                                                    const Registry& registry);

/// The files of a copy of an effect without native module, off by default. Its globals, parameters
/// and files are named after the new id.
PluginFiles copied_plugin(const std::string& id, const Effect& effect);

/// Its name for users: "Dust" for the id "dust".
std::string name_of(std::string id);

/// How to use a plugin, as a section of its README.md.
std::string usage_section(const std::string& id, bool is_on);

}  // namespace relevo::effect
