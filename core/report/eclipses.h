#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dem/posts.h"
#include "light/point/doubt.h"
#include "report/asked.h"
#include "sun/eclipse.h"

namespace relevo::report {

/// What the figures of eclipses mean.
extern const char* const kEclipseDefinition;

/// An eclipse, and when its sun is seen.
struct SeenEclipse {
    sun::SolarEclipse eclipse;
    std::vector<sun::TimeSpan> up;         ///< over the level horizon
    std::vector<sun::TimeSpan> lit;        ///< over the terrain, where there is a DEM
    std::vector<sun::TimeSpan> not_known;  ///< of lit, for voids of the DEM
    std::optional<sun::EclipseMoment> greatest_seen;
    sun::Date date;  ///< local, of the greatest that is seen, or that only terrain hides

    double not_known_s() const;
    double central_s() const;  ///< how long it is total or annular
};

struct Eclipses {
    geo::Geodetic place;
    Days asked;
    std::string definition, light_definition, horizon_definition;
    bool terrain = false;
    std::vector<SeenEclipse> eclipses;
    light::Doubt doubt;

    /// "up", "down", "behind terrain" or, in a void of the DEM, "not known".
    std::string sun_is(const SeenEclipse& seen, sun::Instant utc) const;
};

/// @param posts  null without a DEM
/// @throws Error (Usage) as check_has_ground(), (BadInput) as light::TerrainHorizon
Eclipses eclipses(const View& view, const Days& asked, const geo::PlaceText& at,
                  const dem::Posts* posts);
std::string json_of(const Eclipses& result);

/// The contacts that an eclipse has, in order.
std::vector<std::pair<const char*, sun::EclipseMoment>> contacts_of(
    const sun::SolarEclipse& eclipse);
bool within(const std::vector<sun::TimeSpan>& spans, sun::Instant utc);

}  // namespace relevo::report
