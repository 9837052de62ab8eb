#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace relevo {

/// SHA-256 of a file's bytes, 64 hexadecimal digits, as `sha256sum` prints them.
/// @throws Error (BadInput) `who: path: cannot be read, reason`
std::string sha256_of_file(const std::filesystem::path& path, std::string_view who);

/// The same of a text. @throws Error (Failed) if OpenSSL has no SHA-256
std::string sha256_of_text(std::string_view text);

}  // namespace relevo
