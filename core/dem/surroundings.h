#pragma once

#include <memory>
#include <string>

#include "dem/posts.h"

/// A DEM in others that are wider and mostly coarser: a site in its range.
namespace relevo::dem {

/// Opens LoadOptions::surroundings, which are one DEM, and reads it in the heights of the site.
///
/// Both have one vertical datum by name, or PROJ knows the step between theirs; else their heights
/// are made to agree at the median of places where both have some. What was done is said, and is
/// Description::joined of the result; a difference above 5 m that is left, or scatters so, is a
/// warning.
/// @param site     the DEM that lies in them
/// @param heights  all of the site, if memory holds them; else null. Posts without a height get
/// that
///     of the surroundings
/// @param options  of the site; its memory is what the surroundings may take
/// @throws Error (BadInput) as Posts::load, and where the site is not within them
std::shared_ptr<const Posts> load_surroundings(const Source& site, Heightfield* heights,
                                               const LoadOptions& options);

/// The width of a rim of the site's own spacing that rasters of light have around it [posts]. It
/// covers 64 posts of the surroundings, or less: the site with its rim has at most 16 million posts
/// or twice the site's, whichever is more, and no more than memory has room for, which is a
/// warning.
int rim_of(const Grid& site, const Grid& surroundings, const MemoryBudget& memory);

/// A site with Posts::rim() posts more on each side, whose heights are the surroundings'.
Heightfield rimmed(const Posts& site);

/// What shades, for descriptions of figures: "the DEM alone", or with its surroundings.
const char* ground_text(const Posts& posts);

/// `lead` and "30m.tif around the DEM: heights ..."; empty for posts without surroundings.
std::string surroundings_text(const Posts& posts, const std::string& lead);

}  // namespace relevo::dem
