#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/array2d.h"
#include "light/raster/sun_hours.h"
#include "output/raster_writer.h"

/// Bands of the rasters that `relevo sun hours` writes, by their words on the command line.
namespace relevo::figure {

/// "hours", "first", "last", "spells", "global", "beam", "diffuse", "reflected".
const std::vector<std::string>& hours_words();

/// Name and unit in files. @pre `word` is one of hours_words(), here and below
output::RasterBand hours_band(std::string_view word);
/// True for first and last light and sunshine periods, which need SunHoursOptions::spells.
bool needs_spells(std::string_view word);
/// True for irradiation, which needs SunHoursOptions::irradiation.
bool needs_irradiation(std::string_view word);

/// The values of a band [h, min, 1, kWh/m2]. Moves them from `hours` if they are stored as they
/// are there.
Array2d<float> hours_values(std::string_view word, light::SunHours& hours);

/// "irradiation of the ground as it is inclined, ...": a sentence for the file's metadata.
std::string definition_of(const light::SunHoursOptions::Irradiation& irradiation);

}  // namespace relevo::figure
