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

/// A node as a camera sees it.
struct NodeInView : GroundNode {
    double x, y;      ///< to the right and up
    double nearness;  ///< grows towards the camera
    double facing;    ///< its area in the picture; below 0 from behind
};

/// What a camera sees of nodes.
struct Sight {
    double in_sight = 0;  ///< fraction of their area that no other ground hides
    double covered = 0;   ///< area of these in the picture, as NodeInView::facing has it
    double contrast = 0;  ///< of their light: spread over mean
};
/// @param left, right  range of x; other columns are skipped
Sight sight_of(std::vector<NodeInView> nodes, double left, double right, const glm::dvec3& to_sun);

/// The horizontal rectangle of least area around all nodes.
struct GroundBox {
    double azimuth_deg = 90;  ///< of its first side
    glm::dvec3 size_m{0};     ///< along that side, across it, and upwards
};
GroundBox box_of(const GroundNet& net);

/// Unit vector; azimuth from north.
glm::dvec3 towards(double azimuth_deg, double elevation_deg);

/// Azimuth of the net's rows [deg]; 90 of a net without ground.
double row_azimuth_deg(const GroundNet& net);

}  // namespace relevo::scene
