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

    /// Of each place and height, column after column, row after row, upwards: dryness(), growth(),
    /// the ice's balance with what mapped ice has over it [m of water a year], and the share of
    /// level open ground that has snow on the day. That is a mean over 100 m of height, as the edge
    /// of snow is ragged.
    std::vector<float> texels(double day) const;

  private:
    std::size_t index(int column, int row, int height) const {
        return (static_cast<std::size_t>(height) * static_cast<std::size_t>(rows_) +
                static_cast<std::size_t>(row)) *
                   static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }

    int columns_ = 2, rows_ = 2, heights_ = 2;
    double lowest_m_ = 0, step_m_ = kStep_m;
    std::vector<CoverColumn> places_;  // row after row
    std::vector<float> fixed_;         // texels without the snow
};

}  // namespace relevo::climate
