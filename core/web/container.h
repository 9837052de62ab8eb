#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The file of a web page's data: docs/web.md.
namespace relevo::web {

inline constexpr std::uint32_t kVersion = 1;

/// A part of the file.
struct Block {
    std::string name;      ///< "heights"
    std::string coding;    ///< "deflate", "jpeg" or "raw"
    std::size_t size = 0;  ///< bytes before deflating; else those that are stored
    std::vector<std::byte> stored{};
};

/// Deflates bytes, in the format of zlib.
Block deflated(std::string name, std::span<const std::byte> bytes);
/// Bytes that are compressed already, or need not be.
Block as_is(std::string name, std::string coding, std::vector<std::byte> bytes);

/// The whole file.
/// @param about   a JSON object, which gets the table of blocks. No `<` is in the file's JSON: it
///     is written as an escape, so that a name cannot end a script of a page
/// @param blocks  in their order in the file
std::vector<std::byte> container(const std::string& about, std::span<const Block> blocks);

}  // namespace relevo::web
