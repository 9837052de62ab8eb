#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "light/point/skyline.h"

/// Reads a horizon that another program has written.
namespace relevo::light {

/// The elevation of the horizon in some directions; it is linear between them, also from the last
/// one to the first.
struct FileHorizon {
    struct Direction {
        double azimuth_deg = 0;  ///< clockwise from true north [0, 360)
        double elevation_deg = 0;
    };
    std::vector<Direction> directions;  ///< in the order of their azimuths
    std::string description;            ///< file and format

    /// Every 0.02 degrees, as DirectLight has its skylines.
    Skyline skyline() const;
};

/// Told apart by their lines: CSV with the columns azimuth and elevation (also azimuth_deg and
/// horizon_deg, azimuth and horizon, or pvlib's horizon_azimuth and horizon_elevation), clockwise
/// from north; PVGIS's user horizon, a height in each line, from north on clockwise at equal steps;
/// PVsyst's, azimuth and height separated by a blank, its azimuths counted from south (clockwise),
/// on the southern half of the Earth from north (counterclockwise). Lines that begin with # are
/// skipped. All of them also with .gz.
/// @param who       what errors begin with, "--horizon"
/// @param southern  PVsyst's azimuths are of a place on the southern half of the Earth
/// @throws Error (BadInput) `who: path: line 17: what` for a file in another format, fewer than two
///     directions, an azimuth out of range or given twice, an elevation beyond 90 degrees
FileHorizon read_horizon(const std::string& path, std::string_view who, bool southern);

}  // namespace relevo::light
