#include "dem/csv.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"

namespace relevo::dem {
namespace {

/// Size of the unpacked text modulo 2^32, from the last four bytes of a gzip file (RFC 1952). GDAL
/// reads a truncated file without an error.
std::uint64_t unpacked_size(const InputFile& file) {
    std::array<unsigned char, 4> bytes{};
    const auto at = static_cast<off_t>(file.size()) - off_t{bytes.size()};
    if (at < 0 || pread(file.descriptor(), bytes.data(), bytes.size(), at) != bytes.size())
        return ~std::uint64_t{0};
    return bytes[0] | std::uint64_t{bytes[1]} << 8 | std::uint64_t{bytes[2]} << 16 |
           std::uint64_t{bytes[3]} << 24;
}

}  // namespace

void FileErrors::refuse(std::string_view what) const {
    bad_input(fmt::format("{}: {}: {}", who, path, what));
}

void FileErrors::refuse(std::size_t line, std::string_view what) const {
    bad_input(fmt::format("{}: {}: line {}: {}", who, path, line, what));
}

std::string read_packed_text(const FileErrors& errors, std::uint64_t most) {
    const AllowedName name(errors.path);
    const InputFile file(name, errors.who);  // says why it cannot be read
    const bool packed = lower(errors.path).ends_with(".gz");
    std::string text;
    if (packed) {
        prepare_gdal();
        const GdalMessages messages;
        text = read_vsi(name.derived("/vsigzip/" + errors.path), most + 1);
        if (text.size() % (std::uint64_t{1} << 32) != unpacked_size(file))
            errors.refuse("damaged, or several gzip files in one; unpack it");
    } else {
        text.resize(std::min(file.size(), most + 1));
        InputStream stream = input_stream(name);
        stream.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(stream.gcount()));
    }
    if (text.empty()) errors.refuse("an empty file");
    if (text.size() > most)
        errors.refuse(fmt::format("more than {} MiB; split the file", most >> 20));
    if (text.find('\0') != text.npos) errors.refuse("not a text");
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    return text;
}

std::vector<std::string> csv_fields(std::string_view line, char separator) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == separator && !quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    for (std::string& field : fields)
        field = std::string(trimmed(field));
    return fields;
}

std::string csv_field(const std::vector<std::string>& fields,
                      const std::optional<std::size_t>& column) {
    return column && *column < fields.size() ? fields[*column] : std::string();
}

CsvHeader::CsvHeader(std::string_view line, const FileErrors& errors) : errors_(errors) {
    for (const char candidate : {',', ';', '\t'})
        if (std::ranges::count(line, candidate) > std::ranges::count(line, separator_))
            separator_ = candidate;
    names_ = csv_fields(line, separator_);
}

std::optional<std::size_t> CsvHeader::find(std::initializer_list<std::string_view> words) const {
    for (const std::string_view word : words)
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (equal_ignoring_case(names_[i], word)) return i;
    return std::nullopt;
}

std::vector<std::string> CsvHeader::fields(std::string_view line, std::size_t number) const {
    std::vector<std::string> fields = csv_fields(line, separator_);
    while (fields.size() > names_.size() && fields.back().empty())
        fields.pop_back();
    if (fields.size() > names_.size())
        errors_.refuse(number,
                       fmt::format("{} fields, but the first line names {} columns; write decimal "
                                   "points, and names with a '{}' in quotes",
                                   fields.size(), names_.size(), separator_));
    return fields;
}

}  // namespace relevo::dem
