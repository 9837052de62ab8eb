#include "scene/aerial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::scene {
namespace {

constexpr double kChoiceAspect = 16.0 / 9;
constexpr double kEarth_m = 6371e3;
/// Of the camera from a side's normal: straight on, a block shows no depth.
constexpr double kTurn_deg = 7;
/// The camera stands so high that the horizon is this far below the upper edge of the picture, as a
/// fraction of its height, or as far as this where ground does not fill enough of the picture.
constexpr double kHorizon = 0.15, kHighestHorizon = 0.09;
constexpr double kLeastAerial_deg = 16, kAerialStep_deg = 1, kHighestAerial_deg = 45;
constexpr double kWideDem_m = 300e3;
/// Over wider DEMs the Earth's curvature hides what is far.
constexpr double kWidest_m = 2000e3;
/// From as near as a DEM that small is seen, ground that is made up in its voids would look it.
constexpr double kNear_m = 5e3;
/// A longer strip, by its width, fills less than a third of the picture from any side.
constexpr double kLongest = 3;
/// A picture that is filled by this much is not bettered by standing higher, or by another side.
constexpr double kFilled = 0.52, kFullPicture = 0.6;
/// Preference of the south, as on maps, and of sides whose default light is within its limits.
constexpr double kFromSouth = 0.05, kFromSouthOfCountry = 0.4, kOtherLight = 0.3;

/// Nodes in the picture; x and y are -1 to 1.
std::vector<NodeInView> nodes_in(const Camera& camera, const GroundNet& net) {
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const double tan_y = std::tan(camera.fov_y_rad / 2), tan_x = tan_y * kChoiceAspect;
    std::vector<NodeInView> seen;
    for (const GroundNode& node : nodes_of(net)) {
        const glm::dvec3 from_eye = node.at_m - camera.eye_m;
        const double depth_m = dot(from_eye, camera.forward);
        if (depth_m <= 0) continue;
        const double x = dot(from_eye, right) / depth_m / tan_x,
                     y = dot(from_eye, camera.up) / depth_m / tan_y;
        if (std::abs(x) > 1 || std::abs(y) > 1) continue;
        seen.push_back(
            {node, x, y, -depth_m, -dot(node.normal, from_eye) / (depth_m * depth_m * depth_m)});
    }
    return seen;
}

/// Above the sea [m], in the local frame, whose plane leaves the Earth's.
double height_m(const GroundNode& node) {
    const glm::dvec2 aside_m(node.at_m);
    return node.at_m.z + dot(aside_m, aside_m) / (2 * kEarth_m);
}

/// Fills in what an aspect says of heights: where the summits are, and the sea.
/// @param seen  of the net's nodes
void look_at_heights(AerialAspect& aspect, const std::vector<NodeInView>& seen,
                     const GroundNet& net) {
    constexpr double kSummit = 0.8, kOffEdges = 0.9, kLevelSea_m = 0.5;
    const std::vector<GroundNode> nodes = nodes_of(net);
    if (seen.empty()) return;
    const auto [lowest, highest] = std::ranges::minmax_element(nodes, {}, height_m);
    const double summit_m = std::lerp(height_m(*lowest), height_m(*highest), kSummit);
    double summits = 0, area = 0, sea = 0;
    for (const NodeInView& node : seen) {
        const bool whole = std::abs(node.x) < kOffEdges && std::abs(node.y) < kOffEdges;
        if (whole && height_m(node) >= summit_m) ++summits;
        const double faces = std::max(node.facing, 0.0);
        area += faces;
        if (std::abs(height_m(node)) < kLevelSea_m) sea += faces;
    }
    aspect.summits =
        summits / static_cast<double>(std::ranges::count_if(
                      nodes, [&](const auto& node) { return height_m(node) >= summit_m; }));
    aspect.sea = area > 0 ? sea / area : 0;
}

/// Fraction of the picture between the lowest and the highest node of each column.
double filled_of(const std::vector<NodeInView>& seen) {
    constexpr int kColumns = 12;
    std::array<double, kColumns> low, high;
    low.fill(1);
    high.fill(-1);
    for (const NodeInView& at : seen) {
        const auto column = static_cast<std::size_t>(
            std::clamp(static_cast<int>(0.5 * (at.x + 1) * kColumns), 0, kColumns - 1));
        low[column] = std::min(low[column], at.y);
        high[column] = std::max(high[column], at.y);
    }
    double filled = 0;
    for (std::size_t i = 0; i < kColumns; ++i)
        filled += std::max(high[i] - low[i], 0.0) / 2 / kColumns;
    return filled;
}

/// How far the horizon is below the upper edge of a picture, as a fraction of its height.
double horizon_of(const Camera& camera) {
    const glm::dvec3 from_earth = camera.eye_m + glm::dvec3(0, 0, kEarth_m);
    const double dip = std::acos(std::min(kEarth_m / length(from_earth), 1.0));
    const double pitch = std::asin(dot(camera.forward, normalize(from_earth)));
    return 0.5 * (1 - std::tan(-pitch - dip) / std::tan(camera.fov_y_rad / 2));
}

/// Whether much of the rectangle is void, and none of the ground is near the sea, which such voids
/// of an island would be.
bool is_cut_out(const GroundNet& net) {
    constexpr double kLeastOfRectangle = 0.65, kInland_m = 20;
    int ground = 0;
    double lowest_m = 1e300;
    for (const glm::dvec3& at_m : net) {
        if (std::isnan(at_m.x)) continue;
        ++ground;
        lowest_m = std::min(lowest_m, height_m({at_m, {}}));
    }
    return ground < kLeastOfRectangle * static_cast<double>(net.size()) && lowest_m > kInland_m;
}

Camera choice_camera(const Orbit& orbit, const AerialGround& ground) {
    return aerial_camera(orbit, ground, radians(kAerialFov_deg), kChoiceAspect);
}

/// Raises an orbit until its horizon and its ground are as they should be.
AerialFraming raised(Orbit orbit, const GroundNet& net, const AerialGround& ground,
                     const DefaultDay& day) {
    orbit.elevation_deg = kLeastAerial_deg;
    double horizon = horizon_of(choice_camera(orbit, ground));
    while (horizon > kHorizon && *orbit.elevation_deg < kHighestAerial_deg) {
        *orbit.elevation_deg += kAerialStep_deg;
        horizon = horizon_of(choice_camera(orbit, ground));
    }
    AerialFraming framing{orbit, aerial_aspect(orbit, net, ground, day)};
    while (framing.aspect.filled < kFilled) {
        *orbit.elevation_deg += kAerialStep_deg;
        if (horizon_of(choice_camera(orbit, ground)) < kHighestHorizon) break;
        framing = {orbit, aerial_aspect(orbit, net, ground, day)};
    }
    return framing;
}

}  // namespace

double AerialAspect::score() const {
    return std::min(filled, kFullPicture) * in_sight * in_sight * (0.6 + std::min(contrast, 1.0)) *
           (0.5 + 0.5 * summits) * (1 - 0.5 * sea);
}

AerialAspect aerial_aspect(const Orbit& orbit, const GroundNet& net, const AerialGround& ground,
                           const DefaultDay& day) {
    const Camera camera = choice_camera(orbit, ground);
    AerialAspect aspect;
    aspect.posts = share_in_picture(camera, ground.posts, kChoiceAspect);
    const std::vector<NodeInView> seen = nodes_in(camera, net);
    aspect.filled = filled_of(seen);
    look_at_heights(aspect, seen, net);
    const DefaultTime time = day.estimate(*orbit.azimuth_deg);
    const Sight sight =
        sight_of(seen, -1, 1, towards(*orbit.azimuth_deg + time.aside_deg, time.elevation_deg));
    aspect.in_sight = sight.in_sight;
    aspect.contrast = sight.contrast;
    return aspect;
}

bool has_aerial_view(const GroundNet& net, const AerialGround& ground) {
    if (ground.posts.empty()) return false;
    const GroundBox box = box_of(net);
    const auto [shorter_m, longer_m] = std::minmax(box.size_m.x, box.size_m.y);
    if (longer_m < kNear_m && is_cut_out(net)) return false;
    const bool is_strip = !ground.land_alone && longer_m > kLongest * shorter_m;
    return shorter_m > 0 && longer_m < kWidest_m && !is_strip;
}

AerialFraming frame_aerial(const Orbit& wanted, const GroundNet& net, const AerialGround& ground,
                           const DefaultDay& day) {
    const GroundBox box = box_of(net);
    const double longest_m = std::max(box.size_m.x, box.size_m.y);
    std::vector<double> azimuths_deg;
    for (int side = 0; side < 4 && !wanted.azimuth_deg; ++side)
        for (const double turn_deg : {-kTurn_deg, kTurn_deg})
            azimuths_deg.push_back(std::fmod(box.azimuth_deg + 90 * side + turn_deg + 720, 360.0));
    if (wanted.azimuth_deg) azimuths_deg = {*wanted.azimuth_deg};
    AerialFraming best;
    double most = -1;
    for (const double azimuth_deg : azimuths_deg) {
        Orbit orbit = wanted;
        orbit.azimuth_deg = azimuth_deg;
        AerialFraming framing;
        if (wanted.elevation_deg)
            framing = {orbit, aerial_aspect(orbit, net, ground, day)};
        else
            framing = raised(orbit, net, ground, day);
        const double southern = longest_m > kWideDem_m ? kFromSouthOfCountry : kFromSouth;
        const double score = framing.aspect.score() *
                             (1 - southern * std::cos(radians(azimuth_deg))) *
                             (day.estimate(azimuth_deg).within_bounds ? 1 : kOtherLight);
        if (score <= most + 1e-9) continue;
        most = score;
        best = framing;
    }
    return best;
}

}  // namespace relevo::scene
