#pragma once

#include <optional>
#include <string>

#include "figure/figure.h"

/// What a file of a figure says of itself.
namespace relevo::figure {

/// Metadata common to all figures.
/// @param version  of Relevo
/// @param made     sums over all parts
/// @param clip     window of the DEM's posts, if not all
output::RasterMetadata metadata_of(const Figure& figure, const dem::Posts& posts,
                                   const std::string& version, const PartMade& made,
                                   const std::optional<dem::Window>& clip = {});

}  // namespace relevo::figure
