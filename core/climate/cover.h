#pragma once

#include <array>
#include <optional>

#include "climate/climate_map.h"

namespace relevo::climate {

/// What covers natural ground.
enum class Cover { Ice, Snow, Rock, Desert, Steppe, Grass, Forest };

/// "ice", "snow", "rock", "desert", "steppe", "grass", "forest".
const char* name_of(Cover cover);

/// Steps that a year is computed in: five days each.
inline constexpr int kSteps = 73;
inline constexpr double kStep_days = 365.0 / kSteps;
using Year = std::array<float, kSteps>;

/// Covers begin where these are passed.
inline constexpr double kSteppe = 0.5, kGrass = 1, kForest = 1.75;  ///< CoverColumn::dryness()
inline constexpr double kTrees = 1;                                 ///< CoverColumn::growth()
inline constexpr double kPlants = 0;                                ///< likewise
/// Share of the ground from which on it counts as snow.
inline constexpr double kSnowy = 0.5;

/// The climate of one place at any height, and the natural ground that it makes there.
///
/// Pure functions of a normal year: no single winter, no land use, no soil. Heights are metres
/// above the sea, days count from 0, the first of January, to 365. What was tuned, and how far off
/// it is known to be, is in data/README.md. Accuracy: of 176 known places and dates over 90 % have
/// their cover, 58 tree lines are within 250 m in the mean (tests/climate/test_cover.cpp).
class CoverColumn {
  public:
    explicit CoverColumn(const Normals& normals);

    const Normals& normals() const { return normals_; }

    /// Fall of the temperature with height up to the relief around, by month [K/km].
    /// source: 6.5 on average, 0.7 more in the summer of middle latitudes; as the map's
    /// temperatures were reduced with
    static Months lapse_k_km(double lat_deg);

    /// Mean air temperature [degC]. Above the relief around it falls less where the ground is warm.
    Months temperature_c(double height_m) const;
    double mean_c(double height_m) const;        ///< of the year
    double year_mm() const { return year_mm_; }  ///< rain and melted snow

    /// Rain over what the warmth takes; the limit of dry climates is 1, of deserts 0.5.
    /// source: M. C. Peel et al., Updated world map of the Koeppen-Geiger climate classification,
    /// Hydrol. Earth Syst. Sci. 11 (2007), 1633: table 1
    double dryness(double height_m) const;

    /// Warmth for plants by length and mean of the season above 0.9 degC: from 1 trees grow (94
    /// days with 6.4 degC), below 0 no closed cover of plants (45 days, 3.2 degC). source: J.
    /// Paulsen and C. Koerner, A climate-based model to predict potential treeline position around
    /// the globe, Alpine Botany 124 (2014), 1; the mean is of at most the warmest 210 days
    double growth(double height_m) const;

    /// What a glacier would gain in a year there [mm of water]; below 0 it melts.
    double ice_balance_mm(double height_m) const;
    /// Whether ice lies there for good: by its balance, or as mapped where it melts slowly.
    bool has_ice(double height_m) const;

    /// Snow on level open ground through the year [mm of water], at the end of each step.
    /// source: degree-days (R. Hock, Temperature index melt modelling in mountain areas, J.
    /// Hydrology 282 (2003), 104); half of what falls at 1 degC is snow (K. S. Jennings et al.,
    /// Nature Communications 9 (2018), 1148)
    Year snow_mm(double height_m) const;
    /// Share of level open ground that so much snow covers.
    static double snow_share(double snow_mm) { return snow_mm / (snow_mm + 4); }
    /// That on a day.
    double snow_share(double height_m, double day) const;

    /// How green what grows is on a day: 0 in frost and drought, 1 in warm months with as much rain
    /// as their warmth takes. Rain counts over the two months before; limits as dryness().
    double green(double height_m, double day) const;

    Cover cover(double height_m, double day) const;

    /// Heights above which there are no trees, there is ice for good, and half of the level open
    /// ground has snow on a day [m]; within a metre. None where that is not so up to 9000 m.
    /// Values of -500 m: already there.
    std::optional<double> tree_line_m() const;
    std::optional<double> ice_line_m() const;
    std::optional<double> snow_line_m(double day) const;

  private:
    Year steps_of(const Months& months) const;
    double snowfall_mm(const Year& temperature_c, std::size_t step) const;
    double sublimation_mm(double temperature_c, double height_m) const;

    Normals normals_;
    Months lapse_k_km_{}, upper_lapse_k_km_{};
    Year rain_mm_{};  // of each step
    double year_mm_ = 0, summer_share_ = 0;
    double spread_k_ = 1;        // of a day's temperature about the normal, as a softplus has it
    double dry_air_mm_day_ = 0;  // that snow loses to it at 0 degC
};

/// Of such a year, on a day.
double snow_on(const Year& snow_mm, double day);

/// The day of a year, 0 to 364, of a month (1 to 12) and a day (1 to 31).
int day_of_year(int month, int day);

}  // namespace relevo::climate
