#pragma once

#include <optional>
#include <string>
#include <vector>

#include "light/point/alignment.h"
#include "light/point/direct_light.h"
#include "light/point/sectors.h"

namespace relevo::light {

/// What more terrain than the DEM has would do to matter.
enum class Matters {
    Horizon,    ///< stand over it
    Sun,        ///< hide the sun, or the moon, while it shines
    Alignment,  ///< hide a summit, or the sun over it
};

/// What of a result a DEM leaves open: its voids, and the ground beyond its edge.
struct Doubt {
    /// Directions in which terrain beyond the DEM could matter.
    std::vector<OpenSector> open;
    /// Directions in which ground in a void of the DEM could matter.
    std::vector<Sector> holes;
    double not_known_s = 0;  ///< of the direct light, for the voids
    double highest_m = 0;    ///< what was assumed of the terrain beyond
    /// How far terrain as high as the Earth's highest could matter; none if the height was given.
    std::optional<double> earths_needed_m{};
    /// The lowest sun or moon that shines, where that is below the level horizon.
    std::optional<LightEdge> lowest_sun{};
    Matters matters = Matters::Horizon;
    sun::Body body = sun::Body::Sun;
};

/// How high terrain beyond a DEM is taken to be: as given, or as the DEM's highest post, at most
/// the Earth's.
double highest_beyond_m(const dem::Posts& posts, const std::optional<double>& given_m);

/// What matters for a horizon as such.
/// @param profile    of that horizon
/// @param highest_m  of the terrain beyond, as highest_beyond_m() has it
Doubt doubt_of(const TerrainHorizon& horizon, const std::vector<HorizonPoint>& profile,
               const std::optional<double>& highest_m);

/// What matters for the light of some days: more terrain can only take away sun that shines, in the
/// directions in which it stands then, as low as it stands there.
Doubt doubt_of(const DirectLight& light, const std::vector<LightDay>& days,
               const std::vector<HorizonPoint>& profile, const std::optional<double>& highest_m);

/// What matters for passages of the sun over a summit: terrain beyond the DEM that would hide one
/// that is seen, or stand between the eye and a target that lies beyond the edge. Voids are
/// reported by the alignments themselves.
Doubt doubt_of(const TerrainHorizon& horizon, const Alignments& found,
               const std::optional<double>& highest_m);

}  // namespace relevo::light
