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

/// Bytes of data that a page of so many bytes has room for; below 0 where it has none.
double room_for_data(double page_bytes);

}  // namespace relevo::web
