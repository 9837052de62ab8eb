#include "effect/table_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "base/error.h"
#include "base/text.h"

namespace relevo::effect {
namespace {

constexpr int kMaxCubeSide = 128;

/// Lines of a file with their words.
class Lines {
  public:
    explicit Lines(const std::filesystem::path& file)
        : file_(file.string()), text_(read_text(file, "plugin")) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text_.starts_with(kByteOrderMark)) text_.erase(0, kByteOrderMark.size());
    }

    /// Moves to the next line that has words and is no comment. @returns false at the end
    bool next() {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            const std::string_view line = std::string_view(text_).substr(at_, end - at_);
            at_ = end + 1;
            ++number_;
            words_.clear();
            std::size_t first = 0;
            // Between semicolons a comma is part of a number, which then is none.
            const std::string_view parts = line.find(';') == line.npos ? ", \t\r" : "; \t\r";
            while ((first = line.find_first_not_of(parts, first)) != line.npos) {
                const std::size_t last = std::min(line.find_first_of(parts, first), line.size());
                words_.push_back(line.substr(first, last - first));
                first = last;
            }
            if (!words_.empty() && words_[0][0] != '#') return true;
        }
        return false;
    }

    const std::vector<std::string_view>& words() const { return words_; }

    float number(std::string_view word) const {
        const std::optional<double> value = parse_number(word);
        if (!value || !std::isfinite(static_cast<float>(*value))) fail("expected numbers");
        return static_cast<float>(*value);
    }

    [[noreturn]] void fail(const std::string& what) const {
        bad_input(fmt::format("plugin: {}:{}: {}", file_, number_, what));
    }

  private:
    std::string file_, text_;
    std::size_t at_ = 0;
    int number_ = 0;
    std::vector<std::string_view> words_;
};

image::TextureData texture_of(PixelFormat format, glm::ivec3 size,
                              const std::vector<float>& values) {
    image::TextureData data(format, size.x, size.y, size.z, 1, 1);
    std::memcpy(data.writable_level(0).data(), values.data(), values.size() * sizeof(float));
    return data;
}

void add_colour(std::vector<float>& values, float red, float green, float blue) {
    values.insert(values.end(), {red, green, blue, 1.0F});
}

/// Reads a line of the head of a .cube file. @returns false if it is none
bool take_head(const Lines& lines, int& side) {
    const auto& words = lines.words();
    if (words[0] == "TITLE") return true;
    if (words[0] == "LUT_3D_SIZE") {
        const float given = words.size() == 2 ? lines.number(words[1]) : 0;
        if (!(given >= 2 && given <= kMaxCubeSide) || std::floor(given) != given)
            lines.fail(
                fmt::format("expected LUT_3D_SIZE and a whole number from 2 to {}", kMaxCubeSide));
        side = static_cast<int>(given);
        return true;
    }
    if (words[0] == "LUT_3D_INPUT_RANGE") {  // of some programs, for the domain
        if (words.size() != 3 || lines.number(words[1]) != 0.0F || lines.number(words[2]) != 1.0F)
            lines.fail("expected a domain from 0 to 1");
        return true;
    }
    const bool least = words[0] == "DOMAIN_MIN";
    if (least || words[0] == "DOMAIN_MAX") {
        for (std::size_t i = 1; i < words.size(); ++i)
            if (lines.number(words[i]) != (least ? 0.0F : 1.0F))
                lines.fail("expected a domain from 0 to 1");
        return true;
    }
    return false;
}

}  // namespace

image::TextureData read_table(const std::filesystem::path& file) {
    if (file.empty()) return texture_of(PixelFormat::R32F, {1, 1, 1}, {0.0F});
    Lines lines(file);
    std::vector<float> values;
    std::size_t columns = 0;
    int rows = 0;
    bool has_heading = false;  // or the first line has been numbers
    while (lines.next()) {
        const auto is_number = [](std::string_view word) {
            return std::string_view("+-.0123456789").find(word[0]) != std::string_view::npos;
        };
        if (columns == 0 && !std::exchange(has_heading, true) &&
            std::ranges::none_of(lines.words(), is_number))
            continue;
        if (columns == 0) columns = lines.words().size();
        if (lines.words().size() != columns)
            lines.fail(fmt::format("expected {} numbers as before but got {}", columns,
                                   lines.words().size()));
        if (columns > kMaxTableSide || ++rows > kMaxTableSide)
            lines.fail(fmt::format("expected at most {} lines and columns", kMaxTableSide));
        for (const std::string_view word : lines.words())
            values.push_back(lines.number(word));
    }
    if (rows == 0) lines.fail("expected lines of numbers");
    return texture_of(PixelFormat::R32F, {static_cast<int>(columns), rows, 1}, values);
}

image::TextureData read_cube(const std::filesystem::path& file) {
    if (file.empty()) return texture_of(PixelFormat::RGBA32F, {1, 1, 1}, {0, 0, 0, 1});
    Lines lines(file);
    std::vector<float> values;
    int side = 0;
    const auto wanted = [&] {
        return 4 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side) *
               static_cast<std::size_t>(side);
    };
    while (lines.next()) {
        if (take_head(lines, side)) continue;
        const auto& words = lines.words();
        if (side == 0) lines.fail("expected LUT_3D_SIZE before the colours");
        if (words.size() != 3) lines.fail("expected red, green and blue");
        if (values.size() >= wanted())
            lines.fail(fmt::format("expected {} colours but there are more", wanted() / 4));
        add_colour(values, lines.number(words[0]), lines.number(words[1]), lines.number(words[2]));
    }
    if (side == 0) lines.fail("expected LUT_3D_SIZE and colours");
    if (values.size() != wanted())
        lines.fail(fmt::format("expected {} colours but got {}", wanted() / 4, values.size() / 4));
    return texture_of(PixelFormat::RGBA32F, {side, side, side}, values);
}

}  // namespace relevo::effect
