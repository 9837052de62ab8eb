#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "light/point/horizon.h"
#include "light/point/skyline.h"
#include "sun/events.h"
#include "sun/refraction.h"

namespace relevo::sun {
class PositionTable;
}

namespace relevo::light {

struct LightOptions {
    /// Whose light it is: of the moon's, with its own path, disc and days.
    sun::Body body = sun::Body::Sun;
    /// What of the disc must stand over the terrain: its centre; with Upper any part of the disc
    /// (first and last ray, wherever on the slope of a ridge it comes); with Lower all of it.
    sun::Limb limb = sun::Limb::Center;
    /// Of its light; none: integrated through the standard atmosphere over the place.
    std::optional<sun::Refraction> refraction = {};
    /// Rising and setting over a flat horizon, to compare with.
    sun::DayOptions flat = {};
};

/// When direct light begins or ends.
struct LightEdge {
    sun::Instant utc;
    double azimuth_rad = 0;    ///< of the sun's centre
    double elevation_rad = 0;  ///< of it, apparent
    bool midnight = false;     ///< no edge: the day begins or ends with the sun shining
};

struct LitInterval {
    LightEdge begin, end;
    /// Stretches of it, to 5 s, when the sun stands in a void of the DEM, lower than ground as high
    /// as the DEM's highest post would: whether it shines then is not known.
    std::vector<sun::TimeSpan> not_known = {};
    double length_s() const { return end.utc - begin.utc; }
    double not_known_s() const;
    /// There is light only because of voids.
    bool all_unknown() const { return !not_known.empty() && not_known_s() >= length_s() - 1e-3; }
};

/// Direct light on a local day.
struct LightDay {
    sun::Date date;
    sun::TimeSpan span;            ///< the local day
    std::vector<LitInterval> lit;  ///< in order; empty: the sun does not reach the point
    double lit_s = 0;              ///< together
    double not_known_s = 0;        ///< of it, for voids of the DEM
    /// The same day over a flat horizon; of the moon: its events, and when it is up.
    sun::Day flat;
};

/// When the sun, or the moon, shines on a point, over its own horizon.
///
/// Every stretch is found that is wider than 0.02 degrees of azimuth (5 s), and shadows likewise:
/// the horizon is tabulated that finely to find them, and computed exactly for their edges
/// (upper and lower limb: in the table).
///
/// Accuracy against an independent computation over 30 m SRTM: 1 s an edge, 2 s a day, 0.001 % of a
/// year (tests/light/test_direct_light.cpp prints it). Real air moves edges near the horizon by
/// many seconds; errors of the terrain move them by minutes.
class DirectLight {
  public:
    /// @param horizon  outlives this
    explicit DirectLight(const TerrainHorizon& horizon, const LightOptions& options = {});
    /// Over a horizon that is not a DEM's: a file's, or a level one. It is linear between the
    /// directions of the skyline.
    /// @param place  of the observer
    /// @param over   what definition() calls the horizon: "a level horizon"
    DirectLight(const geo::Geodetic& place, Skyline skyline, std::string_view over,
                const LightOptions& options = {});

    /// @throws Error (BadInput) as sun::day_events
    LightDay day(sun::Date date, const sun::Zone& zone,
                 const sun::EarthRotation& rotation = sun::EarthRotation::built_in()) const;

    /// All local days from `first` to `last`, without those that the zone skipped.
    std::vector<LightDay> days(
        sun::Date first, sun::Date last, const sun::Zone& zone,
        const sun::EarthRotation& rotation = sun::EarthRotation::built_in()) const;

    /// The light within any span of time, such as from midnight to midnight by the sun.
    std::vector<LitInterval> lit_within(const sun::TimeSpan& span) const;
    /// @param table  of the body, for the whole span
    std::vector<LitInterval> lit_within(const sun::TimeSpan& span,
                                        const sun::PositionTable& table) const;
    /// Whether it shines at one time. @param table  of the body, for that time
    bool lit_at(sun::Instant utc, const sun::PositionTable& table) const;

    /// Only of a DEM's.
    const TerrainHorizon& horizon() const { return *horizon_; }
    const Skyline& skyline() const { return skyline_; }
    /// Directions of the skyline, where a void of the DEM may hide higher ground; empty: none.
    const std::vector<bool>& holes() const { return holes_; }
    const sun::Observer& observer() const { return observer_; }
    const sun::Refraction& refraction() const { return refraction_; }
    sun::Limb limb() const { return options_.limb; }
    sun::Body body() const { return options_.body; }

    /// "direct light: centre of the sun over the terrain, integrated atmosphere, ...".
    const std::string& definition() const { return definition_; }

  private:
    friend class LightSearch;
    DirectLight(const TerrainHorizon& horizon, const LightOptions& options,
                const std::vector<HorizonPoint>& profile);

    void define(std::string_view over);

    const TerrainHorizon* horizon_ = nullptr;  // none: the skyline is the horizon
    LightOptions options_;
    Skyline skyline_;
    std::vector<double> hole_rad_;  // HorizonPoint's; empty: no hole matters
    std::vector<bool> holes_;
    sun::Observer observer_;
    sun::Refraction refraction_;
    std::string definition_;
};

}  // namespace relevo::light
