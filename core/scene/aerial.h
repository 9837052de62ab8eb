#pragma once

#include <optional>
#include <vector>

#include "scene/camera.h"
#include "scene/default_time.h"
#include "scene/ground_nodes.h"

/// Aerial views: out of an aeroplane above the near edge of a DEM, with a horizon.
namespace relevo::scene {

/// What an aerial view shows of a DEM in a picture 16 : 9.
struct AerialAspect {
    double posts = 0;     ///< fraction of AerialGround::posts that is in the picture
    double filled = 0;    ///< fraction of the picture that is ground
    double in_sight = 0;  ///< fraction of the ground in the picture that no other ground hides
    double contrast = 0;  ///< of its light at the default time: spread over mean
    double summits = 1;   ///< fraction of the highest ground that is in the picture, off its edges
    double sea = 0;       ///< fraction of the ground in the picture that is a level sea
    double score() const;
};

AerialAspect aerial_aspect(const Orbit& orbit, const GroundNet& net, const AerialGround& ground,
                           const DefaultDay& day);

/// False for DEMs that are seen as a whole: those without an extent, strips, those so wide that the
/// Earth's curvature hides their far edge, and small ones cut out of their rectangle inland.
bool has_aerial_view(const GroundNet& net, const AerialGround& ground);

struct AerialFraming {
    Orbit orbit;
    AerialAspect aspect;
};

/// Fills in the angles that an orbit leaves open. The camera looks along a normal of a side of the
/// DEM, turned by a few degrees, so that no two long walls show, from the side where relief stands
/// up best, and from 20 degrees or higher until ground fills half of the picture. Depends on the
/// DEM alone.
AerialFraming frame_aerial(const Orbit& wanted, const GroundNet& net, const AerialGround& ground,
                           const DefaultDay& day);

}  // namespace relevo::scene
