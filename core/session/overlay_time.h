#pragma once

#include <map>
#include <optional>
#include <string>

#include "geo/geodetic.h"
#include "sun/zone.h"

/// The time whose sun a raster on the ground shows.
namespace relevo::session {

/// The sun whose light a raster of `relevo sun` shows, as its metadata say: at one time or place in
/// the sky, or over a period.
struct OverlayTime {
    struct Sun {
        double azimuth_deg = 0;
        double apparent_elevation_deg = 0;  ///< with refraction
        std::optional<double> elevation_deg{};
    };
    std::optional<sun::Instant> utc{};  ///< of one sun
    std::optional<Sun> sun{};           ///< over the DEM's middle
    std::string from{}, to{};           ///< of a period, ISO 8601 with offsets
};

/// @param about  metadata of a raster and its band
/// @returns none where they are of no sun
std::optional<OverlayTime> overlay_time(const std::map<std::string, std::string>& about);

/// "2026-06-21 10:12 UTC+02:00", "2026-06-21", "2026-06-01 to 2026-06-30"; empty where no time is
/// known.
/// @param zone, middle  as clock_text()
std::string clock_text(const OverlayTime& time, const std::string& zone,
                       const geo::Geodetic& middle);

/// As the other sun_text(); empty for a period.
std::string sun_text(const OverlayTime& time);

}  // namespace relevo::session
