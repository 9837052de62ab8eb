#pragma once

#include "cli/verb.h"

/// The verbs of the command line, a file each. A verb adds its options to `app` and returns
/// nothing; its callback runs once the line has been read.
namespace relevo::cli {

void add_capture(Verb app);
void add_compare(Verb app);
void add_run(Verb app);
void add_plan(Verb app);
void add_merge(Verb app);
void add_film(Verb app);
void add_view(Verb app);
void add_doctor(Verb app);
void add_info(Verb app);
void add_export(Verb app);
void add_sun(Verb app);
void add_moon(Verb app);
void add_plugins(Verb app);
void add_thumbnail(Verb app);
void add_cache(Verb app);
void add_zones(Verb app);

}  // namespace relevo::cli
