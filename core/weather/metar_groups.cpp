#include "weather/metar_groups.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

namespace relevo::weather::groups {
namespace {

constexpr double kKnot_m_s = 1852.0 / 3600;
constexpr double kFoot_m = 0.3048;
constexpr double kMile_m = 1609.344;
constexpr double kInchOfMercury_hpa = 33.8639;
constexpr double kUnlimited_m = 10000;  // 9999 and CAVOK are this or more

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool all_digits(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, is_digit);
}

bool all_slashes(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c == '/'; });
}

/// Of at most 6 digits.
int whole(std::string_view digits) {
    int value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

/// Takes a prefix off. @returns whether it was there
bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return false;
    text.remove_prefix(prefix.size());
    return true;
}

/// The digits that a text begins with, taken off it.
std::string_view take_digits(std::string_view& text) {
    const auto end = std::ranges::find_if_not(text, is_digit);
    const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    text.remove_prefix(digits.size());
    return digits;
}

/// "1/2", "3/4", "6", "10" as a number of miles.
std::optional<double> miles(std::string_view text) {
    const std::string_view above = take_digits(text);
    if (above.empty() || above.size() > 3) return std::nullopt;
    if (text.empty()) return whole(above);
    if (!take(text, "/") || !all_digits(text) || text.size() > 2 || whole(text) == 0)
        return std::nullopt;
    return static_cast<double>(whole(above)) / whole(text);
}

/// "17", "M05"; none for anything else.
std::optional<double> celsius(std::string_view text) {
    const bool below = take(text, "M");
    if (text.size() != 2 || !all_digits(text)) return std::nullopt;
    return below ? -whole(text) : whole(text);
}

}  // namespace

bool archive_date(std::string_view word) {
    if (word.ends_with('Z')) word.remove_suffix(1);
    std::string shape(word);
    std::ranges::replace_if(shape, is_digit, '0');
    static constexpr std::array<std::string_view, 9> kShapes = {
        "0000-00-00",   "0000/00/00",          "00:00",    "00:00:00",  "0000-00-00T00:00",
        "000000000000", "0000-00-00T00:00:00", "00000000", "0000000000"};
    return std::ranges::find(kShapes, shape) != kShapes.end();
}

bool time(std::string_view group, Metar& to) {
    if (group.size() != 7 || group.back() != 'Z' || !all_digits(group.substr(0, 6))) return false;
    to.day = whole(group.substr(0, 2));
    to.hour = whole(group.substr(2, 2));
    to.minute = whole(group.substr(4, 2));
    if (to.day < 1 || to.day > 31 || to.hour > 23 || to.minute > 59)
        throw Impossible{"expected a day of 01 to 31, an hour to 23 and a minute to 59"};
    return true;
}

bool wind(std::string_view group, Metar& to) {
    double unit_m_s = kKnot_m_s;
    if (group.ends_with("KT")) {
        group.remove_suffix(2);
    } else if (group.ends_with("MPS")) {
        group.remove_suffix(3);
        unit_m_s = 1;
    } else if (group.ends_with("KMH")) {
        group.remove_suffix(3);
        unit_m_s = 1 / 3.6;
    } else {
        return false;
    }
    if (all_slashes(group)) return true;  // not measured
    std::optional<double> from_deg;
    if (!take(group, "VRB") && !take(group, "///")) {
        if (!group.starts_with("ABV")) {
            if (group.size() < 5 || !all_digits(group.substr(0, 3))) return false;
            from_deg = whole(group.substr(0, 3));
            group.remove_prefix(3);
        }
    }
    if (group == "//") return true;
    if (!take(group, "ABV")) take(group, "P");  // more than
    const std::string_view speed = take_digits(group);
    std::string_view gust;
    if (take(group, "G")) {
        take(group, "P");
        gust = take_digits(group);
    }
    if (speed.size() < 2 || speed.size() > 3 || gust.size() > 3 || !group.empty()) return false;
    if (from_deg && *from_deg > 360) throw Impossible{"expected a direction of 000 to 360 degrees"};
    to.wind_m_s = whole(speed) * unit_m_s;
    if (!gust.empty()) to.gust_m_s = whole(gust) * unit_m_s;
    if (std::max(*to.wind_m_s, to.gust_m_s.value_or(0)) > 120)
        throw Impossible{"expected a wind of at most 120 m/s"};
    if (from_deg && *to.wind_m_s > 0) to.wind_from_deg = from_deg;
    return true;
}

bool visibility(std::string_view group, Metar& to) {
    if (group == "CAVOK") {
        to.visibility_m = kUnlimited_m;
        to.visibility_is_least = to.sky_is_clear = true;
        return true;
    }
    if (group == "////") return true;
    if (group.ends_with("SM")) {
        group.remove_suffix(2);
        if (all_slashes(group)) return true;
        to.visibility_is_least = take(group, "P");
        take(group, "M");  // less than
        const std::optional<double> found = miles(group);
        if (!found) return false;
        to.visibility_m = *found * kMile_m;
        to.visibility_is_least = to.visibility_is_least || *found >= 10;
        return true;
    }
    if (group.ends_with("KM")) {
        group.remove_suffix(2);
        const bool least = take(group, "P");
        if (!all_digits(group) || group.size() > 3) return false;
        to.visibility_is_least = least;
        to.visibility_m = whole(group) * 1000.0;
        return true;
    }
    if (group.ends_with("NDV")) group.remove_suffix(3);
    if (group.size() != 4 || !all_digits(group)) return false;
    to.visibility_is_least = group == "9999";
    to.visibility_m = to.visibility_is_least ? kUnlimited_m : whole(group);
    return true;
}

bool is_whole_miles(std::string_view group, std::string_view next) {
    return group.size() <= 2 && all_digits(group) && next.ends_with("SM") &&
           next.find('/') != std::string_view::npos;
}

bool present_weather(std::string_view group, Metar& to) {
    if (group == "//") return true;
    PresentWeather found;
    auto intensity = PresentWeather::Intensity::Moderate;
    if (take(group, "-")) intensity = PresentWeather::Intensity::Light;
    if (take(group, "+")) intensity = PresentWeather::Intensity::Heavy;
    const bool nearby = take(group, "VC");
    if (group.empty() || group.size() % 2 != 0 || group.size() > 8) return false;
    bool shallow = false, falls = false, blown = false;
    for (; !group.empty(); group.remove_prefix(2)) {
        const std::string_view word = group.substr(0, 2);
        // Descriptors and phenomena of WMO code table 4678.
        static constexpr std::array<std::string_view, 16> kOthers = {
            "BC", "PR", "SH", "FZ", "FU", "VA", "DU", "SA",
            "HZ", "PY", "PO", "SQ", "FC", "SS", "DS", "UP"};
        falls = falls || word == "RA" || word == "DZ" || word == "SN";
        if (word == "MI")
            shallow = true;
        else if (word == "BL" || word == "DR")
            blown = true;
        else if (word == "TS")
            found.thunder = true;
        else if (word == "RA")
            found.rain = true;
        else if (word == "DZ")
            found.drizzle = true;
        else if (word == "SN" || word == "SG" || word == "IC")
            found.snow = true;
        else if (word == "PL" || word == "GR" || word == "GS")
            found.hail = true;
        else if (word == "FG")
            found.fog = true;
        else if (word == "BR")
            found.mist = true;
        else if (std::ranges::find(kOthers, word) == kOthers.end())
            return false;
    }
    if (nearby || blown) return true;  // not at the station; raised from the ground
    PresentWeather& all = to.present;
    const bool first = !all.rain && !all.drizzle && !all.snow;
    if (falls && (first || intensity > all.intensity)) all.intensity = intensity;
    all.rain |= found.rain;
    all.drizzle |= found.drizzle;
    all.snow |= found.snow;
    all.hail |= found.hail;
    all.thunder |= found.thunder;
    all.fog |= found.fog;
    all.mist |= found.mist;
    all.shallow_fog |= found.fog && shallow;
    return true;
}

bool clouds(std::string_view group, Metar& to) {
    static constexpr std::array<std::string_view, 4> kClear = {"NSC", "NCD", "SKC", "CLR"};
    if (std::ranges::find(kClear, group) != kClear.end()) return to.sky_is_clear = true;
    // Amount, and perhaps height, seen by no instrument: //////, ///015, //////CB.
    if (group.size() >= 6 && group.starts_with("///")) return true;
    if (take(group, "VV")) {
        if (group == "///") return true;
        if (group.size() != 3 || !all_digits(group)) return false;
        to.vertical_visibility_m = whole(group) * 100 * kFoot_m;
        return true;
    }
    CloudLayer layer;
    struct Amount {
        std::string_view word;
        int least, most;
    };
    static constexpr std::array<Amount, 4> kAmounts = {
        {{"FEW", 1, 2}, {"SCT", 3, 4}, {"BKN", 5, 7}, {"OVC", 8, 8}}};
    const auto* const amount = std::ranges::find_if(
        kAmounts, [&](const Amount& one) { return group.starts_with(one.word); });
    if (amount == kAmounts.end()) return false;
    group.remove_prefix(3);
    layer.least_oktas = amount->least;
    layer.most_oktas = amount->most;
    if (!take(group, "///")) {
        const std::string_view hundreds = take_digits(group);
        if (hundreds.size() != 3) return false;
        layer.base_m = whole(hundreds) * 100 * kFoot_m;
        if (*layer.base_m > 20000) throw Impossible{"expected a base of at most 650, 65,000 feet"};
    }
    if (group == "CB")
        layer.kind = CloudLayer::Kind::Cumulonimbus;
    else if (group == "TCU")
        layer.kind = CloudLayer::Kind::ToweringCumulus;
    else if (!group.empty() && group != "///")
        return false;
    to.clouds.push_back(layer);
    return true;
}

bool temperatures(std::string_view group, Metar& to) {
    const std::size_t middle = group.find('/');
    if (middle == std::string_view::npos) return false;
    const std::string_view air = group.substr(0, middle), dew = group.substr(middle + 1);
    const bool no_air = air.empty() || air == "XX" || all_slashes(air);
    const bool no_dew = dew.empty() || dew == "XX" || all_slashes(dew);
    to.temperature_c = celsius(air);
    to.dew_point_c = celsius(dew);
    if ((!to.temperature_c && !no_air) || (!to.dew_point_c && !no_dew)) return false;
    if (to.temperature_c && (*to.temperature_c < -90 || *to.temperature_c > 60))
        throw Impossible{"expected a temperature of -90 to 60 degrees"};
    if (to.temperature_c && to.dew_point_c && *to.dew_point_c > *to.temperature_c)
        throw Impossible{"expected a dew point that is not above the temperature"};
    return true;
}

bool pressure(std::string_view group, Metar& to) {
    const bool inches = group.starts_with("A");
    if (!inches && !group.starts_with("Q")) return false;
    group.remove_prefix(1);
    if (group.size() == 4 && all_slashes(group)) return true;
    if (group.size() != 4 || !all_digits(group)) return false;
    const double hpa = inches ? whole(group) * 0.01 * kInchOfMercury_hpa : whole(group);
    if (hpa < 850 || hpa > 1100)
        throw Impossible{fmt::format("expected 850 to 1100 hPa at sea level but got {:.0f}", hpa)};
    to.qnh_hpa = hpa;
    return true;
}

bool skipped(std::string_view group) {
    const auto digits = [&](std::size_t at, std::size_t count) {
        return group.size() >= at + count && all_digits(group.substr(at, count));
    };
    // Runway: R24/1200FT, R14L/M0600V1200U, R88/290195, 88290195, 24CLRD70, 14LCLRD//, and R24
    // after WS. Sector of the wind: 210V270. Least visibility by direction: 1500SW. Pressure at the
    // station: QFE742. Snow on the runway, clearing, colour states.
    if (group.size() >= 4 && group[0] == 'R' && digits(1, 2) && group.find('/') <= 4) return true;
    if (group.starts_with("R/")) return true;  // of all runways: R/SNOCLO
    if (digits(0, 2) && group.substr(2).find("CLRD") <= 1) return true;
    if (group.size() >= 3 && group.size() <= 4 && group[0] == 'R' && digits(1, 2) &&
        group.substr(3).find_first_not_of("LCR") == std::string_view::npos)
        return true;
    if ((group.size() == 8 && digits(0, 8)) || group.starts_with("QFE") ||
        group.starts_with("BLACK"))
        return true;
    if (group.size() == 7 && digits(0, 3) && group[3] == 'V' && digits(4, 3)) return true;
    if (group.size() >= 5 && group.size() <= 6 && digits(0, 4) &&
        group.substr(4).find_first_not_of("NESW") == std::string_view::npos)
        return true;
    if (group.size() >= 4 && group.starts_with("RE")) return true;
    if (group.size() >= 3 && group[0] == 'W' && (digits(1, 2) || group.starts_with("W//")))
        return true;
    static constexpr std::array<std::string_view, 13> kWords = {
        "WS",  "ALL", "RWY",  "SNOCLO", "BLU", "BLU+", "WHT",
        "GRN", "YLO", "YLO1", "YLO2",   "AMB", "RED"};
    return std::ranges::find(kWords, group) != kWords.end();
}

}  // namespace relevo::weather::groups
