#pragma once

#include <functional>
#include <vector>

#include "base/array2d.h"
#include "climate/cover_table.h"
#include "climate/relief_rain.h"

namespace relevo::climate {

/// A CoverTable with what is known finer than the climate is: rain by relief, on islands and coasts
/// in the trade winds, and ground without ice in Antarctica, where the map of ice has none.
/// Elsewhere it is the table.
class FineCover {
  public:
    /// Of the ground [m]; NaN where there is none.
    using Heights = std::function<float(const geo::Geodetic&)>;

    /// @param table  of the box; must outlive this
    FineCover(const ClimateMap& map, const Box& box, const CoverTable& table,
              const Heights& height_m);

    int columns() const { return fine_ ? columns_ : table_.columns(); }  ///< from west to east
    int rows() const { return fine_ ? rows_ : table_.rows(); }           ///< from south to north
    /// As CoverTable has them, at these places.
    std::vector<float> texels(double day) const;

  private:
    void refine_rain(const Box& box, const Heights& height_m);
    void refine_ice(const ClimateMap& map, const Box& box);
    geo::Geodetic place_of(const Box& box, int column, int row) const;

    const CoverTable& table_;
    int columns_, rows_;  // of the finer net
    bool fine_ = false;
    TradeWind wind_;
    Array2d<float> rain_;  // factors
    Array2d<float> ice_;   // mapped share; empty: as the table has it
};

}  // namespace relevo::climate
