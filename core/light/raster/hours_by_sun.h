#pragma once

#include <functional>

#include "light/raster/sun_hours.h"
#include "light/raster/sun_plan.h"

namespace relevo::light {

/// Hours of sun of a few days, from one position of the sun to the next: between two, clearances
/// are linear. All figures of a result but its means.
/// @param plan  SunPlan::add_time()
/// @param part  of its window
void add_hours_by_sun(const SunPlan& plan, sun::Instant begin, double length_s, const Window& part,
                      const SunHoursOptions& options, SunHours& result);

}  // namespace relevo::light
