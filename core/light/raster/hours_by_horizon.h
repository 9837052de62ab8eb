#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
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
    /// @param plan  of the posts that will be asked for; outlives this
    HorizonHours(const SunPlan& plan, sun::Instant begin, double length_s,
                 const SunHoursOptions& options);

    /// Hours and beams of a part.
    void add(const Window& part, SunHours& result) const;
    int most_tiles() const;

  private:
    static constexpr std::size_t kDirections = 180;

    /// For the air of the lowest post, and of the highest one.
    using AirTables = std::array<DirectionTable, 2>;
    using Tables = std::vector<AirTables>;  // of each direction
    /// A direction in which the sun has been, as seen from a block.
    struct Direction {
        std::size_t number;
        PlannedSun sun;  // as if it were level there in the middle of the block
    };
    /// Posts over which the sun is at its azimuth in the middle within what directions are apart.
    struct Block {
        Window window;
        geo::Geodetic middle;
        std::vector<Direction> directions{};
    };
    Block block_of(const Window& window) const;
    /// Those of the blocks that were asked for last are kept: as many as meet in a corner, so that
    /// a part of a raster finds those that the part before it had.
    std::shared_ptr<const Tables> tables_of(const Block& block) const;
    Tables tables_over(const geo::Geodetic& middle) const;
    struct Sample {
        double azimuth_rad, elevation_rad, hours;
        std::array<double, 2> apparent_rad, beam_wh;
    };
    Sample sample(double from_s, double until_s, const sun::Observer& observer) const;
    /// What a part's posts are besides their heights, for beams.
    struct Ground {
        WindowHeights heights;
        std::optional<InclinedGround> inclined;
        Array2d<float> air{};
    };
    void add_direction(const Direction& direction, const AirTables& tables, const Window& part,
                       const Ground& ground, SunHours& result) const;

    const SunPlan& plan_;
    const SunTerrain& terrain_;
    SunHoursOptions options_;
    sun::Instant begin_;
    double length_s_;
    sun::PositionTable table_;
    std::vector<Block> blocks_;
    mutable std::mutex mutex_;
    static constexpr std::size_t kMostKept = 4;
    mutable std::vector<std::pair<Window, std::shared_ptr<const Tables>>> kept_;  // last one first
};

}  // namespace relevo::light
