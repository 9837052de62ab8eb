#pragma once

#include <array>
#include <filesystem>
#include <memory>

#include "geo/geodetic.h"

/// What climate a place has, and what ground that makes.
namespace relevo::climate {

/// Of each month.
using Months = std::array<double, 12>;

/// The climate of a place, a normal year of 1981 to 2020.
struct Normals {
    double lat_deg = 0;     ///< of the place, north positive
    Months sea_level_c{};   ///< mean air temperature, reduced to sea level by lapse_k_km() [degC]
    Months rain_mm{};       ///< rain and melted snow, at whatever height [mm a month]
    double relief_m = 0;    ///< mean height of the ground around, above which air cools less
    double mapped_ice = 0;  ///< whether the place is mapped as glacier or ice sheet: 0 or 1; of
                            ///< an area its share
};

/// The climate of the whole Earth: temperature in cells of one degree, rain in half ones, its
/// share of the months in 2.5, ice in a twentieth. Between cells it is linear. data/README.md has
/// the sources and what is known to be wrong. Safe on several threads at once.
class ClimateMap {
  public:
    /// @param path  a file of tools/make_climate.py
    /// @throws Error (BadInput) `climate: path: ...` where it is missing or damaged; so does at()
    static ClimateMap read(const std::filesystem::path& path);
    /// The one that Relevo comes with.
    static ClimateMap shipped();

    ClimateMap(ClimateMap&&) noexcept;
    ClimateMap& operator=(ClimateMap&&) noexcept;
    ~ClimateMap();

    /// The first place of a band of 10 degrees of latitude unpacks it; file, band and place take
    /// together 1.3 ms (tests/climate/test_climate_map.cpp).
    Normals at(const geo::Geodetic& place) const;
    /// The same where `mapped_ice` is the share of the mapped ice in a box around the place.
    /// @param half_deg  half of the box's sides, of latitude and of longitude
    Normals around(const geo::Geodetic& place, double half_deg) const;

  private:
    struct Impl;
    explicit ClimateMap(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::climate
