#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/day_verb.h"
#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "sun/events.h"

/// What `sun day` and `moon day` say of a day, in each of their forms.
namespace relevo::cli {

/// What days of a body at a place have in common, before it is written as text, CSV or JSON.
struct DayResult {
    struct Words {
        const char* light;       ///< key of direct light: "direct_sun"
        const char* key;         ///< of the next one
        const char* definition;  ///< of figures that the verb has alone
        const char* first_columns;
        std::span<const sun::EventKind> kinds;  ///< columns between
        const char* last_columns;
    };
    const Words& words;
    DaysArguments::Days asked;
    geo::Geodetic place{};
    std::string definition{};              ///< of rising
    std::vector<light::LightDay> light{};  ///< empty without a DEM
    std::string light_definition{}, horizon_definition{};
    light::Doubt doubt{};

    bool has_holes() const { return !doubt.holes.empty(); }
};

/// Finds place, definitions and light.
/// @param horizon  null without a DEM
/// @returns what the light is found with; none without a DEM
/// @throws Error (Usage) as check_has_ground()
std::optional<light::DirectLight> find_light(const DayArguments& arguments,
                                             const geo::PlaceText& at,
                                             const light::TerrainHorizon* horizon,
                                             DayResult& result);

/// The JSON of all days.
/// @param day_json  of one, by its number, without light
nlohmann::ordered_json json_of(const DayResult& result, std::size_t days,
                               const std::function<nlohmann::ordered_json(std::size_t)>& day_json);
/// What of a day's light ends its row of CSV.
std::string light_columns(const DayResult& result, std::size_t day, bool holes);
/// Place and dates.
void print_head(const DayResult& result);
/// Sentences on what the figures mean.
void print_definitions(const DayResult& result);
std::string csv_of(const DayResult& result, const std::vector<std::string>& rows);
/// Rows of CSV, by row_of() of each day.
template <typename Result>
std::vector<std::string> rows_of(const Result& result, bool holes) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < result.days.size(); ++i)
        rows.push_back(row_of(result, i, holes));
    return rows;
}
template <std::derived_from<DayResult> Result>
std::string csv_of(const Result& result) {
    return csv_of(result, rows_of(result, result.has_holes()));
}

/// Computes days for --at or for all of --points, and delivers them.
/// @param forms  as DayFigure
void run_days(const DayArguments& arguments, const DayResult::Words& words,
              decltype(DayFigure::forms) forms);

/// [{kind, utc, local, azimuth_deg, elevation_deg}].
nlohmann::ordered_json events_json(const std::vector<sun::Event>& events, const sun::Zone& zone);

/// A field of CSV: "begin/end;begin/end", in local time.
std::string spans_of(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone);
/// Of all that is lit, what is not known for voids of the DEM.
std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit);

/// "05:25:12 to 06:10:00, ..."; "none".
std::string spans_text(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone);
/// ", of it 0:01:17 not known"; empty where all is known.
std::string not_known_text(const light::LightDay& day);

/// Where voids of the DEM leave the light open.
/// @param light  "direct sun"
std::string not_known_text(const light::Doubt& doubt, const char* light);

/// An azimuth in degrees as two decimals show it: 359.996 is 0.00.
double printed_azimuth_deg(double azimuth_rad);
/// A line for each event.
void print_events(const std::vector<sun::Event>& events, const sun::Zone& zone);
/// A line for each interval, and their sum.
/// @param light  "direct sun"
void print_lit(const light::LightDay& day, const char* light, const sun::Zone& zone);

}  // namespace relevo::cli
