#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

/// The text of a page.
namespace relevo::web {

/// Puts a page together from the files of share/relevo/web: style, scripts, data. It sends no
/// request and runs no other script (its content security policy has the hashes of both).
/// @param title  plain text
/// @param data   container()
/// @throws Error (Failed) where a file of the page is missing
std::string page(const std::string& title, std::span<const std::byte> data);

/// The same with data and the picture of link cards in files beside it, for a server. It sends a
/// request for the data.
struct Beside {
    std::string data, picture;  ///< names, which need no escape
};
std::string page(const std::string& title, const Beside& files);

/// Bytes of a page without data.
std::size_t page_overhead();
/// Bytes that data take in a page.
constexpr std::size_t bytes_in_page(std::size_t data) {
    return (data + 2) / 3 * 4;
}

}  // namespace relevo::web
