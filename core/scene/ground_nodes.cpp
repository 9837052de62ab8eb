#include "scene/ground_nodes.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "base/units.h"

namespace relevo::scene {
namespace {

constexpr int kMostNodes = 36;  // along a side

}  // namespace

std::vector<GroundNode> nodes_of(const GroundNet& net) {
    const int step = std::max({1, (net.width() + kMostNodes - 1) / kMostNodes,
                               (net.height() + kMostNodes - 1) / kMostNodes});
    const auto there = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < net.width() && y < net.height() &&
               !std::isnan(net.at(x, y).x);
    };
    constexpr double kEarth_m = 6371e3;
    std::vector<GroundNode> nodes;
    for (int y = 0; y < net.height(); y += step) {
        for (int x = 0; x < net.width(); x += step) {
            if (!there(x, y)) continue;
            const auto difference = [&](int dx, int dy) {
                const bool on = there(x + dx, y + dy), back = there(x - dx, y - dy);
                const glm::dvec3 here = net.at(x, y);
                const glm::dvec3 a = on ? net.at(x + dx, y + dy) : here;
                const glm::dvec3 b = back ? net.at(x - dx, y - dy) : here;
                return on && back ? 0.5 * (a - b) : a - b;
            };
            GroundNode node{net.at(x, y), cross(difference(step, 0), difference(0, step))};
            if (dot(node.normal, node.at_m + glm::dvec3(0, 0, kEarth_m)) < 0)
                node.normal = -node.normal;
            nodes.push_back(node);
        }
    }
    return nodes;
}

Sight sight_of(std::vector<NodeInView> nodes, double left, double right, const glm::dvec3& to_sun) {
    std::ranges::sort(nodes, std::greater{}, &NodeInView::nearness);
    // A node is hidden where nearer ground in the same column of the picture stands higher in it.
    const int columns = std::max(1, static_cast<int>(std::sqrt(nodes.size())));
    std::vector<double> horizon(static_cast<std::size_t>(columns), -1e300);
    const double per_x = columns / std::max(right - left, 1e-9);
    double all = 0, visible = 0, light = 0, light2 = 0;
    Sight sight;
    for (const NodeInView& node : nodes) {
        const double area = length(node.normal);
        all += area;
        double& highest = horizon[static_cast<std::size_t>(
            std::clamp(static_cast<int>((node.x - left) * per_x), 0, columns - 1))];
        if (node.facing > 0 && node.y >= highest) {
            visible += area;
            sight.covered += node.facing;
            const double lit = std::max(dot(node.normal, to_sun), 0.0) / std::max(area, 1e-9);
            light += node.facing * lit;
            light2 += node.facing * lit * lit;
        }
        highest = std::max(highest, node.y);
    }
    if (all > 0) sight.in_sight = visible / all;
    if (sight.covered > 0 && light > 0) {
        const double mean = light / sight.covered;
        sight.contrast = std::sqrt(std::max(light2 / sight.covered - mean * mean, 0.0)) / mean;
    }
    return sight;
}

glm::dvec3 towards(double azimuth_deg, double elevation_deg) {
    const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

double row_azimuth_deg(const GroundNet& net) {
    const int y = net.height() / 2;
    const auto there = [&](int x) { return !std::isnan(net.at(x, y).x); };
    int first = 0, last = net.width() - 1;
    while (first < last && !there(first))
        ++first;
    while (last > first && !there(last))
        --last;
    if (first >= last) return 90;
    // From the middle on: on the round Earth rows are bent.
    const int middle = (first + last) / 2;
    const int from = there(middle) ? middle : first;
    const int to = there(std::min(from + 1, last)) ? std::min(from + 1, last) : last;
    const glm::dvec3 along = net.at(to, y) - net.at(from, y);
    return degrees(std::atan2(along.x, along.y));
}

GroundBox box_of(const GroundNet& net) {
    const double row_deg = row_azimuth_deg(net);
    GroundBox best;
    double least = 1e300;
    for (int turn_deg = 0; turn_deg < 90; ++turn_deg) {
        const double azimuth = radians(row_deg + turn_deg);
        const glm::dvec2 along{std::sin(azimuth), std::cos(azimuth)}, across{-along.y, along.x};
        glm::dvec3 low(1e300), high(-1e300);
        for (const glm::dvec3& post : net) {
            if (std::isnan(post.x)) continue;
            const glm::dvec3 at{dot(glm::dvec2(post), along), dot(glm::dvec2(post), across),
                                post.z};
            low = min(low, at);
            high = max(high, at);
        }
        const glm::dvec3 size = max(high - low, glm::dvec3(0));
        // Rows of a projected grid are slightly bent; the grid's own direction is preferred.
        const double area = size.x * size.y * (turn_deg == 0 ? 1 : 1.02);
        if (area >= least) continue;
        least = area;
        best = {row_deg + turn_deg, size};
    }
    return best;
}

}  // namespace relevo::scene
