#pragma once

#include <array>
#include <vector>

#include "light/raster/direction_table.h"
#include "light/raster/division.h"
#include "light/raster/irradiation.h"
#include "light/raster/sun_hours.h"
#include "sun/position_table.h"

namespace relevo::light {

/// Hours of sun of many days: every post's horizon is found in directions 2 degrees apart, and how
/// long the sun stood over what height there is looked up. Made ready once for a time.
class HorizonHours {
  public:
    /// @param terrain  outlives this
    /// @param window   posts that will be asked for
    HorizonHours(const SunTerrain& terrain, const Window& window, sun::Instant begin,
                 double length_s, const SunHoursOptions& options);

    /// Hours and beams of a part.
    void add(const Window& part, SunHours& result) const;
    int most_tiles() const;

  private:
    static constexpr std::size_t kDirections = 180;

    /// A direction in which the sun has been, as seen from a block.
    struct Direction {
        SunField field;  // as if the sun were level there in the middle of the block
        std::vector<SunTile> tiles;
        DirectionTable low, high;  // for the air of the lowest post, and of the highest one
    };
    /// Posts over which the sun is at its azimuth in the middle within what directions are apart.
    struct Block {
        Window window;
        std::vector<Direction> directions;
    };
    Block block_of(const Window& window, const Window& wanted) const;
    using Tables = std::array<std::array<DirectionTable, 2>, kDirections>;
    Tables tables_over(const geo::Geodetic& middle) const;
    struct Sample {
        double azimuth_rad, elevation_rad, hours;
        std::array<double, 2> apparent_rad, beam_wh;
    };
    Sample sample(double from_s, double until_s, const sun::Observer& observer) const;
    void add_direction(const Direction& direction, const Window& part, const InclinedGround* ground,
                       const Array2d<float>& air, SunHours& result) const;

    const SunTerrain& terrain_;
    SunHoursOptions options_;
    sun::Instant begin_;
    double length_s_;
    sun::PositionTable table_;
    std::vector<Block> blocks_;
};

}  // namespace relevo::light
