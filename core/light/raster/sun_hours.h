#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/array2d.h"
#include "dem/posts.h"
#include "light/plane/transposition.h"
#include "light/raster/sun_plan.h"
#include "sun/refraction.h"
#include "sun/time.h"

namespace relevo::light {

struct SunHoursOptions {
    /// Terrestrial refraction, as in HorizonOptions.
    double refraction = 0.13;
    /// The air over a place at its height; none: the sun is where it is without air.
    std::function<sun::Refraction(const geo::Geodetic&)> air;
    /// Of a time of at most kMostDays: from one position of the sun to the next. Between two,
    /// margins are linear.
    double step_s = 180;
    /// Of such a time: when each post is lit first and last, and how often, too.
    bool spells = false;
    /// What the ground gets of sun and sky, as it is inclined, through air without clouds.
    struct Irradiation {
        double linke = 3;              ///< turbidity of the air, as in ClearSky
        double albedo = 0.2;           ///< of the ground around
        int sky_directions = 36;       ///< of the sky view, as in SkyViewOptions
        std::optional<Plane> plane{};  ///< in this position at each post, instead of the ground
    };
    std::optional<Irradiation> irradiation;
    Window part{};                     ///< as in ShadowOptions
    std::function<void(double)> done;  ///< likewise
    /// Only to measure the time: visits suns in an order of which any beginning has low and high
    /// ones, as low ones take longer. Results are meaningless.
    bool mixes_suns = false;

    /// Beyond this time, every post's horizon is found in directions that are 2 degrees apart, at a
    /// cost that does not grow with the time.
    static constexpr double kMostDays = 4;
};

/// For how long each post of a DEM lies in the sun.
struct SunHours {
    Array2d<float> hours;  ///< that the centre of the disc is over the terrain; NaN in holes
    /// With SunHoursOptions::spells, else empty: hours from the beginning to the first and to the
    /// last light, NaN where there is none.
    Array2d<float> first_h, last_h;
    /// With SunHoursOptions::spells: how often light comes, or is there from the beginning.
    Array2d<float> spells;
    /// With SunHoursOptions::irradiation, else empty: kilowatt-hours on a square metre of the
    /// ground. Beams of the sun, while its centre is over the terrain; the sky's light, by the
    /// sky-view factor; and what ground of the same light throws back from the rest.
    Array2d<float> beam_kwh, diffuse_kwh, reflected_kwh;
    double mean_hours = 0;
    double level_hours = 0;       ///< that it is over a level horizon in the middle of the DEM
    double most_level_hours = 0;  ///< the most anywhere on the DEM
    std::int64_t holes = 0;
    /// Into how many tiles the DEM was divided at most, each with a sun of its own.
    int tiles = 0;
    std::string definition;  ///< a sentence, to be printed with results
};

/// Hours of sun over a DEM: made ready once for a time, then found part by part.
///
/// What shades is what shades in shadows(), for every sun from `begin` to `end`. Irradiation by
/// ClearSky: the beam's is summed up with the shade of every sun, of many days for each direction;
/// diffuse light comes alike from all of the open sky.
///
/// Accuracy, speed: docs/accuracy-sun-rasters.md, tests/light/test_sun_hours.cpp,
/// test_clear_sky.cpp, bench_light.
class SunHoursPlan {
  public:
    /// @param posts    outlive this
    /// @param options  its `part` is the window in which parts will be asked for
    /// @throws Error (BadInput) as shadows(), for an end that is not after the beginning, for a
    /// step
    ///     that is not from 1 s to an hour, for times outside 1900-2100
    SunHoursPlan(const dem::Posts& posts, sun::Instant begin, sun::Instant end,
                 const SunHoursOptions& options);
    ~SunHoursPlan();
    SunHoursPlan(const SunHoursPlan&) = delete;
    SunHoursPlan& operator=(const SunHoursPlan&) = delete;

    /// The figures of a part; without columns: of all. They are those, to the bit, that its posts
    /// have among all.
    SunHours part(const Window& window = {}) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// All of them at once.
SunHours sun_hours(const dem::Posts& posts, sun::Instant begin, sun::Instant end,
                   const SunHoursOptions& options = {});

}  // namespace relevo::light
