#pragma once

#include <optional>
#include <string>

#include "geo/geodetic.h"

namespace relevo::overlay {

/// Where, whither and when a camera took a photograph, by its Exif data. A part that the file does
/// not have is empty.
struct CameraPhoto {
    std::optional<geo::Geodetic> place;  ///< of the GPS; height [m], NaN without one
    std::optional<double> heading_deg;   ///< clockwise from north, 0 to 360
    bool is_magnetic = false;            ///< the heading is from magnetic north
    /// On 36 x 24 mm film, long side of the film along the long side of the picture [mm].
    std::optional<double> focal_length_mm;
    int width_px = 0, height_px = 0;  ///< upright: as the camera was held
    /// As sun::parse_time() takes it: with an offset or Z if the file knows it, else local time.
    std::string time;
};

/// Reads the Exif data of a JPEG or TIFF. Values that cannot be (latitudes above 90, no numbers)
/// count as missing.
/// @returns none: no such file, no picture, or no data of a camera
/// Source: CIPA DC-008, Exif 2.32.
std::optional<CameraPhoto> camera_photo(const std::string& path);

}  // namespace relevo::overlay
