#pragma once

#include <string>
#include <vector>

#include "geo/crs_search.h"
#include "viewer/settings.h"

namespace relevo::viewer {

/// A CRS that a raster without one may be in.
struct CrsSuggestion {
    geo::KnownCrs crs;
    std::string where;  ///< its middle would then be: "near Telfs (AT), 47.30800 N 11.07200 E"
};

/// CRSs in whose area all of a raster lies: those whose code its name has ("dgm_25832.asc"), that
/// of another DEM if it has a code, longitude and latitude, and within 1000 km of the other DEM
/// those used there: UTM on WGS 84 and ETRS89, then the smallest areas. Takes up to half a second.
/// @param dem    has coordinates, but no CRS; otherwise there are no suggestions
/// @param other  the DEM that was opened last; may have no files
std::vector<CrsSuggestion> suggest_crs(const RecentDem& dem, const RecentDem& other);

/// "near Telfs (AT), 47.30800 N 11.07200 E", by the names that Relevo brings.
std::string where_text(const geo::Geodetic& place);
/// "near Innsbruck (AT)"; empty: no place is within 50 km, or the lists of names cannot be read.
std::string near_text(const geo::Geodetic& place);

}  // namespace relevo::viewer
