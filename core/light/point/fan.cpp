#include "light/point/fan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::light {
namespace {

// With 32 directions, interpolation through eight of them is off by 2.3e-9 of the distance: the
// 8th-order term of a sine, (pi/16)^8 * (1*3*5*7)^2 / 2^8 / 8!.
constexpr int kFanDirections = 32;
constexpr int kPoints = 8;
constexpr double kStep_rad = 2 * kPi / kFanDirections;

constexpr double kStraight = 2e-6;  // of the distance: 0.0001 degrees
constexpr double kStraight_cells = 1e-5;
constexpr double kSmooth = 1e-6;  // of the distance
constexpr int kDeepest = 12;      // halvings of the longest line

bool finite(const glm::dvec2& p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

/// Lagrange's weights for nodes at -3 ... 4, at p in [0, 1].
std::array<double, kPoints> weights(double p) {
    std::array<double, kPoints> w{};
    for (int i = 0; i < kPoints; ++i) {
        double product = 1;
        for (int k = 0; k < kPoints; ++k)
            if (k != i) product *= (p - (k - 3)) / (i - k);
        w[static_cast<std::size_t>(i)] = product;
    }
    return w;
}

glm::dvec2 interpolated(const std::vector<glm::dvec2>& samples, int before,
                        const std::array<double, kPoints>& w) {
    glm::dvec2 sum(0);
    for (int i = 0; i < kPoints; ++i)
        sum +=
            w[static_cast<std::size_t>(i)] *
            samples[static_cast<std::size_t>((before + i - 3 + kFanDirections) % kFanDirections)];
    return sum;
}

}  // namespace

Fan::Fan(const dem::Grid& grid, const geo::Geodetic& place, const glm::dvec2& start,
         double longest_m, bool few)
    : grid_(grid),
      place_(place),
      start_(start),
      spacing_m_(grid.post_spacing_m()),
      longest_m_(longest_m) {
    if (few) return;
    Ring first{0, true, std::vector<glm::dvec2>(kFanDirections, start_)};
    Ring last = ring(longest_m);
    rings_.push_back(first);
    refine(first, last, 0);
}

glm::dvec2 Fan::post(double azimuth_rad, double distance_m) const {
    // Longitudes on this side of the place, not at the far end of the grid.
    return grid_.post(geo::destination(place_, azimuth_rad, distance_m), start_);
}

Fan::Ring Fan::ring(double distance_m) const {
    Ring ring{distance_m, true, {}};
    for (int i = 0; i < kFanDirections; ++i)
        ring.posts.push_back(post(i * kStep_rad, distance_m));
    // Around a pole, or at the edge of what the CRS expresses, the samples do not join smoothly.
    const auto middle = weights(0.5);
    for (int i = 0; i < kFanDirections && ring.smooth; i += 4) {
        const glm::dvec2 apart =
            (interpolated(ring.posts, i, middle) - post((i + 0.5) * kStep_rad, distance_m)) *
            spacing_m_;
        ring.smooth = glm::length(apart) <= kSmooth * distance_m;  // false for NaN
    }
    return ring;
}

bool Fan::is_off(const glm::dvec2& apart, double distance_m) const {
    return glm::length(apart * spacing_m_) > kStraight * distance_m &&
           glm::length(apart) > kStraight_cells;
}

bool Fan::straight(const Ring& from, const Ring& middle, const Ring& to) const {
    for (std::size_t i = 0; i < kFanDirections; ++i) {
        const glm::dvec2 apart = (from.posts[i] + to.posts[i]) / 2.0 - middle.posts[i];
        if (!finite(apart)) continue;  // the line ends before
        if (is_off(apart, middle.distance_m)) return false;
    }
    return true;
}

void Fan::refine(const Ring& from, const Ring& to, int depth) {
    const Ring middle = ring((from.distance_m + to.distance_m) / 2);
    // A line that bends the other way in its second half may pass through the middle by chance.
    if (depth < kDeepest && (depth < 2 || !straight(from, middle, to))) {
        refine(from, middle, depth + 1);
        refine(middle, to, depth + 1);
    } else {
        rings_.push_back(to);
    }
}

/// Adds the line from one point on it to another, as refine() adds rings; as far as the CRS has it.
void Fan::follow(double azimuth_rad, const TracePoint& from, const TracePoint& to, int depth,
                 std::vector<TracePoint>& line) const {
    const double distance_m = (from.distance_m + to.distance_m) / 2;
    const TracePoint middle{post(azimuth_rad, distance_m), distance_m};
    const glm::dvec2 apart = (from.post + to.post) / 2.0 - middle.post;
    if (depth < kDeepest && (depth < 2 || !finite(apart) || is_off(apart, distance_m))) {
        follow(azimuth_rad, from, middle, depth + 1, line);
        if (finite(middle.post)) follow(azimuth_rad, middle, to, depth + 1, line);
    } else if (finite(to.post)) {
        line.push_back(to);
    }
}

void Fan::trace(double azimuth_rad, std::vector<TracePoint>& line) const {
    if (rings_.empty()) {
        const TracePoint start{start_, 0}, end{post(azimuth_rad, longest_m_), longest_m_};
        line.assign({start});
        follow(azimuth_rad, start, end, 0, line);
        return;
    }
    const double turns = azimuth_rad / (2 * kPi);
    const double direction = (turns - std::floor(turns)) * kFanDirections;
    const int before = std::min(static_cast<int>(direction), kFanDirections - 1);
    const auto w = weights(direction - before);
    line.clear();
    line.push_back({start_, 0});
    for (std::size_t i = 1; i < rings_.size(); ++i) {
        const Ring& ring = rings_[i];
        const glm::dvec2 p =
            ring.smooth ? interpolated(ring.posts, before, w) : post(azimuth_rad, ring.distance_m);
        if (!finite(p)) return;
        line.push_back({p, ring.distance_m});
    }
}

}  // namespace relevo::light
