#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chart/drawing.h"

namespace relevo::chart {

/// Colours of values.
struct Ramp {
    struct Stop {
        double value = 0;
        Color color;

        bool operator==(const Stop&) const = default;
    };
    std::vector<Stop> stops;      ///< at least one, their values rising
    std::optional<Color> none{};  ///< of cells without a value; none: nothing is drawn there
    /// Between two stops: the mean by the value, as it is seen; else the lower stop's colour.
    bool continuous = true;

    /// Beyond the ends the ends' colours; opacity 0 for NaN without `none`.
    Color at(double value) const;

    bool operator==(const Ramp&) const = default;
};

/// Names of the built-in ramps: "sun", "shade", "steel", "viridis", "inferno", "grey".
std::vector<std::string> ramp_names();

/// A built-in ramp from one value to another.
/// @throws Error (BadInput) for an unknown name, or an end that is not over the beginning
Ramp named_ramp(std::string_view name, double from, double to);

/// Reads a colour file as gdaldem color-relief has it: `value red green blue [alpha]` a line,
/// parted by spaces, tabs, commas or colons; a value may be a share of the range, "40%", or "nv"
/// for cells without one; a colour may be one of GDAL's names. Lines that begin with # are left
/// out.
/// @param from, to  the range that shares are of
/// @throws Error (BadInput) `--overlay-colours: path: line 3: what, expected E but got G`
Ramp read_ramp(const std::string& path, double from, double to);

}  // namespace relevo::chart
