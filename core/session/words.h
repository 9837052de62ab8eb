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

/// A scene's words as values.
namespace relevo::session {

/// The zone that the words of `--tz` mean at a place, as sun::choose_zone(); tells the user what is
/// assumed of it.
sun::ChosenZone zone_of(const std::string& words, const geo::Geodetic& place);

/// First and last light hang on the terrain, events without a place happen in its middle, and a
/// zone that is taken from a place is taken from there; all other times are known without it.
/// @throws Error (Usage, BadInput) for words that no DEM makes a time of
bool needs_dem(const scene::Moment& moment);

/// Tells the user where a wall time was skipped or came twice, and which zone was taken where a
/// zone is needed and none is named: that of the event's own place, else of `here`, else of the
/// DEM's middle.
/// @param here  where events without a place happen
/// @throws Error (Usage, BadInput)
sun::ParsedTime parse(const scene::Moment& moment, const light::TerrainAccess& dem = {},
                      const std::optional<geo::PlaceText>& here = {});

/// The same without a word to the user, for many places at once.
sun::ParsedTime parse_quietly(const scene::Moment& moment, const light::TerrainAccess& dem = {},
                              const std::optional<geo::PlaceText>& here = {});

/// Events without a place happen in the middle of the DEM; first and last light are those of its
/// posts.
/// @param loaded  of the source, all its posts or means of them
sun::ParsedTime parse_over(const scene::Moment& moment, const dem::Source& source,
                           const dem::Heightfield& loaded);

/// @param model  "standard", "saemundsson" or "none"
sun::Refraction refraction_at(const std::string& model, const geo::Geodetic& place);

/// "azimuth 114.27, elevation 65.12 (65.13 with refraction)", in degrees; what is well below the
/// horizon has no refraction that anyone could see.
std::string sun_text(const sun::Position& position, const sun::Refraction& air);

}  // namespace relevo::session
