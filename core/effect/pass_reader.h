#pragma once

#include <string>
#include <vector>

#include "json/object_reader.h"
#include "shader/plugin_pass.h"

namespace relevo::effect {

/// Reads an entry of "passes" in plugin.json.
/// @param object  the entry
/// @param id      of the plugin
/// @throws Error (BadInput) `plugin: folder/plugin.json:line: ...`
shader::PluginPass read_pass(json::ObjectReader& object, const std::string& id,
                             const std::string& name);

/// Finds what the passes with an `over_name` have their invocations over, and checks the sum of
/// all.
/// @param object  plugin.json
/// @throws Error (BadInput) as read_pass()
void complete_passes(const json::ObjectReader& object, std::vector<shader::PluginPass>& passes);

}  // namespace relevo::effect
