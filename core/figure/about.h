#pragma once

#include <string>

#include "figure/figure.h"

/// What a file of a figure says of itself.
namespace relevo::figure {

/// Metadata common to all figures.
/// @param version  of Relevo
/// @param made     sums over all parts
/// @param window   of the DEM's posts
output::RasterMetadata metadata_of(const Figure& figure, const dem::Posts& posts,
                                   const std::string& version, const PartMade& made,
                                   const dem::Window& window);

}  // namespace relevo::figure
