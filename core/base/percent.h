#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relevo {

/// A path as a URI has it (RFC 3986, section 2): all bytes as "%20" but letters and digits of
/// ASCII, '-', '.', '_', '~' and '/'.
std::string percent_encoded(std::string_view path);

/// A URL as RFC 3986 allows it: what no URL has, a blank or '#' among it, as "%20"; the rest, and
/// so what is encoded already, stays.
std::string percent_encoded_url(std::string_view url);

/// The reverse: "%20" becomes a blank. A '%' without two hexadecimal digits stays.
std::string percent_decoded(std::string_view text);

/// The path of "file:///data/a.tif", "file://localhost/data/a.tif" or "file:/data/a.tif" (RFC
/// 8089), encoded as it is there; nullopt for other names, and for files of other computers.
std::optional<std::string_view> path_of_file_uri(std::string_view uri);

}  // namespace relevo
