#pragma once

#include <optional>
#include <string>

#include "dem/source.h"
#include "geo/format.h"
#include "light/point/event_time.h"
#include "scene/scene.h"
#include "sun/position.h"
#include "sun/refraction.h"
#include "sun/zone_of_place.h"

/// Parses the words of a scene.
namespace relevo::session {

/// The zone named by `--tz` at a place, as sun::choose_zone(). Logs assumptions.
sun::ChosenZone zone_of(const std::string& words, const geo::Geodetic& place);

/// True if parsing the time requires the DEM: for first and last light, events without a place, and
/// time zones by place.
/// @throws Error (Usage, BadInput) for words that are invalid with any DEM
bool needs_dem(const scene::TimeSpec& spec);

/// Parses a scene's time. Logs skipped and ambiguous wall-clock times and an assumed zone. Where a
/// zone is needed but none is given, it is that of the event's place, else of `here`, else of the
/// DEM's centre.
/// @param here  where events without a place happen
/// @throws Error (Usage, BadInput)
sun::ParsedTime parse(const scene::TimeSpec& spec, const light::TerrainAccess& dem = {},
                      const std::optional<geo::PlaceText>& here = {});

/// As parse(), without logging.
sun::ParsedTime parse_quietly(const scene::TimeSpec& spec, const light::TerrainAccess& dem = {},
                              const std::optional<geo::PlaceText>& here = {});

/// As parse(), with events at the DEM's centre; first and last light use its posts.
/// @param loaded  all posts of the source, or means of them
sun::ParsedTime parse_over(const scene::TimeSpec& spec, const dem::Source& source,
                           const dem::Heightfield& loaded);

/// "azimuth 114.27, elevation 65.12 (65.13 with refraction)", in degrees. Refraction is omitted
/// more than 2 degrees below the horizon.
std::string sun_text(const sun::Position& position, const sun::Refraction& air);

}  // namespace relevo::session
