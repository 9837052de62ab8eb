#pragma once

#include <array>
#include <optional>

#include "base/array2d.h"
#include "climate/climate_map.h"
#include "climate/cover_table.h"
#include "climate/earth_grids.h"

namespace relevo::climate {

/// What land is covered with.
enum class Land { Needleleaf, Broadleaf, Shrub, Grass, Crop, Bare, Urban, Wetland, Ice };
inline constexpr int kLands = 9;

/// Shares of the land that each cover has; they add up to 1, or are all 0 where nobody knows.
using LandShares = std::array<float, kLands>;
/// Linear sRGB.
using Colour = std::array<float, 3>;

/// Land cover over a box of the Earth, interpolated: shares in cells of 0.05 degrees, of which a
/// map tells only what most of a cell is, and the colour of the ground in cells of 0.2 degrees.
/// Boxes of more than 20 degrees have larger cells.
///
/// data/README.md has the sources, and what is known to be wrong.
/// Accuracy: the largest share of 130 of 132 known places is one that is right there, and the
/// colour of 6 of 7 measured places is within 35 % (tests/climate/test_land_map.cpp).
class LandMap {
  public:
    /// Reads what Relevo comes with.
    /// @throws Error (BadInput) `climate: path: ...` where the map is missing or damaged
    LandMap(const ClimateMap& climate, const Box& box);

    /// False where the map has nothing but sea.
    bool is_known() const { return known_; }
    LandShares shares(double lat_deg, double lon_deg) const;
    /// Share of a cell that is water, 0 to 1.
    float water(double lat_deg, double lon_deg) const;
    /// The colour of ground without snow; none where the map has none.
    std::optional<Colour> ground(double lat_deg, double lon_deg) const;
    /// How the ground's colour differs from what its covers usually have, as factors of 0.3 to 3.4;
    /// 1 where the map has no colour.
    Colour tint(double lat_deg, double lon_deg) const;

  private:
    /// Cells of latitude and longitude, the first row the northernmost.
    struct Net {
        double west_deg = 0, north_deg = 0, cell_deg = 1;
        int columns = 0, rows = 0;

        static Net over(const Box& box, double cell_deg, int margin);
        double lat_deg(int row) const { return north_deg - (row + 0.5) * cell_deg; }
        double lon_deg(int column) const { return west_deg + (column + 0.5) * cell_deg; }
        template <typename Value>
        Value at(const Array2d<Value>& cells, double lat_deg, double lon_deg) const;
    };

    void read_shares(EarthGrids& grids, const ClimateMap& climate);
    void spread_shares(std::array<Array2d<float>, kLands> lands);
    void read_ground(EarthGrids& grids);
    void find_tint(const ClimateMap& climate);

    Net net_, ground_net_;
    Array2d<LandShares> shares_;
    Array2d<float> water_;
    std::array<Array2d<float>, 3> ground_, tint_;  // of tint the logarithm to base 2
    Array2d<float> has_ground_;
    bool known_ = false;
};

}  // namespace relevo::climate
