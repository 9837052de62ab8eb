#pragma once

#include "cli/verb.h"
#include "sun/body.h"

/// The verbs under `relevo sun` and `relevo moon`, a file each.
namespace relevo::cli {

/// Verbs that `sun` and `moon` both have.
void add_position(Verb parent, sun::Body body);
void add_horizon(Verb parent, sun::Body body);
void add_when(Verb parent, sun::Body body);

void add_moon_day(Verb moon_verb);

void add_sun_day(Verb sun_verb);
void add_sun_eclipses(Verb sun_verb);
void add_sun_carpet(Verb sun_verb);
void add_sun_shadow(Verb sun_verb);
void add_sun_along(Verb sun_verb);
void add_sun_hours(Verb sun_verb);
void add_sun_plane(Verb sun_verb);
void add_sun_sky_view(Verb sun_verb);
void add_sun_horizons(Verb sun_verb);

}  // namespace relevo::cli
