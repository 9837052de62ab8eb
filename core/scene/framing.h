#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "scene/camera.h"
#include "scene/default_time.h"

namespace relevo::scene {

/// The ground as choosing a camera sees it: places on a net in the local frame [m], neighbours in
/// the field beside each other; x is NaN where there is no ground.
using GroundNet = Array2d<glm::dvec3>;

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
    Aspect aspect;
    bool by_relief = false;  ///< whether any angle was chosen here

    /// "the DEM is seen from azimuth 195, 34 degrees high: 98 % of it in sight"
    std::string reason() const;
};

inline constexpr double kLowestView_deg = 25, kHighestView_deg = 40;

/// Fills in the angles that an orbit leaves open: the azimuth of 24 from which relief stands up
/// best, and the lowest elevation from 28 to 40 degrees that hides little of it. Ground of more
/// than 300 km is seen from 46 degrees and from the south if that is nearly as good. Depends on the
/// DEM alone, never on the time or the size of the picture, so that pictures of one DEM are of one
/// view. What goes round the Earth is seen from high above the middle of its map. Takes some 2 ms
/// (tests/scene/test_framing.cpp).
Framing frame_ground(const Orbit& wanted, const GroundNet& net, const DefaultDay& day);

}  // namespace relevo::scene
