#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/image.h"
#include "sun/refraction.h"
#include "sun/zone.h"
#include "web/page_ground.h"

/// All data of a page.
namespace relevo::web {

/// How a page looks at the ground first.
struct Look {
    geo::Geodetic eye;       ///< its height is among those of the ground as drawn: exaggerated
    double heading_deg = 0;  ///< clockwise from true north
    double pitch_deg = 0;    ///< above the horizontal
    double fov_deg = 40;     ///< from the bottom to the top of the picture
};

/// What a page says and shows besides its heights.
struct Content {
    std::string title, generator;
    std::vector<std::string> credits;
    double exaggeration = 1;
    double exposure_ev = 0;  ///< of the picture, against that of ordinary ground
    Look look;
    sun::Instant utc;
    sun::Zone zone;
    sun::Refraction refraction = sun::Refraction::none();
    image::Image8 colour;  ///< of all cells, north up: the ground without light
    image::Image8 still;   ///< the first view, for browsers without WebGL2
};

/// Bytes of a content at its best, about: colour and the still picture.
double bytes_of(const Content& content);

/// The first view as a JPEG.
std::vector<std::byte> still_jpeg(const Content& content);

/// @param most_bytes  of the result; the colour takes what the rest leaves of it
/// @throws Error (BadInput) where there is no room for the colour
std::vector<std::byte> page_data(const PageGround& ground, const Content& content,
                                 std::size_t most_bytes);

}  // namespace relevo::web
