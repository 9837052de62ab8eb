#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relevo::geo {

/// A place on Earth: WGS 84, ellipsoidal. The only form a place takes between layers.
struct Geodetic {
    double lat_rad = 0;   ///< geodetic latitude, positive north, [-pi/2, pi/2]
    double lon_rad = 0;   ///< longitude, positive east of Greenwich, [-pi, pi)
    double height_m = 0;  ///< above the WGS 84 ellipsoid [m]

    friend bool operator==(const Geodetic&, const Geodetic&) = default;
};

/// A place from degrees; the longitude is brought into [-180, 180).
Geodetic geodetic_deg(double lat_deg, double lon_deg, double height_m = 0);

/// A longitude brought into [-180, 180) degrees; those that are there already keep every bit.
double normalized_lon_deg(double lon_deg);

/// The shortest way over the ellipsoid from one place to another; heights play no part.
struct Geodesic {
    double distance_m = 0;       ///< along the ellipsoid [m]
    double azimuth_rad = 0;      ///< at the first place, clockwise from true north, [0, 2 pi)
    double end_azimuth_rad = 0;  ///< at the second place, in the direction of travel, [0, 2 pi)
};

/// Solves the inverse problem: how far and which way.
/// @param from,to  latitudes within [-pi/2, pi/2]
/// Accuracy: 15 nm (C. F. F. Karney, Algorithms for geodesics, J. Geodesy 87, 2013,
/// doi:10.1007/s00190-012-0578-z); tests/geo/test_geodetic.cpp compares with published examples.
Geodesic geodesic(const Geodetic& from, const Geodetic& to);

/// Solves the direct problem: the place at `distance_m` along the geodesic that leaves `from` at
/// `azimuth_rad` (clockwise from true north). The height of `from` is kept.
/// Accuracy and source: as geodesic().
Geodetic destination(const Geodetic& from, double azimuth_rad, double distance_m);

/// Area of a polygon whose sides are geodesics [m^2], whichever way round its corners are given;
/// heights play no part. Where the outline crosses itself, parts count with opposite signs.
/// Accuracy: 0.1 m^2 for each corner (Karney 2013, as geodesic()). Source:
/// GeographicLib::PolygonArea.
double polygon_area_m2(std::span<const Geodetic> corners);

/// A place as the command line writes it.
struct PlaceText {
    Geodetic place;             ///< height 0 where none was given
    bool has_height = false;    ///< the third number was there
    bool above_ground = false;  ///< it had the suffix `agl`: metres above the ground
};

/// Reads `LAT,LON` or `LAT,LON,H` or `LAT,LON,Hagl`: decimal degrees, north and east positive, and
/// metres. Longitudes from -180 to 360 are taken and brought into [-180, 180).
/// @param who  what the error begins with, for example "--at"
/// @throws Error (Usage) `who: text: what, expected E but got G; remedy`
PlaceText parse_place(std::string_view text, std::string_view who);

}  // namespace relevo::geo
