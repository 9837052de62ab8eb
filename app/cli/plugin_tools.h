#pragma once

#include <string>
#include <vector>

#include "cli/verb.h"

namespace relevo::cli {

/// Adds new, check and test to `relevo plugins`.
/// @param plugin_path  of --plugin-path; must outlive the verb
void add_plugin_tools(Verb plugins, const std::vector<std::string>& plugin_path);

}  // namespace relevo::cli
