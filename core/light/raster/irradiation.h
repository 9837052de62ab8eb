#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "light/point/clear_sky.h"
#include "light/raster/ground_slope.h"
#include "light/raster/sun_hours.h"
#include "light/raster/sun_plan.h"
#include "sun/position_table.h"

/// What posts get from the sun and the sky; a part of sun_hours().
namespace relevo::light {

/// How much of the air that is over the lowest post is not over a height: 0 there, 1 at the
/// highest.
double air_left(const SunTerrain& terrain, double height_m);

/// What the ground of a window does with beams.
struct InclinedGround {
    Window window;
    GroundSlope slope;

    /// @param plane  instead of the ground as it is
    InclinedGround(const SunTerrain& terrain, const Window& of, const std::optional<Plane>& plane)
        : window(of),
          slope(plane ? GroundSlope(terrain, of, *plane)
                      : GroundSlope(terrain, WindowHeights(terrain.posts(), of), of)) {}
};

/// Places all over a DEM, for what changes slowly over the Earth.
class Nodes {
  public:
    explicit Nodes(const SunTerrain& terrain);

    int count() const { return columns_ * rows_; }
    glm::dvec2 post(int node) const {
        return {first_column_ + node % columns_ * column_step_, node / columns_ * row_step_};
    }
    /// The nodes around a post, and their weights.
    struct Around {
        std::array<std::size_t, 4> node;
        std::array<double, 4> weight;
    };
    Around around(double column, double row) const;

  private:
    int first_column_;  // of the DEM as it is
    double column_step_, row_step_;
    int columns_, rows_;
};

/// The beams of the sun between two moments.
class SunBeams {
  public:
    /// @param table     of the sun for all of the time
    /// @param before_s  the first moment, from the table's beginning; the second one is the sun's
    SunBeams(const SunTerrain& terrain, const sun::PositionTable& table, double before_s,
             double at_s, double linke);

    /// Adds what posts get: as long as their clearances, linear from one moment to the next, are
    /// over 0.
    /// @param clearance_m  at the first moment; shadows of the second are of the run
    void add(const SweepRun& run, const float* height_m, const float* clearance_m,
             const InclinedGround& ground, float* beam_wh) const;

  private:
    static constexpr std::size_t kHeights = 17;
    struct Beam {
        double sine = 0;  // of the sun's elevation
        /// Irradiance at heights from the lowest post to the highest one, `step_m_` apart.
        std::array<float, kHeights> given{};
        double more = 0;  // as share, for each unit that the sine of the elevation grows by
    };
    double sine(double column, double row) const;
    float gain_of(const Beam& beam, float sine, float height_m, float before, float now,
                  const glm::vec3& gradient) const;

    Nodes nodes_;
    std::vector<Beam> beams_;
    glm::vec3 direction_{0};  // towards the sun, of SunTerrain::frame()
    double lowest_m_, step_m_, hours_;
};

/// Energy of the sun on level and open ground, over a DEM.
class OpenSky {
  public:
    OpenSky(const SunTerrain& terrain, sun::Instant begin, double length_s, double linke);

    struct Energy {
        double beam_low_wh = 0, beam_high_wh = 0;  ///< at the lowest post and at the highest
        double diffuse_wh = 0;
    };
    Energy at(double column, double row) const;

  private:
    Nodes nodes_;
    std::vector<Energy> energies_;
};

/// The light of the sky and of the ground around: made ready once for a time.
class SkyLight {
  public:
    SkyLight(const SunTerrain& terrain, sun::Instant begin, double length_s,
             const SunHoursOptions& options);

    /// Adds it to a result that has hours and beams.
    /// @param part  as SunHoursPlan::part()
    void add(const Window& part, SunHours& result) const;

  private:
    SunHoursOptions options_;
    SunPlan plan_;
    OpenSky open_;
};

}  // namespace relevo::light
