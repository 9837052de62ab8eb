#pragma once

#include "cli/verb.h"

/// The verbs under `relevo sun`, a file each.
namespace relevo::cli {

void add_sun_position(Verb sun_verb);
void add_sun_day(Verb sun_verb);
void add_sun_horizon(Verb sun_verb);
void add_sun_carpet(Verb sun_verb);
void add_sun_when(Verb sun_verb);
void add_sun_shadow(Verb sun_verb);
void add_sun_along(Verb sun_verb);
void add_sun_hours(Verb sun_verb);
void add_sun_sky_view(Verb sun_verb);
void add_sun_horizons(Verb sun_verb);

}  // namespace relevo::cli
