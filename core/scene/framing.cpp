#include "scene/framing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::scene {
namespace {

constexpr int kAzimuths = 24;
constexpr double kFirstElevation_deg = 28, kElevationStep_deg = 3;
/// A view that shows this much is not bettered by standing higher.
constexpr double kEnoughInSight = 0.97, kEnoughFilled = 0.36;
/// Standing higher for a fuller picture alone ends here, where relief still stands up.
constexpr double kHighForFill_deg = 34;
/// What fills more of the picture is no better for it.
constexpr double kFilledWell = 0.4;
/// Seen straight on a block shows one side and no depth: as good as the best from this far beside
/// the grid's axes on.
constexpr double kOblique_deg = 15;
constexpr double kStraightOn = 0.8;
/// How much better the south is than the side, by its score.
constexpr double kSouthern = 0.05;
/// A country is recognised by its outline, as on maps: from the south, and from higher up.
constexpr double kCountry_m = 300e3, kSouthernOfCountry = 0.4, kFirstOfCountry_deg = 46;
constexpr double kPictureAspect = 1.25;
/// A globe is seen from straight above the middle of its map, north up.
constexpr double kGlobeAzimuth_deg = 180, kGlobeElevation_deg = 90;

/// Nodes from a direction, in parallel rays.
std::vector<NodeInView> nodes_from(const GroundNet& net, double azimuth_deg,
                                   const glm::dvec3& to_camera) {
    const double azimuth = radians(azimuth_deg);
    const glm::dvec3 right{-std::cos(azimuth), std::sin(azimuth), 0};
    const glm::dvec3 up = cross(to_camera, right);
    std::vector<NodeInView> nodes;
    for (const GroundNode& node : nodes_of(net))
        nodes.push_back({node, dot(node.at_m, right), dot(node.at_m, up), dot(node.at_m, to_camera),
                         dot(node.normal, to_camera)});
    return nodes;
}

/// How well a side shows depth, kStraightOn to 1.
double obliqueness(double azimuth_deg, double row_deg) {
    const double turned = azimuth_deg - row_deg;
    const double beside = std::abs(turned - 90 * std::round(turned / 90));
    return kStraightOn + (1 - kStraightOn) * std::min(beside / kOblique_deg, 1.0);
}

/// The longer side of the ground [m].
double side_m(const GroundNet& net) {
    glm::dvec2 least(1e300), most(-1e300);
    for (const glm::dvec3& point : net) {
        if (std::isnan(point.x)) continue;
        least = glm::min(least, glm::dvec2(point));
        most = glm::max(most, glm::dvec2(point));
    }
    return std::max(most.x - least.x, most.y - least.y);
}

}  // namespace

double Aspect::score() const {
    return std::min(filled, kFilledWell) * in_sight * in_sight * (0.6 + std::min(contrast, 1.0));
}

Aspect aspect_from(const GroundNet& net, double azimuth_deg, double elevation_deg,
                   const DefaultDay& day) {
    const glm::dvec3 to_camera = towards(azimuth_deg, elevation_deg);
    const std::vector<NodeInView> nodes = nodes_from(net, azimuth_deg, to_camera);
    if (nodes.empty()) return {};
    glm::dvec2 least(1e300), most(-1e300);
    for (const NodeInView& node : nodes) {
        least = glm::min(least, glm::dvec2(node.x, node.y));
        most = glm::max(most, glm::dvec2(node.x, node.y));
    }
    const DefaultTime time = day.estimate(azimuth_deg);
    const Sight sight =
        sight_of(nodes, least.x, most.x, towards(azimuth_deg + time.aside_deg, time.elevation_deg));
    const double width = std::max(most.x - least.x, (most.y - least.y) * kPictureAspect) / kFill;
    Aspect aspect{.in_sight = sight.in_sight, .contrast = sight.contrast};
    if (width > 0) aspect.filled = sight.covered * kPictureAspect / (width * width);
    return aspect;
}

std::string Framing::reason() const {
    return fmt::format(
        "view: from azimuth {:.0f}, {:.0f} degrees high, chosen for relief: {:.0f} % of the {}",
        orbit.azimuth_deg.value(), orbit.elevation_deg.value(), 100 * in_sight,
        orbit.aerial ? "posts are in the picture" : "DEM is visible");
}

namespace {

Framing frame_whole(const Orbit& wanted, const GroundNet& net, const DefaultDay& day) {
    Framing best{.orbit = wanted, .by_relief = true};
    best.orbit.aerial = false;
    if (day.is_globe()) {
        best.orbit.azimuth_deg = wanted.azimuth_deg.value_or(kGlobeAzimuth_deg);
        best.orbit.elevation_deg = wanted.elevation_deg.value_or(kGlobeElevation_deg);
        best.in_sight =
            aspect_from(net, *best.orbit.azimuth_deg, *best.orbit.elevation_deg, day).in_sight;
        return best;
    }
    constexpr double kMiddle_deg = 34;
    const bool is_country = side_m(net) > kCountry_m;
    double azimuth_deg = wanted.azimuth_deg.value_or(0);
    if (!wanted.azimuth_deg) {
        double most = -1;
        const double row_deg = row_azimuth_deg(net);
        const double southern = is_country ? kSouthernOfCountry : kSouthern;
        for (int i = 0; i < kAzimuths; ++i) {
            // From the south on: of equals the first is taken, and maps are read from there.
            const double turn_deg = (i + 1) / 2 * (360.0 / kAzimuths) * (i % 2 ? 1 : -1);
            const double candidate_deg = turn_deg <= -180 ? turn_deg + 540 : 180 + turn_deg;
            Aspect aspect =
                aspect_from(net, candidate_deg, wanted.elevation_deg.value_or(kMiddle_deg), day);
            const DefaultTime light = day.estimate(candidate_deg);
            const double score = aspect.score() * (1 + southern * std::cos(radians(turn_deg))) *
                                 obliqueness(candidate_deg, row_deg) *
                                 (light.within_bounds ? 1 : 0.3);
            if (score <= most + 1e-9) continue;
            most = score;
            azimuth_deg = std::fmod(candidate_deg, 360.0);
        }
    }
    best.orbit.azimuth_deg = azimuth_deg;
    double elevation_deg =
        wanted.elevation_deg.value_or(is_country ? kFirstOfCountry_deg : kFirstElevation_deg);
    Aspect aspect = aspect_from(net, azimuth_deg, elevation_deg, day);
    while (!wanted.elevation_deg && elevation_deg + kElevationStep_deg <= kHighestView_deg &&
           (aspect.in_sight < kEnoughInSight ||
            (aspect.filled < kEnoughFilled && elevation_deg < kHighForFill_deg))) {
        elevation_deg += kElevationStep_deg;
        aspect = aspect_from(net, azimuth_deg, elevation_deg, day);
    }
    best.in_sight = aspect.in_sight;
    best.orbit.elevation_deg = elevation_deg;
    return best;
}

}  // namespace

Framing frame_ground(const Orbit& wanted, const GroundNet& net, const AerialGround& ground,
                     const DefaultDay& day) {
    if (wanted.azimuth_deg && wanted.elevation_deg) return {.orbit = wanted};
    if (!wanted.aerial || day.is_globe() || !has_aerial_view(net, ground))
        return frame_whole(wanted, net, day);
    const AerialFraming framing = frame_aerial(wanted, net, ground, day);
    return {framing.orbit, framing.aspect.posts, true};
}

}  // namespace relevo::scene
