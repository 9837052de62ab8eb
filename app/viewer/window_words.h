#pragma once

#include <string>
#include <string_view>

namespace relevo::viewer {

/// A message that names options of the command line, in words of the window: the field of the
/// import sheet instead of `--crs`, what to do instead of `--trust`. Other options stay.
std::string window_words(std::string_view message);

}  // namespace relevo::viewer
