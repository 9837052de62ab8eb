#include "cli/sun.h"

#include "cli/commands.h"

namespace relevo::cli {

void add_sun(Verb app) {
    const Verb verb = app.add_verb("sun", "Sun position, shadows, sun hours, horizons");
    verb.require_verb(1);
    add_position(verb, sun::Body::Sun);
    add_sun_day(verb);
    add_horizon(verb, sun::Body::Sun);
    add_sun_eclipses(verb);
    add_sun_carpet(verb);
    add_when(verb, sun::Body::Sun);
    add_sun_shadow(verb);
    add_sun_hours(verb);
    add_sun_plane(verb);
    add_sun_sky_view(verb);
    add_sun_horizons(verb);
    add_sun_along(verb);
}

void add_moon(Verb app) {
    const Verb verb = app.add_verb("moon", "Moon position and phase, moonrise, moonlight");
    verb.require_verb(1);
    add_position(verb, sun::Body::Moon);
    add_moon_day(verb);
    add_horizon(verb, sun::Body::Moon);
    add_when(verb, sun::Body::Moon);
}

}  // namespace relevo::cli
