#include "scene/moment.h"

#include "base/units.h"

namespace relevo::scene {

sun::Instant default_moment(const geo::Geodetic& place) {
    const sun::Date longest{2026, place.lat_rad >= 0 ? 6 : 12, 21};
    // Fifteen degrees of longitude are an hour.
    return sun::Instant::from_utc({.date = longest, .hour = 9}) -
           degrees(place.lon_rad) / 15 * 3600;
}

}  // namespace relevo::scene
