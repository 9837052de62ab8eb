#pragma once

#include <functional>
#include <optional>
#include <string>

#include "dem/posts.h"
#include "light/raster/shadows.h"
#include "output/raster_writer.h"
#include "sun/refraction.h"
#include "sun/time.h"

/// Sun and air over a DEM, as figures state them.
namespace relevo::figure {

/// The sun as seen from the centre of a DEM.
struct SunOverMiddle {
    light::SunOverDem sun;
    double apparent_rad = 0;  ///< apparent elevation from the ground there
    std::optional<sun::Instant> utc;
};

/// @param refraction  as light::refraction_at(); computed at the height of the central post, or of
///     the lowest post if that is void
SunOverMiddle sun_over_middle(const dem::Posts& posts, sun::Instant utc,
                              const std::string& refraction);

/// The sun by "AZ,EL" or "grid:AZ,EL" in degrees, as it is seen. @throws Error (Usage)
SunOverMiddle sun_as_seen(const std::string& text, const dem::Grid& grid);

/// Direction and time of the sun.
output::RasterMetadata metadata_of(const SunOverMiddle& sun);

/// A refraction model at each place.
std::function<sun::Refraction(const geo::Geodetic&)> air_of(const std::string& refraction);

/// Describes a refraction model, evaluated at each post.
std::string air_of_posts(const std::string& refraction, const dem::Posts& posts);

}  // namespace relevo::figure
