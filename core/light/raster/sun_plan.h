#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "light/raster/division.h"
#include "light/raster/sun_field.h"
#include "sun/time.h"

namespace relevo::light {

/// A sun over a DEM, and the tiles over each of which it is one.
struct PlannedSun {
    double at_s = 0;  ///< when, from the beginning
    SunField field;
    double semidiameter_rad = 0;
    std::vector<SunTile> tiles{};  ///< of night, where no post sees the sun
    /// The same sun over the wider DEM around, where there is one.
    std::shared_ptr<const PlannedSun> around{};
};

/// What is found of a DEM once a run, before any of its posts is looked at: the suns asked for, the
/// air, and the tiles of every sun with their rays and the way that sweeps go over them. Each part
/// of a raster is made with the same plan, so that its bits are the whole raster's.
class SunPlan {
  public:
    /// @param posts   outlive this. All ground of their Posts::surroundings() shades them, too, but
    ///     for what lies on their own DEM
    /// @param window  posts that will be asked for; without columns: all
    /// @throws Error (BadInput) where the surroundings do not contain all of them
    SunPlan(const dem::Posts& posts, const LightPath& path, const Window& window,
            bool with_discs = false);

    /// Suns that stand so over a place.
    /// @throws Error (BadInput) as divide()
    void add_suns(const geo::Geodetic& place, const std::vector<SunOverDem>& suns);
    /// Directions from true north at every post.
    void add_directions(const std::vector<double>& azimuth_rad, double tolerance_rad);
    /// Directions of suns that are level in the middle of each of the blocks(), from true north
    /// there: unlike true north itself they are smooth over a pole.
    void add_level_directions(const std::vector<double>& azimuth_rad, double tolerance_rad);
    /// Parts of a DEM that are small enough for one place to stand for all of them.
    static std::vector<Window> blocks(const SunTerrain& terrain);
    /// The suns of a time, `step_s` apart, and closer to each other while the sun is near the
    /// horizon: how far off what hides it lies changes there with every minute, and clearances are
    /// not linear. Suns that no post sees are left out, but for the last one before each sunrise
    /// and the first one after each sunset, which have the light end where it does.
    void add_time(sun::Instant begin, double length_s, double step_s);

    /// A sun or a direction that none of the above adds.
    /// @param window  of the terrain's grid, over which it is divided
    PlannedSun planned(SunField field, const Window& window, double tolerance_rad) const;

    const SunTerrain& terrain() const { return *terrain_; }
    const Window& window() const { return window_; }  ///< on the terrain's grid
    const std::vector<PlannedSun>& suns() const { return suns_; }
    /// Into how many tiles a sun is divided at most.
    int most_tiles() const;

    /// How many steps near the horizon one elsewhere is divided into: three, or as many as makes
    /// them a minute at most.
    static int finer(double step_s) {
        return std::max(3, static_cast<int>(std::ceil(step_s / 60)));
    }

  private:
    std::shared_ptr<const PlannedSun> sun_around(const PlannedSun& sun, double tolerance_rad) const;
    void divide_all(std::size_t first, const Window& window, double tolerance_rad);

    std::unique_ptr<const SunTerrain> terrain_, around_;  // SunField has their addresses
    Window window_;
    std::vector<PlannedSun> suns_;
};

}  // namespace relevo::light
