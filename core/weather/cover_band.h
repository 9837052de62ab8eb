#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Cloud cover in forecasts: which bands of a raster have it, and for which time.
namespace relevo::weather {

/// Clouds of a level of the atmosphere, as weather services divide it (WMO: low below 2 km, middle
/// up to 6 km, high above), or all of them.
enum class CloudLevel { Low, Middle, High, Total };

/// "low cloud cover"
std::string cover_text(CloudLevel level);

/// A band of cloud cover.
struct CoverBand {
    CloudLevel level = CloudLevel::Total;
    std::optional<std::int64_t> unix_s;  ///< that it is valid for; none: the file does not say it
    double to_share = 1;                 ///< factor on values that makes 0 to 1 of them
    bool is_mean = false;                ///< over an interval that ends then
};

/// Recognises a band of cloud cover by its metadata as GDAL has them.
///
/// GRIB: GRIB_ELEMENT, one of TCDC, LCDC, MCDC, HCDC (GRIB2 discipline 0, category 6, numbers 1, 3,
/// 4, 5) or ECMWF's TCC, LCC, MCC, HCC; TCDC only of the whole atmosphere. NetCDF: the CF standard
/// names cloud_area_fraction, low_type_cloud_area_fraction, medium_..., high_..., or variables tcc,
/// lcc, mcc, hcc, clt, cll, clm, clh; without a vertical dimension.
/// @param about  metadata of the raster, and over them the band's
/// @param unit   of the band
/// @returns nullopt for any other band
/// @throws Error (BadInput), to which the caller adds the file, for units that are neither per cent
///     nor shares, and for times in a calendar or unit that is not understood
std::optional<CoverBand> cover_band(const std::map<std::string, std::string>& about,
                                    const std::string& unit);

/// A time between two of a series.
struct BetweenTimes {
    std::size_t before = 0, after = 0;  ///< indices; equal at a time of the series and at its ends
    double share_of_after = 0;          ///< linear in time, 0 to 1
};

/// Where a time lies in a series: between two times, or at most half a step before the first or
/// after the last one, which then holds. A single time holds for an hour before and after.
/// @param times_s  rising, at least one
/// @returns nullopt outside of that
std::optional<BetweenTimes> between(std::span<const std::int64_t> times_s, std::int64_t unix_s);

/// "2026-06-01 12:00 UTC"
std::string utc_text(std::int64_t unix_s);

}  // namespace relevo::weather
