#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "zones/zone_file.h"

/// What the values of a raster come to by zone.
namespace relevo::zones {

/// What a cell weighs.
enum class Weights {
    Crs,       ///< all the same
    Ellipsoid  ///< its area on the ellipsoid of WGS 84
};

/// A zone over one band; NaN where there is no value.
struct ZoneRow {
    double cells = 0;          ///< with a value, that the zone reaches into
    double area_m2 = 0;        ///< of the zone's polygon, also where there is no raster
    double area_valid_m2 = 0;  ///< of it, on cells with a value
    double mean = std::numeric_limits<double>::quiet_NaN();  ///< by share and weight
    double integral = 0;                                     ///< mean x area_valid_m2
    double min = std::numeric_limits<double>::quiet_NaN();   ///< of the cells it reaches into
    double max = std::numeric_limits<double>::quiet_NaN();
    double share_above = std::numeric_limits<double>::quiet_NaN();  ///< by weight, of its values
    std::string fault;                                              ///< why it has no values
};

struct SumOptions {
    std::optional<Weights> weights;  ///< none: Ellipsoid where the raster is in degrees, else Crs
    std::optional<double> above;     ///< for share_above; none: NaN
};

/// Zones over all bands of a raster: one row for each zone, in their order, band by band.
///
/// Cells are squares with one value each. Each counts by the share of it that lies in the zone, by
/// the even-odd rule and exact but for rounding; cells without a value count for nothing. Outlines
/// are straight between corners in the CRS of their file, and followed within 0.00001 cells where
/// the raster has another one. Areas are metres of the CRS; of rasters in degrees, and with
/// Weights::Ellipsoid, those on the ellipsoid of WGS 84.
///
/// Accuracy: 1e-9 of exact sums, 1e-4 of areas on the ellipsoid (tests/zones). Reads what zones
/// cover, in windows of at most 16 MiB.
/// @throws Error (BadInput) as overlay::grid_of_raster(), and where the raster cannot be read
std::vector<std::vector<ZoneRow>> sum_zones(const ZoneFile& file, const std::string& raster,
                                            const SumOptions& options);

}  // namespace relevo::zones
