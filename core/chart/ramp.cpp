#include "chart/ramp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/text.h"

namespace relevo::chart {
namespace {

constexpr std::string_view kWho = "--overlay-colours";

struct Named {
    std::string_view name;
    std::vector<Color> colors;  // at equal distances
};

/// viridis and inferno: S. van der Walt and N. Smith for matplotlib, in the public domain (CC0).
const std::vector<Named>& built_in() {
    static const std::vector<Named> ramps = {
        // Hours in the sun: from a cold valley to a warm terrace.
        {"sun",
         {{0x1f2a50},
          {0x3c3f7a},
          {0x6d4c90},
          {0xa35a8c},
          {0xd5706f},
          {0xf39a4f},
          {0xfccb57},
          {0xfdf3a8}}},
        // What is lit stays as it is.
        {"shade", {{0x14224d, 0.62}, {0x14224d, 0}}},
        {"steel", {{0x10151f}, {0x35455c}, {0x6d86a3}, {0xb0c6d8}, {0xf4f8fa}}},
        {"viridis",
         {{0x440154},
          {0x472d7b},
          {0x3b528b},
          {0x2c728e},
          {0x21918c},
          {0x28ae80},
          {0x5ec962},
          {0xaddc30},
          {0xfde725}}},
        {"inferno",
         {{0x000004},
          {0x1b0c41},
          {0x4a0c6b},
          {0x781c6d},
          {0xa52c60},
          {0xcf4446},
          {0xed6925},
          {0xfb9b06},
          {0xf7d13d},
          {0xfcffa4}}},
        {"grey", {{0x000000}, {0xffffff}}},
    };
    return ramps;
}

struct NamedColor {
    std::string_view name;
    std::uint32_t rgb;
};

/// GDAL's.
constexpr std::array<NamedColor, 17> kColors{{{"white", 0xffffff},
                                              {"black", 0x000000},
                                              {"red", 0xff0000},
                                              {"green", 0x00ff00},
                                              {"blue", 0x0000ff},
                                              {"yellow", 0xffff00},
                                              {"magenta", 0xff00ff},
                                              {"cyan", 0x00ffff},
                                              {"aqua", 0x00bfff},
                                              {"grey", 0xbfbfbf},
                                              {"gray", 0xbfbfbf},
                                              {"orange", 0xff7f00},
                                              {"brown", 0xbf7f3f},
                                              {"purple", 0x7f00ff},
                                              {"violet", 0x7f00ff},
                                              {"indigo", 0x007fff},
                                              {"teal", 0x008080}}};

/// A line of a colour file.
class Line {
  public:
    Line(const std::string& path, int number, std::vector<std::string> words)
        : path_(path), number_(number), words_(std::move(words)) {}

    [[noreturn]] void fail(const std::string& what) const {
        bad_input(fmt::format("{}: {}: line {}: {}", kWho, printable(path_), number_, what));
    }

    bool is_none() const { return lower(words_[0]) == "nv"; }

    double value(double from, double to) const {
        std::string text = words_[0];
        const bool share = text.back() == '%';
        if (share) text.pop_back();
        const std::optional<double> number = parse_number(text);
        if (!number) fail("expected a value, a share such as 40%, or nv");
        return share ? from + *number / 100 * (to - from) : *number;
    }

    Color color() const {
        const std::span<const std::string> rest = std::span(words_).subspan(1);
        if (rest.size() == 1)
            for (const NamedColor& named : kColors)
                if (lower(rest[0]) == named.name) return {named.rgb};
        std::array<double, 4> parts{0, 0, 0, 255};
        bool good = rest.size() == 3 || rest.size() == 4;
        for (std::size_t k = 0; good && k < rest.size(); ++k) {
            const std::optional<double> part = parse_number(rest[k]);
            good = part && *part >= 0 && *part <= 255;
            if (good) parts[k] = *part;
        }
        if (!good)
            fail(
                "expected red, green and blue from 0 to 255, perhaps an alpha, or a colour's name");
        std::uint32_t rgb = 0;
        for (std::size_t k = 0; k < 3; ++k)
            rgb = rgb << 8 | static_cast<std::uint32_t>(std::lround(parts[k]));
        return {rgb, parts[3] / 255};
    }

  private:
    const std::string& path_;
    int number_;
    std::vector<std::string> words_;
};

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    std::string word;
    for (const char c : std::string(line) + ' ') {
        if (std::string_view(" \t\r,:").find(c) == std::string_view::npos) {
            word += c;
        } else if (!word.empty()) {
            words.push_back(std::move(word));
            word.clear();
        }
    }
    return words;
}

}  // namespace

Color Ramp::at(double value) const {
    if (std::isnan(value)) return none.value_or(Color{0, 0});
    const auto next = std::upper_bound(stops.begin(), stops.end(), value,
                                       [](double v, const Stop& stop) { return v < stop.value; });
    if (next == stops.begin()) return stops.front().color;
    const Stop& before = *(next - 1);
    if (next == stops.end() || !continuous) return before.color;
    return mixed(before.color, next->color, (value - before.value) / (next->value - before.value));
}

std::vector<std::string> ramp_names() {
    std::vector<std::string> names;
    for (const Named& ramp : built_in())
        names.emplace_back(ramp.name);
    return names;
}

Ramp named_ramp(std::string_view name, double from, double to) {
    if (!(to > from))
        bad_input(fmt::format("{}: {} to {}: expected an end over the beginning", kWho, from, to));
    for (const Named& ramp : built_in()) {
        if (ramp.name != name) continue;
        Ramp result;
        const double step = (to - from) / static_cast<double>(ramp.colors.size() - 1);
        for (std::size_t k = 0; k < ramp.colors.size(); ++k)
            result.stops.push_back({from + static_cast<double>(k) * step, ramp.colors[k]});
        return result;
    }
    bad_input(
        fmt::format("{}: {}: expected {} or a colour file of GDAL's with a slash or a dot in "
                    "its name",
                    kWho, printable(std::string(name)), fmt::join(ramp_names(), ", ")));
}

Ramp read_ramp(const std::string& path, double from, double to) {
    std::istringstream lines(read_text(path, kWho));
    Ramp ramp;
    std::string text;
    for (int number = 1; std::getline(lines, text); ++number) {
        std::vector<std::string> words = words_of(text);
        if (words.empty() || words[0][0] == '#') continue;
        const Line line(path, number, std::move(words));
        if (line.is_none())
            ramp.none = line.color();
        else
            ramp.stops.push_back({line.value(from, to), line.color()});
    }
    if (ramp.stops.empty())
        bad_input(fmt::format("{}: {}: expected lines of a value and a colour but got none", kWho,
                              printable(path)));
    std::ranges::stable_sort(
        ramp.stops, [](const Ramp::Stop& a, const Ramp::Stop& b) { return a.value < b.value; });
    return ramp;
}

}  // namespace relevo::chart
