#pragma once

#include <optional>
#include <string>

#include "chart/drawing.h"
#include "light/point/carpet.h"

namespace relevo::chart {

/// A carpet as a picture: the days of the year from left to right, the time of day upwards, what
/// light there is by colour; under it the hours of each month.
struct CarpetChart {
    const light::Carpet* carpet = nullptr;
    geo::Geodetic place;
    std::string place_name;          ///< for the title, where there is one
    std::string horizon_definition;  ///< TerrainHorizon::description()

    std::optional<PanelSize> panel;  ///< none: a sheet. Only that has a legend

    static Color color_of(light::Light light);

    /// The days of the year from left to right, the day from midnight at the lower edge.
    Rect plot() const;
    /// A sheet is 1160 units wide.
    Drawing draw() const;
};

}  // namespace relevo::chart
