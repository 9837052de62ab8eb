#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "weather/cover_band.h"
#include "weather/metar.h"

namespace relevo::weather {

/// What effects can take from the weather: words, which switch effects on, and figures, which set
/// parameters. Plugins name them in the object "weather" of plugin.json.
struct Facts {
    std::vector<std::string> words;                       ///< of fact_words()
    std::vector<std::pair<std::string, double>> figures;  ///< of fact_figures()

    std::optional<double> figure(std::string_view name) const;
    bool operator==(const Facts&) const = default;
};

/// "cloudy", "foggy", "rainy" (drizzle, too), "snowy", "thundery".
std::span<const std::string_view> fact_words();

/// Names with units, what is missing in a report is missing:
///   wind_m_s, wind_from_deg
///   visibility_km          of the air, where it is below 10 km and neither fog nor snow
///   fog_visibility_m, fog_top_m          the top above sea level
///   snow_visibility_m      in falling snow
///   rain                   0 to 1, how hard it rains
///   deck_1_cover           0 to 1; decks 1 to 3 from below
///   deck_1_base_m, deck_1_top_m          above sea level
///   deck_1_depth           optical depth, vertical, where there is cloud
///   deck_1_kind            0 cumulus, 1 stratus, 2 cirrus
std::span<const std::string_view> fact_figures();

/// Figures that vary from place to place, in the weather of a forecast: deck_1_cover, deck_2_cover,
/// deck_3_cover. Textures of plugins name them.
std::span<const std::string_view> fact_fields();

/// Facts of a forecast of cloud cover: a deck of each level in the usual height, from below. The
/// cover is a field (fact_fields()) and no figure.
/// @param levels     of which there is cover, from below: Total alone, or others
/// @param station_m  height above sea level that clouds stand above
Facts facts_of(const std::vector<CloudLevel>& levels, double station_m);

/// Facts of a report. Reports know neither tops nor optical depths: those usual for the kind and
/// height are taken (docs/weather.md). Of more than three layers the most covering are decks.
/// @param station_m  height of the station above sea level, from which bases are counted
Facts facts_of(const Metar& report, double station_m);

/// What a report says, on one line: "LSZB, day 1, 11:50 UTC: wind 4.6 m/s from 240, 17 C, 1014 hPa,
/// light rain, few clouds from 457 m, ..."
std::string summary(const Metar& report);

}  // namespace relevo::weather
