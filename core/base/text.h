#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relevo {

/// Longer files are no texts that people write [bytes].
inline constexpr std::size_t kMaxTextBytes = std::size_t{16} << 20;

/// The whole of a text file, which must be a regular one.
/// @throws Error (BadInput) `who: path: cannot be read, reason`, and for one of more than
///         kMaxTextBytes
std::string read_text(const std::filesystem::path& path, std::string_view who);

/// Pieces between the separators, empty ones kept: "a,,b" gives "a", "", "b"; "" gives none.
std::vector<std::string> split(std::string_view text, char separator);

/// Without blanks, tabs and line ends at both sides.
std::string_view trimmed(std::string_view text);

/// In small letters; those beyond ASCII stay.
std::string lower(std::string_view text);

/// Whether two words differ by nothing but capital letters of ASCII.
bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Text for people to read on one line, a file's name above all: line breaks, other control
/// characters, noncharacters and bytes that are not UTF-8 as \n, \t, \x1b. A name cannot end a line
/// and go on as a message.
std::string printable(std::string_view text);

/// The same with line breaks and tabs as they are.
std::string printable_lines(std::string_view text);

/// A decimal number that fills the whole text ("1e-3", "-33.9"), whatever the locale; nothing else.
/// Infinities and NaN are not numbers here.
std::optional<double> parse_number(std::string_view text);

/// The candidate nearest to `word` by edit distance, if one is near enough to be worth suggesting.
std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates);

}  // namespace relevo
