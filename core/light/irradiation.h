#pragma once

#include <array>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "light/clear_sky.h"
#include "light/ground_slope.h"
#include "light/sky.h"
#include "sun/position_table.h"

/// What posts get from the sun and the sky; a part of sun_hours().
namespace relevo::light {

/// What a post's ground does with beams, for the posts of a part, in the order of sweeps.
struct GroundForBeams {
    TileValues east, north;  ///< the rise of the ground
    TileValues air;  ///< of the post's height: 0 as at the lowest post of the DEM, 1 at the highest
    TileValues beam_wh;  ///< so far, of a square metre of the ground

    GroundForBeams(const DemSky& dem, const SweepWindow& part);
    GroundForBeams(TileValues rise_east, TileValues rise_north, TileValues of_air, TileValues given)
        : east(std::move(rise_east)),
          north(std::move(rise_north)),
          air(std::move(of_air)),
          beam_wh(std::move(given)) {}
    /// Some of it, turned so, with nothing given so far.
    GroundForBeams part(const SweepWindow& window, bool along_columns) const;
    void turn(bool along_columns);
};

/// How much of the air that is over the lowest post is not over a height: 0 there, 1 at the
/// highest.
double air_left(const DemSky& dem, double height_m);

/// The sun over a tile for a short time.
struct SunBeam {
    GridPair reference;
    glm::dvec3 at{0}, a_column{0}, a_row{0};  ///< towards it, local ENU: there, and its changes
    /// Beam irradiance there at heights from the lowest post to the highest one, `step_m` apart.
    std::array<float, 17> given{};
    double lowest_m = 0, step_m = 1;
    double more = 0;  ///< as share, for each unit that the sine of the elevation grows by
    double hours = 0;

    SunBeam(const SunSky& sky, const SunTile& tile, const ClearSky& clear, double time_h);
};

/// Adds what posts next to each other get between two moments: as long as their margins, linear
/// from one moment to the next, are over 0.
/// @param margin_m  at the first moment; those at the second are of the run
void add_beam(const SweepRun& run, const SunBeam& sun, const float* margin_m,
              GroundForBeams& ground);

/// Energy of the sun on level and open ground, over a DEM.
class OpenSky {
  public:
    /// @param table  of the sun for all of the time
    /// @param step_s apart are the suns that are summed up
    OpenSky(const DemSky& dem, const sun::PositionTable& table, sun::Instant begin, double length_s,
            double step_s, double linke);

    struct Energy {
        double beam_low_wh = 0, beam_high_wh = 0;  ///< at the lowest post and at the highest
        double diffuse_wh = 0;
    };
    Energy at(double column, double row) const;

  private:
    double column_step_, row_step_;
    int columns_, rows_;
    std::vector<Energy> nodes_;
};

}  // namespace relevo::light
