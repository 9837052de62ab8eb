#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include <GeographicLib/GeoCoords.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include "base/text.h"
#include "geo/format.h"

namespace relevo::geo {
namespace {

/// The parts of a text between blanks, commas and semicolons.
std::vector<std::string> words_of(std::string_view text) {
    std::string bare(text);
    std::ranges::replace_if(
        bare, [](unsigned char c) { return std::isspace(c) || c == ',' || c == ';'; }, ' ');
    std::vector<std::string> words = split(bare, ' ');
    std::erase(words, "");
    return words;
}

/// A zone of UTM with its hemisphere; 0 is UPS.
struct Zone {
    int number = 0;
    bool is_north = true;
};

/// "32N", "32S", "32T" with a latitude band; none for other words.
std::optional<Zone> zone_of(const std::string& word) {
    if (word.size() < 2 || word.size() > 3) return std::nullopt;
    const auto number = parse_number(word.substr(0, word.size() - 1));
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(word.back())));
    if (!number || *number < 1 || *number > 60 || !std::isalpha(static_cast<unsigned char>(letter)))
        return std::nullopt;
    return Zone{static_cast<int>(*number), letter != 'S' && letter >= 'N'};
}

/// "32N 683473 E 5255234 N" without its zone, "UPS N 2000000 E 2000000 N" without its pole.
std::optional<Geodetic> projected(const Zone& zone, const std::vector<std::string>& words,
                                  std::size_t first) {
    std::vector<double> metres;
    for (std::size_t i = first; i < words.size(); ++i) {
        if (const auto number = parse_number(words[i]))
            metres.push_back(*number);
        else if (words[i].size() > 1)
            return std::nullopt;
    }
    if (metres.size() != 2) return std::nullopt;
    double lat_deg = 0, lon_deg = 0;
    GeographicLib::UTMUPS::Reverse(zone.number, zone.is_north, metres[0], metres[1], lat_deg,
                                   lon_deg);
    return geodetic_deg(lat_deg, lon_deg);
}

/// "47:26:22N 11:53:37E" of "47 26 22 N 11 53 37 E", which GeographicLib reads.
std::string joined(const std::vector<std::string>& words) {
    const bool has_letters = std::ranges::any_of(words, [](const std::string& word) {
        return word.size() == 1 && std::string_view("NSEWnsew").find(word[0]) != std::string::npos;
    });
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_number = parse_number(words[i]).has_value();
        const bool follows_number = i > 0 && parse_number(words[i - 1]).has_value();
        if (i > 0 && !(has_letters && follows_number)) text += ' ';
        if (has_letters && follows_number && is_number) text += ':';
        text += words[i];
    }
    return text;
}

std::optional<Geodetic> read(const std::vector<std::string>& words) {
    if (const auto zone = zone_of(words.front()); zone && words.size() > 2)
        if (const auto place = projected(*zone, words, 1)) return place;
    if (words.size() > 3 && lower(words[0]) == "ups")
        return projected({0, lower(words[1]) == "n"}, words, 2);
    std::string text = joined(words);
    // A square of MGRS is written with and without blanks.
    if (zone_of(words.front())) std::erase(text, ' ');
    const GeographicLib::GeoCoords coords(text, /*centerp=*/false);
    if (std::isnan(coords.Latitude() + coords.Longitude())) return std::nullopt;
    return geodetic_deg(coords.Latitude(), coords.Longitude());
}

}  // namespace

std::optional<Geodetic> find_coordinates(std::string_view text) {
    const std::vector<std::string> words = words_of(text);
    if (words.empty()) return std::nullopt;
    try {
        return read(words);
    } catch (const GeographicLib::GeographicErr&) {
        return std::nullopt;
    }
}

}  // namespace relevo::geo
