// Land cover of known places, and how it is shared out over a DEM.
#include <chrono>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "base/units.h"
#include "climate/cover.h"
#include "climate/land_classes.h"
#include "support/support.h"

namespace relevo::climate::test_land_map {
namespace {

constexpr std::array<const char*, kLands> kNames{"needle", "broad", "shrub",   "grass", "crop",
                                                 "bare",   "urban", "wetland", "ice"};

struct Known {
    std::string name, kind, expected;
    double lat = 0, lon = 0;
};

std::vector<Known> known_places() {
    std::vector<Known> places;
    const test::Csv csv = test::read_csv(test::source_dir() / "tests/data/climate/land.csv");
    for (const std::vector<std::string>& row : csv.rows) {
        const auto text = [&](const char* column) { return row[csv.column(column)]; };
        places.push_back({text("name"), text("kind"), text("expected"),
                          parse_number(text("lat")).value(), parse_number(text("lon")).value()});
    }
    return places;
}

Box around(double lat, double lon, double half_deg) {
    return {lon - half_deg, lon + half_deg, lat - half_deg, lat + half_deg};
}

/// Linear sRGB of MODIS' bands 1, 4 and 3: straight lines through 470, 555 and 645 nm.
Colour of_modis(const std::string& text) {
    const std::vector<std::string> words = split(text, ' ');
    std::array<float, 3> b{};
    for (std::size_t i = 0; i < 3; ++i)
        b[i] = static_cast<float>(parse_number(words[i]).value());
    return {.804F * b[0] + .355F * b[1] - .159F * b[2], .028F * b[0] + .785F * b[1] + .187F * b[2],
            -.019F * b[0] - .051F * b[1] + 1.071F * b[2]};
}

/// What a colour may be called.
std::string names_of(const Colour& c) {
    const float light = .2126F * c[0] + .7152F * c[1] + .0722F * c[2], ratio = c[0] / c[1];
    std::string names;
    if (light < .075F) names += "dark ";
    if (light > .25F) names += "bright ";
    if (c[1] > c[0] * .98F && c[1] > 1.1F * c[2]) names += "green ";
    if (ratio > 1.45F) names += "red ";
    if (ratio > 1 && ratio <= 1.45F) names += "brown ";
    if (ratio > 1.1F && light > .12F) names += "tan ";
    if (std::max({c[0], c[1], c[2]}) < 1.35F * std::min({c[0], c[1], c[2]})) names += "grey ";
    return names;
}

bool has_any(const std::string& names, const std::string& wanted) {
    for (const std::string& one : split(wanted, '|'))
        if (names.find(one) != std::string::npos) return true;
    return false;
}

TEST(LandMap, KnowsKnownPlaces) {
    const ClimateMap climate = ClimateMap::shipped();
    std::map<std::string, std::pair<int, int>> right;
    for (const Known& place : known_places()) {
        const LandMap map(climate, around(place.lat, place.lon, 0.02));
        std::string got;
        bool hit = false;
        if (place.kind == "class") {
            const LandShares shares = map.shares(place.lat, place.lon);
            got = kNames[static_cast<std::size_t>(std::ranges::max_element(shares) -
                                                  shares.begin())];
            hit = has_any(got, place.expected);
        } else {
            const Colour ground = map.ground(place.lat, place.lon).value_or(Colour{});
            got = fmt::format("{:.3f} {:.3f} {:.3f}, {}", ground[0], ground[1], ground[2],
                              names_of(ground));
            hit = has_any(got, place.expected);
            if (place.kind == "rgb") {
                const Colour wanted = of_modis(place.expected);
                float off = 0;
                for (std::size_t i = 0; i < 3; ++i)
                    off += std::abs(std::log(ground[i] / wanted[i])) / 3;
                hit = off < 0.35F;
            }
        }
        if (!hit)
            fmt::print("[ land ] {}, {}: expected {}, got {}\n", place.kind, place.name,
                       place.expected, got);
        right[place.kind].first += hit ? 1 : 0;
        right[place.kind].second += 1;
    }
    for (const auto& [kind, count] : right)
        fmt::print("[ land ] {}: {} of {}\n", kind, count.first, count.second);
    EXPECT_EQ(right["class"].second, 132);
    EXPECT_GE(right["class"].first, 126);
    EXPECT_GE(right["hue"].first, 27);
    EXPECT_GE(right["rgb"].first, 6);
}

}  // namespace
}  // namespace relevo::climate::test_land_map
