#pragma once

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "geo/geodetic.h"

namespace relevo::climate {

/// The wind that brings the rain of a place, where it blows from one side all year.
struct TradeWind {
    double from_rad = 0;  ///< azimuth that it blows from
    double share = 0;     ///< 0: no trade wind, 1: the whole year's rain is its
};

/// The trade winds between 5 and 33 degrees of latitude, but for the monsoons of southern Asia.
TradeWind trade_wind(const geo::Geodetic& place);

/// Factors on the rain of a small area by its relief: the wind rises before mountains and sinks
/// behind them. Their mean over land is 1, but for the bounds of 0.25 and 2.5.
/// Source: R. B. Smith and I. Barstad, A Linear Theory of Orographic Precipitation, J. Atmos. Sci.
/// 61, 2004, with their sensitivity of 0.004, 1000 s for cloud and rain; the trade inversion ends
/// what air rises over at 2000 m.
/// Accuracy: in Hawaii the four places with more than 2000 mm a year get more than any of the eight
/// with less than 800 mm (tests/climate/test_relief_rain.cpp).
/// @param height_m  of a net of places, columns from west to east, rows from south to north; sea 0
/// @param apart_m   of columns and rows
Array2d<float> relief_rain(const Array2d<float>& height_m, const glm::dvec2& apart_m,
                           const TradeWind& wind);

/// Factor on rain above the inversion, under which the trade winds' clouds end.
double rain_above_inversion(double height_m, const TradeWind& wind);

}  // namespace relevo::climate
