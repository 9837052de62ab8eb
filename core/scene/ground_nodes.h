#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "base/array2d.h"

namespace relevo::scene {

/// A coarse grid of posts in the local frame [m], by which views are chosen. x is NaN where there
/// is no ground.
using GroundNet = Array2d<glm::dvec3>;

struct GroundNode {
    glm::dvec3 at_m;
    glm::dvec3 normal;  ///< away from the Earth; its length is the node's area [m2]
};

/// At most 36 x 36 nodes of a net.
std::vector<GroundNode> nodes_of(const GroundNet& net);

/// The horizontal rectangle of least area around all nodes.
struct GroundBox {
    double azimuth_deg = 90;  ///< of its first side
    glm::dvec3 size_m{0};     ///< along that side, across it, and upwards
};
GroundBox box_of(const GroundNet& net);

/// Unit vector; azimuth from north.
glm::dvec3 towards(double azimuth_deg, double elevation_deg);

/// Azimuth of the net's rows [deg]; 90 if there are none.
double row_azimuth_deg(const GroundNet& net);

}  // namespace relevo::scene
