#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "light/plane/transposition.h"
#include "light/point/direct_light.h"
#include "sun/time.h"
#include "sun/zone.h"

/// Irradiance on a plane, row by row of a table or hour by hour under a clear sky.
///
/// The rules. The sun is *up* as long as its part that counts (LightOptions::limb) stands over a
/// level horizon, and *lit* are the seconds of those in which it stands over the horizon that was
/// given. The direct normal irradiance of a row is spread evenly over the seconds in which the sun
/// is up; the beam is its mean over the lit ones, times the cosine of the incidence. A row that is
/// an instant is not spread: all of it counts, or nothing. The sky's model takes the sun in the
/// middle of the longest part of a row in which it is up. Under a horizon, circumsolar light is
/// multiplied by lit / up, the rest by what the plane sees of the sky, as a share of what it would
/// see over a level horizon; where the sun is not up, the sky is even. The plane sees ground
/// wherever it does not see sky, with a reflected irradiance of albedo times the global one.
namespace relevo::light {

/// Means over a time, or values of one instant in it [W/m2].
struct Irradiance {
    sun::TimeSpan span;
    double ghi = 0, dni = 0, dhi = 0;  ///< global level, direct normal, diffuse level
    std::size_t line = 0;              ///< of the file
};

struct PlaneOptions {
    Plane plane;
    SkyModel sky = SkyModel::Isotropic;
    double albedo = 0.2;
};

/// Means over an hour, or over a row's time [W/m2].
struct PlaneHour {
    sun::TimeSpan span;
    double up_s = 0, lit_s = 0;
    /// Of the sun's centre in the middle of the part in which it is up, as the light comes
    /// (refraction included); 0 where it is not up.
    double azimuth_rad = 0, elevation_rad = 0;
    double ghi = 0, dni = 0, dhi = 0;
    double beam = 0, diffuse = 0, reflected = 0;
    double open_global = 0;  ///< over a level horizon

    double global() const { return beam + diffuse + reflected; }
};

class PlaneLight {
  public:
    /// @param level    of the sun over a level horizon
    /// @param terrain  the same over the horizon; null: that is level. Both outlive this
    PlaneLight(const PlaneOptions& options, const DirectLight& level, const DirectLight* terrain);

    /// The share of an even sky that the plane sees, and that over a level horizon.
    double sky() const { return sky_; }
    double level_sky() const { return level_sky_; }

    struct Result {
        std::vector<PlaneHour> hours;  ///< a row each, in their order
        /// Direct light over the terrain, of times without a gap, in the order of time; none
        /// without terrain.
        std::vector<LightDay> lit;
    };
    /// @param rows       in their order; times may jump from one to the next
    /// @param instant_s  after a row's begin, when its values were; none: means
    /// @throws Error (BadInput) outside 1900-2100
    Result of(const std::vector<Irradiance>& rows, const std::optional<double>& instant_s) const;

    /// Under the clear sky of ClearSky, at the height of the place. Its irradiance follows the sun
    /// within the hour.
    /// @param hours  without gaps
    /// @param linke  turbidity at a time
    Result clear(const std::vector<sun::TimeSpan>& hours,
                 const std::function<double(sun::Instant)>& linke) const;

    /// What shows that the times of a table are not of this place.
    struct Misfit {
        std::size_t line;
        std::string what;
    };
    /// Direct irradiance in the night: more than 100 Wh/m2, and more than 1 % of all. Or: direct
    /// and diffuse irradiance give the global one three times as well with all times half an hour
    /// or an hour off, and only to 1.5 % or worse as they are; of tables with 5 kWh/m2 or more.
    std::optional<Misfit> misfit(const std::vector<Irradiance>& rows,
                                 const std::optional<double>& instant_s) const;

  private:
    struct Sun;
    Sun sun_at(const sun::PositionTable& table, sun::Instant utc) const;
    int day_of_year(sun::Instant utc) const;
    void add_instant(const sun::PositionTable& table, sun::Instant utc, PlaneHour& hour) const;
    void add_sky(const Sun& sun, double open_beam, PlaneHour& hour) const;
    template <typename Fill>
    Result by_runs(std::vector<PlaneHour> hours, const Fill& fill) const;

    PlaneOptions options_;
    const DirectLight& level_;
    const DirectLight* terrain_;
    double level_sky_, sky_;
};

enum class SumBy { Day, Month, Year, HourOfMonth };

/// Of hours that belong together [Wh/m2].
struct PlaneSum {
    sun::Date date;  ///< the first of them by the zone's clocks
    int hour = 0;    ///< the hour of the day in which they begin
    double lit_s = 0;
    double beam_wh = 0, diffuse_wh = 0, reflected_wh = 0, open_global_wh = 0;

    double global_wh() const { return beam_wh + diffuse_wh + reflected_wh; }
};

/// In the order in which they begin; an hour belongs to the time in which it begins.
/// @param typical  months of different years are one year
std::vector<PlaneSum> sums_by(SumBy by, const std::vector<PlaneHour>& hours, const sun::Zone& zone,
                              bool typical);

}  // namespace relevo::light
