#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dem/posts.h"
#include "light/point/fan.h"

/// The ground beyond a DEM: a smooth Earth, in each direction as high as the DEM's edge that way.
namespace relevo::light {

/// The edge of a DEM as seen from a post: its last ground in a direction.
struct Edge {
    double distance_m = 0;
    double height_m = 0;
};

/// Follows a line of sight outwards and keeps its last ground.
class EdgeFinder {
  public:
    static constexpr std::size_t kHeights = 3;

    void add(double distance_m, double height_m) {
        if (std::isnan(height_m)) return;
        heights_m_[count_ % heights_m_.size()] = height_m;
        ++count_;
        distance_m_ = distance_m;
    }
    /// The height is the median of the last three, so that one post that is no ground does not
    /// count. None without ground.
    std::optional<Edge> edge() const {
        if (count_ == 0) return std::nullopt;
        if (count_ < heights_m_.size())
            return Edge{distance_m_, heights_m_[(count_ - 1) % heights_m_.size()]};
        const auto [a, b, c] = heights_m_;
        return Edge{distance_m_, std::max(std::min(a, b), std::min(std::max(a, b), c))};
    }

  private:
    std::array<double, kHeights> heights_m_{};
    std::size_t count_ = 0;
    double distance_m_ = 0;
};

/// Tangent of the horizon that the ground beyond an edge makes, 0 at most: the dip of a smooth
/// Earth of that height, or where a line of sight that is level at the edge starts from, if that is
/// lower. Ground before the edge is the DEM's own.
/// @param curvature  of the ground under a line of sight [1/m]
inline double tangent_beyond(const Edge& edge, double eye_m, double curvature) {
    const double dip = std::sqrt(2 * curvature * std::max(0.0, eye_m - edge.height_m));
    return -std::max(dip, curvature * edge.distance_m);
}

/// Whether a post, or a place between posts, is one of a grid's cells.
bool is_on(const dem::Grid& grid, const glm::dvec2& post);
/// The height of the thinned post that is nearest.
double height_near(const dem::Posts& posts, const glm::dvec2& post);

/// The edge that a line of sight meets; none where it is over no ground.
std::optional<Edge> edge_along(const dem::Posts& posts, std::span<const TracePoint> line);

/// How far away the first void that reaches the DEM's edge is on a line of sight; infinity without
/// one.
double outside_from_m(const dem::Posts& posts, std::span<const TracePoint> line);

/// For descriptions of figures.
inline constexpr const char* kBeyondTheDem =
    "; outside the DEM smooth ground as high as its edge there";

}  // namespace relevo::light
