#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Text files of other people: what they have in common.
namespace relevo::dem {

/// What errors of a file begin with.
struct FileErrors {
    const std::string& path;
    std::string_view who;

    /// @throws Error (BadInput) `who: path: what`
    [[noreturn]] void refuse(std::string_view what) const;
    /// @throws Error (BadInput) `who: path: line n: what`
    [[noreturn]] void refuse(std::size_t line, std::string_view what) const;
};

/// The whole of a text file, unpacked where its name ends in .gz, without a mark of UTF-8.
/// @param most  bytes of the text
/// @throws Error (BadInput) where it cannot be read, is empty, longer, or not a text
std::string read_packed_text(const FileErrors& errors, std::uint64_t most);

/// The fields of a line; those in quotes without them.
std::vector<std::string> csv_fields(std::string_view line, char separator);

/// One of a line's fields; empty where the line or the file has none.
std::string csv_field(const std::vector<std::string>& fields,
                      const std::optional<std::size_t>& column);

/// The names of a CSV's columns, in its first line: separated by commas, semicolons or tabs.
class CsvHeader {
  public:
    CsvHeader(std::string_view line, const FileErrors& errors);

    /// The first column that has one of the names, in any case.
    std::optional<std::size_t> find(std::initializer_list<std::string_view> words) const;
    /// @throws Error (BadInput) for more fields than columns: a decimal comma separates a number
    std::vector<std::string> fields(std::string_view line, std::size_t number) const;

  private:
    FileErrors errors_;
    char separator_ = ',';
    std::vector<std::string> names_;
};

}  // namespace relevo::dem
