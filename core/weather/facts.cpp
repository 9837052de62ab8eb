#include "weather/facts.h"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace relevo::weather {
namespace {

constexpr std::array<std::string_view, 5> kWords = {"cloudy", "foggy", "rainy", "snowy",
                                                    "thundery"};
constexpr std::array<std::string_view, 22> kFigures = {
    "wind_m_s",          "wind_from_deg", "visibility_km", "fog_visibility_m", "fog_top_m",
    "snow_visibility_m", "rain",          "deck_1_cover",  "deck_1_base_m",    "deck_1_top_m",
    "deck_1_depth",      "deck_1_kind",   "deck_2_cover",  "deck_2_base_m",    "deck_2_top_m",
    "deck_2_depth",      "deck_2_kind",   "deck_3_cover",  "deck_3_base_m",    "deck_3_top_m",
    "deck_3_depth",      "deck_3_kind"};

constexpr std::array<std::string_view, 3> kFields = {"deck_1_cover", "deck_2_cover",
                                                     "deck_3_cover"};

constexpr double kMiddle_m = 2000, kHigh_m = 6000;  // levels of clouds of middle latitudes (WMO)
constexpr double kUnknownBase_m = 1000;             // of a layer whose base was not measured
constexpr double kMiddleBase_m = 4000, kHighBase_m = 8000;  // of forecasts, which have none
constexpr double kFogTop_m = 150, kShallowFogTop_m = 2;
constexpr double kFogVisibility_m = 500;   // where a report of fog has none
constexpr double kLeastVisibility_m = 50;  // 0000 is less

enum Kind { Cumulus, Stratus, Cirrus };

struct Deck {
    double cover, base_m, top_m, depth;
    Kind kind;
};

/// A layer as a deck; heights above the station.
Deck deck_of(const CloudLayer& layer, bool falls) {
    const double base_m = layer.base_m.value_or(kUnknownBase_m);
    const double cover = layer.cover();
    if (layer.kind == CloudLayer::Kind::Cumulonimbus)
        return {cover, base_m, std::max(base_m + 3000, 9000.0), 100, Cumulus};
    if (layer.kind == CloudLayer::Kind::ToweringCumulus)
        return {cover, base_m, base_m + 3500, 60, Cumulus};
    if (base_m >= kHigh_m) return {cover, base_m, base_m + 800, 0.8, Cirrus};
    const Kind kind = layer.most_oktas <= 4 || (layer.most_oktas < 8 && !falls) ? Cumulus : Stratus;
    if (base_m >= kMiddle_m) return {cover, base_m, base_m + 500, 8, kind};
    if (falls) return {cover, base_m, base_m + 2000, 40, kind};
    return {cover, base_m, base_m + 700, kind == Cumulus ? 20.0 : 12.0, kind};
}

std::vector<Deck> decks_of(const Metar& report) {
    const PresentWeather& now = report.present;
    const bool falls = now.rain || now.drizzle || now.snow;
    std::vector<Deck> decks;
    for (const CloudLayer& layer : report.clouds)
        decks.push_back(deck_of(layer, falls));
    // An obscured sky: the cloud begins where one sees no farther.
    if (report.vertical_visibility_m && !now.fog)
        decks.push_back(
            {1, *report.vertical_visibility_m, *report.vertical_visibility_m + 1000, 30, Stratus});
    std::ranges::stable_sort(decks, std::greater{}, &Deck::cover);
    decks.resize(std::min<std::size_t>(decks.size(), 3));
    std::ranges::stable_sort(decks, std::less{}, &Deck::base_m);
    return decks;
}

/// All figures of a deck but its cover. @param add  takes the end of a figure's name, and its value
void add_deck(const Deck& deck, double station_m,
              const std::function<void(std::string_view, double)>& add) {
    add("_base_m", station_m + deck.base_m);
    add("_top_m", station_m + deck.top_m);
    add("_depth", deck.depth);
    add("_kind", deck.kind);
}

void add_air(const Metar& report, double station_m, Facts& to) {
    const auto add = [&](std::string_view name, double value) {
        to.figures.emplace_back(name, value);
    };
    const PresentWeather& now = report.present;
    if (report.wind_m_s) add("wind_m_s", *report.wind_m_s);
    if (report.wind_from_deg) add("wind_from_deg", *report.wind_from_deg);
    if (now.fog) {
        to.words.emplace_back("foggy");
        add("fog_visibility_m", report.visibility_m.value_or(kFogVisibility_m));
        add("fog_top_m", station_m + (now.shallow_fog ? kShallowFogTop_m : kFogTop_m));
    } else if (report.visibility_m && !report.visibility_is_least) {
        if (now.snow)
            add("snow_visibility_m", *report.visibility_m);
        else
            add("visibility_km", 1e-3 * std::max(*report.visibility_m, kLeastVisibility_m));
    }
    if (now.rain || now.drizzle) {
        to.words.emplace_back("rainy");
        const bool light = now.intensity == PresentWeather::Intensity::Light || !now.rain;
        const bool heavy = now.intensity == PresentWeather::Intensity::Heavy;
        add("rain", heavy ? 1.0 : light ? 0.6 : 0.8);
    }
    if (now.snow) to.words.emplace_back("snowy");
    if (now.thunder) to.words.emplace_back("thundery");
}

std::string layer_words(const CloudLayer& layer) {
    const std::string_view amount = layer.most_oktas == 2   ? "few"
                                    : layer.most_oktas == 4 ? "scattered"
                                    : layer.most_oktas == 7 ? "broken"
                                                            : "overcast";
    const std::string_view kind = layer.kind == CloudLayer::Kind::Cumulonimbus ? " (cumulonimbus)"
                                  : layer.kind == CloudLayer::Kind::ToweringCumulus
                                      ? " (towering cumulus)"
                                      : "";
    return fmt::format("{} {}{}", amount,
                       layer.base_m ? fmt::format("from {:.0f} m", *layer.base_m)
                                    : std::string("at an unknown height"),
                       kind);
}

std::vector<std::string> present_words(const PresentWeather& now) {
    std::vector<std::string> words;
    const std::string_view how = now.intensity == PresentWeather::Intensity::Light   ? "light "
                                 : now.intensity == PresentWeather::Intensity::Heavy ? "heavy "
                                                                                     : "";
    if (now.thunder) words.emplace_back("thunder");
    if (now.rain) words.push_back(fmt::format("{}rain", how));
    if (now.drizzle) words.push_back(fmt::format("{}drizzle", how));
    if (now.snow) words.push_back(fmt::format("{}snow", how));
    if (now.hail) words.emplace_back("hail");
    if (now.fog) words.push_back(fmt::format("{}fog", now.shallow_fog ? "shallow " : ""));
    if (now.mist) words.emplace_back("mist");
    return words;
}

}  // namespace

std::optional<double> Facts::figure(std::string_view name) const {
    for (const auto& [known, value] : figures)
        if (known == name) return value;
    return std::nullopt;
}

std::span<const std::string_view> fact_words() {
    return kWords;
}

std::span<const std::string_view> fact_figures() {
    return kFigures;
}

std::span<const std::string_view> fact_fields() {
    return kFields;
}

Facts facts_of(const std::vector<CloudLevel>& levels, double station_m) {
    Facts facts{.words = {"cloudy"}};
    for (std::size_t i = 0; i < kFields.size(); ++i) {
        const auto add = [&](std::string_view what, double value) {
            facts.figures.emplace_back(fmt::format("deck_{}{}", i + 1, what), value);
        };
        if (i >= levels.size()) {
            add("_cover", 0);
            continue;
        }
        const double base_m = levels[i] == CloudLevel::Middle ? kMiddleBase_m
                              : levels[i] == CloudLevel::High ? kHighBase_m
                                                              : kUnknownBase_m;
        add_deck(deck_of({.least_oktas = 5, .most_oktas = 7, .base_m = base_m}, false), station_m,
                 add);
    }
    return facts;
}

Facts facts_of(const Metar& report, double station_m) {
    Facts facts;
    add_air(report, station_m, facts);
    const std::vector<Deck> decks = decks_of(report);
    if (!decks.empty()) facts.words.emplace_back("cloudy");
    int number = 0;
    for (const Deck& deck : decks) {
        const auto add = [&, n = number + 1](std::string_view what, double value) {
            facts.figures.emplace_back(fmt::format("deck_{}{}", n, what), value);
        };
        add("_cover", deck.cover);
        add_deck(deck, station_m, add);
        ++number;
    }
    if (report.sky_is_clear)
        for (; number < 3; ++number)
            facts.figures.emplace_back(fmt::format("deck_{}_cover", number + 1), 0);
    return facts;
}

std::string summary(const Metar& report) {
    std::vector<std::string> said;
    if (report.wind_m_s) {
        const std::string from = *report.wind_m_s == 0 ? "calm"
                                 : report.wind_from_deg
                                     ? fmt::format("wind {:.1f} m/s from {:.0f}", *report.wind_m_s,
                                                   *report.wind_from_deg)
                                     : fmt::format("wind {:.1f} m/s, variable", *report.wind_m_s);
        said.push_back(from);
    }
    if (report.visibility_m)
        said.push_back(fmt::format("visibility {:.1f} km{}", 1e-3 * *report.visibility_m,
                                   report.visibility_is_least ? " or more" : ""));
    for (std::string& words : present_words(report.present))
        said.push_back(std::move(words));
    if (report.clouds.empty() && report.sky_is_clear) said.emplace_back("no clouds");
    for (const CloudLayer& layer : report.clouds)
        said.push_back(layer_words(layer));
    if (report.vertical_visibility_m)
        said.push_back(fmt::format("vertical visibility {:.0f} m", *report.vertical_visibility_m));
    if (report.temperature_c) said.push_back(fmt::format("{:.0f} C", *report.temperature_c));
    if (report.qnh_hpa) said.push_back(fmt::format("{:.0f} hPa", *report.qnh_hpa));
    return fmt::format(
        "{}, day {}, {:02}:{:02} UTC: {}", report.station, report.day, report.hour, report.minute,
        said.empty() ? "nothing measured" : fmt::format("{}", fmt::join(said, ", ")));
}

}  // namespace relevo::weather
