#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "dem/grid.h"
#include "geo/geodetic.h"

namespace relevo::light {

/// A point of a line over the ground: where on the grid, how far from its start.
struct TracePoint {
    glm::dvec2 post{0};  ///< column, row
    double distance_m = 0;
};

/// The lines of sight of a place, as they run over a grid: geodesics, whose columns and rows are
/// known at rings around the place and straight in between.
///
/// Grid convergence and the bending of great circles on a map are in it by position: at every ring
/// the line is where PROJ and GeographicLib put it. In between, it is off by at most 0.0001 degrees
/// of azimuth, or a hundred-thousandth of a cell where that is more; blocking points stand within
/// 0.0005 degrees of the azimuth asked for (tests/light/test_horizon.cpp). Close to a pole of a
/// grid in degrees, where meridians run together, within 0.001.
class Fan {
  public:
    /// @param start      the place's column and row
    /// @param longest_m  of the lines; rings end there
    /// @param few        lines will be asked for: there are no rings, each line is followed by
    ///     itself, which costs as much as a thirtieth of the rings
    Fan(const dem::Grid& grid, const geo::Geodetic& place, const glm::dvec2& start,
        double longest_m, bool few = false);

    /// The line that leaves in a direction, from the place on outwards; it ends early where the
    /// grid's CRS cannot express the next point.
    /// @param azimuth_rad  clockwise from true north
    void trace(double azimuth_rad, std::vector<TracePoint>& line) const;

    /// Exactly where the line is at a distance, on the grid or beyond it; NaN where its CRS cannot
    /// express that.
    glm::dvec2 post(double azimuth_rad, double distance_m) const;

  private:
    struct Ring {
        double distance_m = 0;
        bool smooth = false;  // between the samples: interpolation serves
        std::vector<glm::dvec2> posts;
    };
    Ring ring(double distance_m) const;
    bool is_off(const glm::dvec2& apart, double distance_m) const;
    bool straight(const Ring& from, const Ring& middle, const Ring& to) const;
    void refine(const Ring& from, const Ring& to, int depth);
    void follow(double azimuth_rad, const TracePoint& from, const TracePoint& to, int depth,
                std::vector<TracePoint>& line) const;

    const dem::Grid& grid_;
    geo::Geodetic place_;
    glm::dvec2 start_;
    glm::dvec2 spacing_m_;
    double longest_m_;
    std::vector<Ring> rings_;  // none: lines are followed one by one
};

}  // namespace relevo::light
