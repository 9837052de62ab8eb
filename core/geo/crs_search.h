#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace relevo::geo {

/// A CRS of PROJ's database, geographic or projected.
struct KnownCrs {
    std::string code;  ///< "EPSG:31287", as Crs::parse() takes it
    std::string name;  ///< "MGI / Austria Lambert"
    std::string area;  ///< where it is used, "Austria."
    bool is_projected = true;
    /// Bounds of the area [deg]; west is above east across the antimeridian.
    double west_deg = -180, south_deg = -90, east_deg = 180, north_deg = 90;
};

/// CRSs for a search by code ("31287"), by words of name and area ("utm 32n", "austria lambert") or
/// by a place ("47.26,11.39": latitude, longitude; CRSs whose area has it, smallest area first).
/// Words match whatever their case; exact codes come first, then names that begin with the text,
/// then EPSG's, then those on WGS 84 and ETRS89, then the shortest names. Takes some 100 ms at the
/// first call, 10 ms later.
/// @param most  at most so many
/// @returns empty for an empty text, and if nothing matches
/// @throws Error (Failed) if PROJ has no database
std::vector<KnownCrs> search_crs(std::string_view text, std::size_t most);

/// Whether points lie in the area of a CRS. Some 10 ms for a CRS that was not used before.
/// @param points  in its coordinates, x eastwards
bool holds(const KnownCrs& crs, std::span<const glm::dvec2> points);

}  // namespace relevo::geo
