#pragma once

#include <string>

#include "scene/aerial.h"
#include "scene/camera.h"
#include "scene/default_time.h"
#include "scene/ground_nodes.h"

namespace relevo::scene {

/// How the ground looks from a side, as parallel rays show it.
struct Aspect {
    double in_sight = 0;  ///< share of the ground that no other ground hides
    double filled = 0;    ///< share of a picture 5 : 4 that the ground covers, fitted to 95 %
    double contrast = 0;  ///< of its light at the default time: spread over mean
    double score() const;
};

/// @param day  gives the light
Aspect aspect_from(const GroundNet& net, double azimuth_deg, double elevation_deg,
                   const DefaultDay& day);

/// An orbit whose angles are both known, and why they are these.
struct Framing {
    Orbit orbit;
    double in_sight = 0;     ///< fraction of the ground; in aerial views of the posts
    bool by_relief = false;  ///< whether any angle was chosen here

    /// "view: from azimuth 195, 34 degrees high, chosen for relief: 98 % of the DEM is visible", or
    /// of aerial views "... 91 % of the posts are in the picture"
    std::string reason() const;
};

inline constexpr double kLowestView_deg = 25, kHighestView_deg = 40;

/// Fills in the angles that an orbit leaves open: the azimuth of 24 from which relief stands up
/// best, and the lowest elevation from 28 to 40 degrees that hides little of it. Ground of more
/// than 300 km is seen from 46 degrees and from the south if that is nearly as good. Depends on the
/// DEM alone, never on the time or the size of the picture, so that pictures of one DEM are of one
/// view. What goes round the Earth is seen from high above the middle of its map. Aerial views are
/// framed by frame_aerial(); DEMs that have none are seen as a whole. Takes some 10 ms
/// (tests/scene/test_framing.cpp).
Framing frame_ground(const Orbit& wanted, const GroundNet& net, const AerialGround& ground,
                     const DefaultDay& day);

}  // namespace relevo::scene
