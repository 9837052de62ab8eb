#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "image/image.h"
#include "sun/refraction.h"
#include "sun/zone.h"
#include "web/page_ground.h"

/// All data of a page.
namespace relevo::web {

/// How a page looks at the ground first.
struct Look {
    glm::dvec2 post{0};      ///< column and row under the eye, with fractions
    double height_m = 0;     ///< of the eye; the ground's are exaggerated
    double heading_deg = 0;  ///< clockwise from true north
    double pitch_deg = 0;    ///< above the horizontal
    double fov_deg = 40;     ///< from the bottom to the top of the picture
};

/// What a page says and shows besides its heights.
struct Content {
    std::string title, generator;
    std::vector<std::string> credits;
    double exaggeration = 1;
    Look look;
    sun::Instant utc;
    sun::Zone zone;
    sun::Refraction refraction = sun::Refraction::none();
    image::Image8 colour;  ///< of all cells, north up: the ground without light
    image::Image8 still;   ///< the first view, for browsers without WebGL2
};

/// @param most_bytes  of the result; the colour takes what the rest leaves of it
/// @throws Error (BadInput) where there is no room for the colour
std::vector<std::byte> page_data(const PageGround& ground, const Content& content,
                                 std::size_t most_bytes);

}  // namespace relevo::web
