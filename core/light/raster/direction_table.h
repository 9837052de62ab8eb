#pragma once

#include <cstddef>
#include <vector>

namespace relevo::light {

/// How long the sun stood over each elevation, and what its beams gave, while its azimuth was
/// within some degrees: what a post gets from there once its horizon is known.
class DirectionTable {
  public:
    static constexpr int kEntries = 4096;
    static constexpr double kLowest_rad = -0.10471975511965978;                // -6 degrees
    static constexpr double kEntry_rad = 1.6755160819145563 / (kEntries - 1);  // over 96 degrees

    /// @param elevation_rad    as seen
    /// @param level_wh, up_wh  of beams: along the azimuth, and from above
    void add(double azimuth_rad, double elevation_rad, double hours, double level_wh, double up_wh);
    /// To be called once all is added.
    void sum_up();

    bool empty() const { return hours_.empty() && hours_over_.empty(); }
    double azimuth_rad() const { return azimuth_sum_rad_ / sum_h_; }
    /// For each elevation, the sums of all over it.
    const float* hours_over() const { return hours_over_.data(); }
    const float* level_wh_over() const { return level_wh_over_.data(); }
    const float* up_wh_over() const { return up_wh_over_.data(); }

  private:
    double azimuth_sum_rad_ = 0, sum_h_ = 0;
    std::vector<double> hours_, level_wh_, up_wh_;
    std::vector<float> hours_over_, level_wh_over_, up_wh_over_;
};

}  // namespace relevo::light
