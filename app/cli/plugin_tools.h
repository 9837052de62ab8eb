#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace relevo::cli {

/// Adds new, check and test to `relevo plugins`.
/// @param plugin_path  of --plugin-path; must outlive the verb
void add_plugin_tools(CLI::App& plugins, const std::vector<std::string>& plugin_path);

}  // namespace relevo::cli
