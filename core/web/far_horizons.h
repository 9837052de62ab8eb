#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dem/heightfield.h"
#include "dem/posts.h"
#include "dem/source.h"

/// The ground around a page's DEM, as horizons.
namespace relevo::web {

/// Horizons that the ground outside of a DEM makes for posts of it, and how far off they are: so
/// they hold for eyes higher and lower than those posts, too.
struct FarHorizons {
    static constexpr int kNodes = 33;      ///< sides of the net of posts, from corner to corner
    static constexpr int kAzimuths = 120;  ///< clockwise from true north
    /// Of a degree, apparent: by row, column and azimuth.
    std::vector<std::int16_t> hundredths;
    /// Distances in steps of 3 %, from kNearest_m on.
    std::vector<std::uint8_t> steps;
    static constexpr double kNearest_m = 100, kStep = 1.03;
};

/// The ground around a part of a DEM. Immutable.
class GroundAround {
  public:
    static constexpr double kReach_m = 60e3;        ///< ground farther away is left out
    static constexpr int kMostPosts = 2048 * 2048;  ///< else means

    /// What LoadOptions::crop cuts off; null: nothing.
    /// @param part  what it leaves
    /// @throws Error as dem::Source
    static std::unique_ptr<const GroundAround> of(std::span<const std::string> paths,
                                                  const dem::LoadOptions& options,
                                                  const dem::Grid& part);

    /// @param ground  of the page; eyes stand on it, and none of it counts
    FarHorizons horizons(const dem::Heightfield& ground) const;

  private:
    explicit GroundAround(dem::Heightfield field);
    dem::Heightfield field_;
    std::shared_ptr<const dem::Posts> posts_;
};

}  // namespace relevo::web
