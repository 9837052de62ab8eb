#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dem/posts.h"
#include "light/fan.h"
#include "light/sweep.h"

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
    std::array<double, 3> heights_m_{};
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

/// The edge that a line of sight meets; none where it is over no ground.
std::optional<Edge> edge_along(const dem::Posts& posts, std::span<const TracePoint> line);

/// How far away the first void that reaches the DEM's edge is on a line of sight; infinity without
/// one.
double outside_from_m(const dem::Posts& posts, std::span<const TracePoint> line);

/// For descriptions of figures.
inline constexpr const char* kBeyondTheDem =
    "; outside the DEM smooth ground as high as its edge there";

/// The edges that the rays of a sweep meet, one for each line of posts along a ray. They are found
/// among dem::Posts::thinned_m(), so that they do not depend on what of the DEM memory holds.
class RayEdges {
  public:
    /// @param path     of the rays over `window`
    /// @param marks    posts for which edges are needed; empty: all of the window
    /// @param reach_m  how far beyond the window edges matter
    RayEdges(const dem::Posts& posts, const SweepSun& path, const SweepWindow& window,
             const std::vector<GridPair>& marks, double reach_m);

    static constexpr int kLongestRun = 512;

    /// Those of the posts of a run: arrays of run.count, which is kLongestRun at most.
    struct OfRun {
        const float* height_m;    ///< minus infinity where there is no edge within reach
        const float* distance_m;  ///< from where the ray through the reference is at the reference
        double from_m;            ///< where that ray is at the run, from the same point
    };
    OfRun of(const SweepRun& run) const;

  private:
    Edge find(const dem::Posts& posts, double line, double begin_m, double end_m,
              double step_m) const;

    SweepSun path_;  // along rows
    bool along_columns_;
    int first_line_ = 0;  // columns from the reference's ray on
    std::vector<float> height_m_, distance_m_;
};

}  // namespace relevo::light
