#include "climate/land_cover.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"

namespace relevo::climate {
namespace {

constexpr std::uint32_t kIsKnown = 0xFF000000;

/// Shares of a class as a texel; nullopt: not three of them, or more than the ground.
std::optional<std::uint32_t> texel_of(std::span<const std::string> words) {
    if (std::ranges::all_of(words, [](const std::string& word) { return trimmed(word) == "?"; }))
        return 0;
    std::uint32_t texel = kIsKnown;
    double sum = 0;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const std::optional<double> share = parse_number(trimmed(words[k]));
        if (!share || *share < 0) return std::nullopt;
        sum += *share;
        if (sum > 1.001) return std::nullopt;
        texel |= static_cast<std::uint32_t>(std::lround(255 * *share)) << 8 * k;
    }
    return texel;
}

}  // namespace

LandCoverTable LandCoverTable::read(const std::filesystem::path& file) {
    LandCoverTable table;
    int number = 0;
    for (const std::string& line : split(read_text(file, "land cover"), '\n')) {
        ++number;
        const std::string_view text = trimmed(line);
        if (text.empty() || text[0] == '#') continue;
        const std::vector<std::string> words = split(text, ',');
        const std::optional<double> id =
            words.size() >= 4 ? parse_number(trimmed(words[0])) : std::nullopt;
        const std::optional<std::uint32_t> texel =
            id ? texel_of(std::span(words).subspan(1, 3)) : std::nullopt;
        if (!texel || !(*id >= 0 && *id <= 255) || std::floor(*id) != *id)
            bad_input(fmt::format(
                "land cover: {}:{}: expected CLASS,TREES,PLANTS,ICE: a class from 0 to 255, and "
                "shares of at most 1 together or three ?",
                printable(file.string()), number));
        const auto at = static_cast<std::size_t>(*id);
        if (table.classes_.test(at))
            bad_input(fmt::format("land cover: {}:{}: class {} is there twice",
                                  printable(file.string()), number, at));
        table.classes_.set(at);
        table.texels_[at] = *texel;
    }
    if (table.classes_.none())
        bad_input(fmt::format("land cover: {}: has no classes", printable(file.string())));
    return table;
}

const std::vector<std::string>& LandCoverTable::names() {
    static const std::vector<std::string> names{"worldcover", "nlcd", "corine"};
    return names;
}

LandCoverTable LandCoverTable::named(const std::string& name) {
    if (!contains(names(), name))
        bad_input(
            fmt::format("land cover: no classes named \"{}\"; expected {}, or a file, whose name "
                        "has a dot or a slash",
                        printable(name), fmt::join(names(), ", ")));
    return read(share_dir() / "data/land_cover" / (name + ".csv"));
}

std::vector<std::string> LandCoverTable::fitting(const Classes& in_map) {
    std::vector<std::string> fitting;
    for (const std::string& name : names())
        if ((in_map & ~named(name).classes()).none()) fitting.push_back(name);
    return fitting;
}

std::string text_of(const Classes& classes, int most) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < classes.size(); ++at) {
        if (!classes.test(at)) continue;
        if (std::ssize(words) == most) {
            words.emplace_back("...");
            break;
        }
        words.push_back(std::to_string(at));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace relevo::climate
