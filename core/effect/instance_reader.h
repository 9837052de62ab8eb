#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "effect/manifest.h"
#include "json/object_reader.h"
#include "shader/instance_set.h"

namespace relevo::effect {

/// Finds a file that a manifest's key names. @throws Error (BadInput) without one
using FileOfKey = std::function<std::filesystem::path(
    const json::ObjectReader& object, const std::string& key, const std::string& name)>;

/// Reads an entry of "instances" in plugin.json.
/// @param object  the entry
/// @param id      of the plugin
/// @throws Error (BadInput) `plugin: folder/plugin.json:line: ...`
shader::InstanceSet read_instance_set(json::ObjectReader& object, const std::string& id,
                                      const std::string& name, const FileOfKey& file_of);

/// The meshes of all sets of instances.
std::vector<std::filesystem::path> mesh_files(const Manifest& manifest);

}  // namespace relevo::effect
