#pragma once

#include <string>
#include <string_view>

namespace relevo {

/// A path as a URI has it (RFC 3986, section 2): all bytes as "%20" but letters and digits of
/// ASCII, '-', '.', '_', '~' and '/'.
std::string percent_encoded(std::string_view path);

/// The reverse: "%20" becomes a blank. A '%' without two hexadecimal digits stays.
std::string percent_decoded(std::string_view text);

}  // namespace relevo
