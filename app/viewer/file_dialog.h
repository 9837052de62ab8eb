#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

namespace relevo::viewer {

/// Asks for files with the desktop's own dialog (zenity or kdialog), on a thread of its own.
/// @returns none chosen: an empty list; nothing where there is no such program
std::optional<std::future<std::vector<std::string>>> ask_for_files();

}  // namespace relevo::viewer
