#include "light/point/alignment.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/error.h"
#include "base/units.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

// The sky turns by 15.041 arcsec/s, the sun along the ecliptic by 0.04 more; refraction shortens
// ways. The moon's own way and its parallax are below 0.8 arcsec/s.
constexpr double kFastestWay_rad_s = 15.1 * kArcsecond_rad,
                 kFastestMoon_rad_s = 15.9 * kArcsecond_rad;
constexpr double kNear_s = 30;
constexpr double kClosest_s = 0.05;

glm::dvec3 direction(double azimuth_rad, double elevation_rad) {
    return {std::sin(azimuth_rad) * std::cos(elevation_rad),
            std::cos(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
}

/// Angle between two unit vectors; good for small ones, too.
double angle_rad(const glm::dvec3& a, const glm::dvec3& b) {
    return 2 * std::atan2(glm::length(a - b), glm::length(a + b));
}

/// The sun or the moon against a point that is seen from a place.
class Approach {
  public:
    Approach(sun::Body body, const TerrainHorizon& from, const Sight& sight,
             const sun::Refraction& refraction, sun::Instant begin, sun::Instant end)
        : from_(from),
          sight_(sight),
          refraction_(refraction),
          begin_(begin),
          table_(begin, end, body),
          observer_(from.place()),
          wanted_(direction(sight.azimuth_rad, sight.elevation_rad)) {}

    /// Between the sun's centre and the point. @param t_s  since the beginning
    double separation_rad(double t_s) const {
        const auto [azimuth_rad, elevation_rad] = sun_at(t_s);
        return angle_rad(direction(azimuth_rad, elevation_rad), wanted_);
    }

    /// When it is least, between two moments.
    double closest_s(double a, double b) const {  // golden section
        constexpr double kGolden = 0.6180339887498949;
        while (b - a > kClosest_s) {
            const double x = b - kGolden * (b - a), y = a + kGolden * (b - a);
            separation_rad(x) < separation_rad(y) ? b = y : a = x;
        }
        return (a + b) / 2;
    }

    Alignment passage(double t_s, const sun::Zone& zone) const {
        const auto [azimuth_rad, elevation_rad] = sun_at(t_s);
        Alignment passage;
        passage.utc = begin_ + t_s;
        passage.date = zone.local(passage.utc).wall.date;
        passage.separation_rad = separation_rad(t_s);
        passage.above_rad = elevation_rad - sight_.elevation_rad;
        passage.right_rad = std::remainder(azimuth_rad - sight_.azimuth_rad, 2 * kPi) *
                            std::cos(sight_.elevation_rad);
        passage.azimuth_rad = azimuth_rad;
        passage.elevation_rad = elevation_rad;
        const HorizonPoint horizon = from_.at(azimuth_rad);
        passage.sun_visible = elevation_rad > horizon.elevation_rad;
        passage.hole = passage.sun_visible && elevation_rad <= horizon.hole_rad;
        return passage;
    }

  private:
    /// Azimuth and apparent elevation.
    std::pair<double, double> sun_at(double t_s) const {
        const glm::dvec3 sun = table_.vector_au(begin_ + t_s, observer_);
        return {sun::azimuth_of(sun), refraction_.apparent_rad(sun::elevation_of(sun))};
    }

    const TerrainHorizon& from_;
    const Sight& sight_;
    const sun::Refraction& refraction_;
    sun::Instant begin_;
    sun::PositionTable table_;
    sun::Observer observer_;
    glm::dvec3 wanted_;
};

}  // namespace

Alignments alignments(const TerrainHorizon& from, const geo::Geodetic& target, sun::Date first,
                      sun::Date last, const sun::Zone& zone, const AlignmentOptions& options) {
    if (last < first)
        bad_input(fmt::format("sun when: from {} to {}: ends before it begins",
                              sun::to_string(first), sun::to_string(last)));
    if (!(options.tolerance_rad > 0 && options.tolerance_rad <= radians(45)))
        bad_input(fmt::format(
            "sun when: tolerance {:.10g} degrees: out of range, expected more than 0 and up to 45",
            degrees(options.tolerance_rad)));
    Alignments result;
    result.target = target;
    result.sight = from.sight(target);
    const sun::Refraction refraction =
        options.refraction ? *options.refraction : sun::Refraction::standard(from.place());
    result.definition = fmt::format(
        "closest approach of the {}'s centre to the point, within {:.4g} degrees; {}; terrestrial "
        "refraction k = {:.4g}",
        sun::name_of(options.body), degrees(options.tolerance_rad), refraction.description(),
        from.options().refraction);

    const sun::Instant begin = zone.day(first).begin, end = zone.day(last).end;
    const Approach approach(options.body, from, result.sight, refraction, begin, end);
    // Far from the target, the sun cannot come within the tolerance any sooner than this.
    const double fastest_rad_s =
        options.body == sun::Body::Moon ? kFastestMoon_rad_s : kFastestWay_rad_s;
    const double length_s = end - begin;
    double before_s = 0, t_s = 0;
    double before_rad = kPi, here_rad = approach.separation_rad(0);
    while (t_s < length_s) {
        const double step_s =
            std::max(kNear_s, (here_rad - options.tolerance_rad) / fastest_rad_s - kNear_s);
        const double next_s = std::min(t_s + step_s, length_s);
        const double next_rad = approach.separation_rad(next_s);
        if (here_rad <= before_rad && here_rad < next_rad) {
            const double at_s = approach.closest_s(before_s, next_s);
            if (approach.separation_rad(at_s) <= options.tolerance_rad)
                result.passages.push_back(approach.passage(at_s, zone));
        }
        before_s = t_s;
        before_rad = here_rad;
        t_s = next_s;
        here_rad = next_rad;
    }
    return result;
}

}  // namespace relevo::light
