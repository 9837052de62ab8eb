#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "light/raster/sun_hours.h"
#include "light/raster/sun_plan.h"

namespace relevo::light {

/// Hours of sun of a few days, from one position of the sun to the next: between two, clearances
/// are linear. All figures of a result but its means.
/// @param plan  SunPlan::add_time()
/// @param part  of its window
void add_hours_by_sun(const SunPlan& plan, sun::Instant begin, double length_s, const Window& part,
                      const SunHoursOptions& options, SunHours& result);

/// The order in which suns are visited: theirs, or mixed as SunHoursOptions::mixes_suns has it, by
/// golden sections from the morning on.
std::vector<std::size_t> order_of_suns(std::size_t count, bool mixed);

}  // namespace relevo::light
