#pragma once

#include <CLI/CLI.hpp>

/// The verbs under `relevo sun`, a file each.
namespace relevo::cli {

void add_sun_position(CLI::App& sun_verb);
void add_sun_day(CLI::App& sun_verb);
void add_sun_horizon(CLI::App& sun_verb);
void add_sun_carpet(CLI::App& sun_verb);
void add_sun_when(CLI::App& sun_verb);
void add_sun_shadow(CLI::App& sun_verb);
void add_sun_along(CLI::App& sun_verb);
void add_sun_hours(CLI::App& sun_verb);
void add_sun_sky_view(CLI::App& sun_verb);
void add_sun_horizons(CLI::App& sun_verb);

}  // namespace relevo::cli
