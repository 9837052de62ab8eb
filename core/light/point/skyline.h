#pragma once

#include <vector>

namespace relevo::light {

/// A horizon all round, tabulated, with the lowest and the highest of any stretch of it.
class Skyline {
  public:
    /// @param elevation_rad  from north on, clockwise, equally spaced; at least one
    explicit Skyline(std::vector<double> elevation_rad);

    int count() const { return static_cast<int>(elevation_rad_.size()); }
    double step_rad() const;

    /// Linear between the tabulated directions.
    double elevation_rad(double azimuth_rad) const;

    struct Range {
        double lowest_rad, highest_rad;
    };
    /// Of all directions within a stretch, and the next one outside of it at each end.
    /// @param half_width_rad  to both sides of the azimuth; half a turn or more: all round
    Range range(double azimuth_rad, double half_width_rad) const;

  private:
    std::vector<double> elevation_rad_;
};

}  // namespace relevo::light
