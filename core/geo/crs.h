#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/glm.hpp>

#include "geo/geodetic.h"

namespace relevo::geo {

/// The vertical part of a compound coordinate reference system.
struct VerticalCrs {
    std::string name;       ///< for example "EGM96 height"
    std::string code;       ///< "EPSG:5773", empty where it has none
    std::string unit_name;  ///< for example "metre"
    double unit_m = 1;      ///< metres in one unit
    bool down = false;      ///< its axis is positive downwards (depths)
};

/// What PROJ does between the datum of a CRS and WGS 84.
struct DatumShift {
    std::string name;                  ///< of the operation, as PROJ words it
    std::optional<double> accuracy_m;  ///< as its authority states it
};

/// A coordinate reference system, horizontal, with the vertical part it may carry.
///
/// Coordinates are in traditional GIS order whatever the authority says: x is longitude or easting,
/// y latitude or northing, in the units of the CRS. A value: copies share what never changes. Every
/// const function is safe on several threads at once; each call borrows a PROJ transformation of
/// its own, made once and kept, so a batch costs two locks however long it is.
///
/// Accuracy of both directions: PROJ's own, nothing added: what PROJ gives to EPSG:4326 is returned
/// to the last bits (1 mm is tested, tests/geo/test_crs.cpp, together with the worked examples of
/// IOGP guidance note 7-2). PROJ chooses the datum shift for each place among those it knows;
/// datum_shift() says which one and how good it is.
class Crs {
  public:
    /// WGS 84 longitude and latitude in degrees (EPSG:4326). Costs nothing: PROJ is not asked.
    Crs();

    /// From what a user may write: `EPSG:31287` and other authorities' codes, WKT of any kind, a
    /// PROJ string, a URN, or the exact name of a CRS. What was read lately is kept: thousands of
    /// files say the same, which takes PROJ 10 ms and 200 kB each time.
    /// @param who  what errors begin with, for example "--crs" or "alps.tif"
    /// @throws Error (BadInput) where PROJ does not know it, or where it is not bound to the Earth:
    ///         local, vertical only, geocentric, of another planet
    static Crs parse(std::string_view text, std::string_view who);

    /// For example "MGI / Austria Lambert"; "Transverse Mercator on WGS 84" where it has no name.
    const std::string& name() const;
    const std::string& code() const;  ///< "EPSG:31287"; empty where no authority is named
    const std::string& wkt() const;   ///< WKT 2 (ISO 19162:2019), on one line
    /// What `--crs` takes to mean the same: the code, else the WKT.
    const std::string& text() const { return code().empty() ? wkt() : code(); }

    bool is_geographic() const;            ///< else projected
    const std::string& unit_name() const;  ///< of x and y: "metre", "US survey foot", "degree"
    /// Metres in one unit of a projected CRS, radians in one of a geographic CRS.
    double unit_si() const;
    const std::optional<VerticalCrs>& vertical() const;

    /// The place of a point, on the ellipsoid (height 0). Latitude and longitude are NaN where the
    /// point is outside of what the CRS can express.
    Geodetic to_geodetic(double x, double y) const;

    /// The same for many points. @param places  as many as `points`
    void to_geodetic(std::span<const glm::dvec2> points, std::span<Geodetic> places) const;

    /// Where a place is in this CRS: the point that to_geodetic() takes there, to 1 mm; the height
    /// plays no part. Longitudes of a geographic CRS are within half a turn of Greenwich. NaN
    /// outside of what the CRS can express.
    glm::dvec2 from_geodetic(const Geodetic& place) const;

    /// The shift of datum used at a point; nothing where the CRS is on WGS 84 itself.
    std::optional<DatumShift> datum_shift(double x, double y) const;

  private:
    struct Impl;
    explicit Crs(std::shared_ptr<const Impl> impl);
    std::shared_ptr<const Impl> impl_;  // none: WGS 84
};

}  // namespace relevo::geo
