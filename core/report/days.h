#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dem/posts.h"
#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "report/asked.h"
#include "sun/moon_events.h"

namespace relevo::report {

/// What days of a body are called.
struct DayWords {
    const char* light;       ///< key of direct light: "direct_sun"
    const char* body;        ///< whose light it is, in names of columns: "sun"
    const char* key;         ///< of the next one
    const char* definition;  ///< of figures that this body has alone
    /// Columns of a table, with those of the kinds between.
    const char* first_columns;
    std::span<const sun::EventKind> kinds;
    const char* last_columns;
};
extern const DayWords kSunWords, kMoonWords;

/// What days of a body at a place have in common.
struct DayResult {
    const DayWords& words;
    Days asked;
    geo::Geodetic place{};
    std::string definition{};              ///< of rising
    std::vector<light::LightDay> light{};  ///< empty without a DEM
    std::string light_definition{}, horizon_definition{};
    light::Doubt doubt{};

    bool has_holes() const { return !doubt.holes.empty(); }
};

/// With what its diagram is drawn from.
struct SunDays : DayResult {
    std::vector<sun::Day> days{};
    std::optional<light::TerrainHorizon> horizon{};
    std::optional<light::DirectLight> direct{};  // refers to horizon
};
struct MoonDays : DayResult {
    std::vector<sun::MoonDay> days{};
};

/// @param posts  null without a DEM; outlive the result
/// @throws Error (Usage) as check_has_ground(), (BadInput) as light::TerrainHorizon
std::shared_ptr<const SunDays> sun_days(const View& view, const Days& asked,
                                        const geo::PlaceText& at, const dem::Posts* posts);
std::shared_ptr<const MoonDays> moon_days(const View& view, const Days& asked,
                                          const geo::PlaceText& at, const dem::Posts* posts);

std::string json_of(const SunDays& result);
std::string json_of(const MoonDays& result);

/// "day", "night"; null: the sun rises or sets.
const char* polar_of(const sun::Day& day);
/// "up", "down"; null: the moon rises or sets.
const char* all_day_of(const sun::MoonDay& day);
/// Of all that is lit, what is not known for voids of the DEM.
std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit);

}  // namespace relevo::report
