#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "light/point/horizon.h"

/// Directions that follow each other, and those in which a DEM is too small.
namespace relevo::light {

struct Sector {
    double from_azimuth_rad = 0;  ///< clockwise to
    double to_azimuth_rad = 0;    ///< the last one; of directions on a profile
};

/// Directions of a profile for which something holds, in order; the last may go through north.
std::vector<Sector> sectors_of(const std::vector<bool>& holds);

/// Directions in which the DEM is too small for its horizon to be sure.
struct OpenSector : Sector {
    double reach_m = 0;   ///< the least that the DEM goes there
    double needed_m = 0;  ///< as far as it would have to go
    double least_m = 0;   ///< lower terrain beyond the DEM could not change the horizon

    /// Takes the figures of another one in as well.
    void include(const OpenSector& other);
};

/// Where terrain as high as `highest_m` could stand over a horizon beyond the DEM in one direction,
/// and how far it could: a DEM that reaches that far would settle it.
/// @param point      of this horizon
/// @param highest_m  above the DEM's zero
/// @param over_rad   what must be hidden to matter
/// @param until_m    terrain from there on does not matter
/// @return none where the DEM reaches far enough
std::optional<OpenSector> open_beyond(const TerrainHorizon& horizon, const HorizonPoint& point,
                                      double highest_m, double over_rad,
                                      double until_m = std::numeric_limits<double>::infinity());

/// The same in all directions of a profile, neighbours as one sector.
/// @param matters_rad  for each direction of the profile, what must be hidden to matter, where
///     that stands over the horizon: the lowest sun; infinity: nothing. Empty: the horizon
std::vector<OpenSector> open_sectors(const TerrainHorizon& horizon,
                                     const std::vector<HorizonPoint>& profile, double highest_m,
                                     const std::vector<double>& matters_rad = {});

}  // namespace relevo::light
