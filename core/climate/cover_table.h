#pragma once

#include <vector>

#include "climate/climate_map.h"
#include "climate/cover.h"

namespace relevo::climate {

/// A box of the Earth, in degrees; the east may lie beyond 180.
struct Box {
    double west_deg = 0, east_deg = 0, south_deg = 0, north_deg = 0;
};

/// What CoverColumn says of the ground, at a net of places over a box and at steps of height: to be
/// interpolated between.
///
/// The net is as fine as the map's rain, 0.5 degrees, and has at least four places, its corners the
/// box's; over large boxes it is wider, so that there are at most kMostPlaces.
class CoverTable {
  public:
    static constexpr int kMostPlaces = 2500;
    static constexpr double kStep_m = 40;

    /// @param lowest_m, highest_m  of the heights that are asked for
    CoverTable(const ClimateMap& map, const Box& box, double lowest_m, double highest_m);

    int columns() const { return columns_; }  ///< from west to east
    int rows() const { return rows_; }        ///< from south to north
    int heights() const { return heights_; }  ///< upwards
    double step_m() const { return step_m_; }
    double lowest_m() const { return lowest_m_; }
    double highest_m() const { return lowest_m_ + step_m_ * (heights_ - 1); }

    /// Four numbers for each place and height, column after column, row after row, upwards: first
    /// of all the ground's, dryness(), growth(), green() on the day and the year's mean temperature
    /// [degC]; then, likewise, the snow's: the ice's balance with what mapped ice has over it [m of
    /// water a year], the share of level open ground that has snow on the day, and two zeros. That
    /// share is a mean over 100 m of height, as the edge of snow is ragged.
    std::vector<float> texels(double day) const;

  private:
    /// Of a place's texel; those of the snow have heights from heights() on.
    std::size_t index(std::size_t place, int height) const {
        return 4 * (static_cast<std::size_t>(height) * places_.size() + place);
    }

    int columns_ = 2, rows_ = 2, heights_ = 2;
    double lowest_m_ = 0, step_m_ = kStep_m;
    std::vector<CoverColumn> places_;  // row after row
    std::vector<float> fixed_;         // texels without what hangs on the day
};

}  // namespace relevo::climate
