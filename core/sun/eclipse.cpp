#include "sun/eclipse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <erfa.h>
#include <erfam.h>
#include <glm/geometric.hpp>

#include "base/golden_section.h"
#include "base/sign_change.h"
#include "base/units.h"
#include "sun/moon.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::sun {
namespace {

constexpr double kEquatorRadius_m = 6'378'137;  // equatorial, which k counts in
constexpr double kPenumbralMoon_m = 0.2725076 * kEquatorRadius_m;
constexpr double kUmbralMoon_m = 0.2722810 * kEquatorRadius_m;
const double kSun_au = std::sin(959.63 * kArcsecond_rad);

constexpr double kSynodicMonth_s = 29.530588861 * kDay_s;
/// No place on Earth sees an eclipse so long before or after conjunction.
constexpr double kReach_s = 6 * 3600;
constexpr double kSample_s = 300;
constexpr double kRoot_s = 1e-3;

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The two discs as they stand in the sky.
struct Discs {
    glm::dvec3 sun_au{0};  // local ENU
    double sun_rad = 0, penumbral_moon_rad = 0, umbral_moon_rad = 0, separation_rad = 0;

    Discs(const glm::dvec3& sun, const glm::dvec3& moon)
        : sun_au(sun),
          sun_rad(std::asin(kSun_au / glm::length(sun))),
          penumbral_moon_rad(std::asin(kPenumbralMoon_m / (ERFA_DAU * glm::length(moon)))),
          umbral_moon_rad(std::asin(kUmbralMoon_m / (ERFA_DAU * glm::length(moon)))),
          separation_rad(angle_between(sun, moon)) {}

    double magnitude() const {
        return (sun_rad + penumbral_moon_rad - separation_rad) / (2 * sun_rad);
    }
    /// Above 0 between second and third contact.
    double depth_rad() const { return std::abs(umbral_moon_rad - sun_rad) - separation_rad; }
    /// Valleys of the limb let light through until second contact.
    double visible() const { return visible_fraction(sun_rad, umbral_moon_rad, separation_rad); }
};

/// Sun and moon over a place, around a conjunction.
class EclipseSky {
  public:
    EclipseSky(Instant middle, const geo::Geodetic& place, const EarthRotation& rotation)
        : begin_(middle - kReach_s),
          observer_(place),
          sun_(begin_, middle + kReach_s, rotation),
          moon_(begin_, middle + kReach_s, rotation, Body::Moon) {}

    Discs at(double t_s) const {
        const Instant utc = begin_ + t_s;
        return {sun_.vector_au(utc, observer_), moon_.vector_au(utc, observer_)};
    }
    Instant utc(double t_s) const { return begin_ + t_s; }
    EclipseMoment moment(double t_s) const {
        const Discs discs = at(t_s);
        return {utc(t_s), azimuth_of(discs.sun_au), elevation_of(discs.sun_au), discs.magnitude(),
                1 - discs.visible()};
    }

    /// The time of the largest magnitude, around the largest of many samples.
    double greatest_s() const {
        constexpr int kSamples = static_cast<int>(2 * kReach_s / kSample_s);
        const auto magnitude = [this](double t_s) { return at(t_s).magnitude(); };
        double best_s = 0, best = -1e9;
        for (int i = 0; i <= kSamples; ++i) {
            const double here = magnitude(i * kSample_s);
            if (here <= best) continue;
            best = here;
            best_s = i * kSample_s;
        }
        return highest_place(magnitude, std::max(0.0, best_s - kSample_s),
                             std::min(2 * kReach_s, best_s + kSample_s), 0.01);
    }

    /// Where `f` of the discs turns from below 0 to above between an outer time and an inner one.
    template <typename F>
    double contact_s(const F& f, double outer_s, double inner_s) const {
        const auto at_time = [&](double t_s) { return f(at(t_s)); };
        const double a = std::min(outer_s, inner_s), b = std::max(outer_s, inner_s);
        return sign_change(at_time, a, at_time(a), b, at_time(b), kRoot_s);
    }

  private:
    Instant begin_;
    Observer observer_;
    PositionTable sun_, moon_;
};

std::optional<SolarEclipse> eclipse_near(Instant conjunction, const geo::Geodetic& place,
                                         const EarthRotation& rotation) {
    const EclipseSky sky(conjunction, place, rotation);
    const double greatest_s = sky.greatest_s();
    const auto magnitude = [](const Discs& discs) { return discs.magnitude(); };
    if (magnitude(sky.at(greatest_s)) <= 0) return std::nullopt;
    // The discs approach each other for no more than two hours.
    const auto outside = [&](double step_s) {
        double t_s = greatest_s;
        while (magnitude(sky.at(t_s)) > 0)
            t_s += step_s;
        return t_s;
    };
    SolarEclipse eclipse;
    const double first_s = sky.contact_s(magnitude, outside(-kSample_s), greatest_s);
    const double last_s = sky.contact_s(magnitude, outside(kSample_s), greatest_s);
    eclipse.first = sky.moment(first_s);
    eclipse.greatest = sky.moment(greatest_s);
    eclipse.last = sky.moment(last_s);
    const Discs discs = sky.at(greatest_s);
    if (discs.depth_rad() > 0) {
        const auto depth = [](const Discs& d) { return d.depth_rad(); };
        eclipse.kind =
            discs.umbral_moon_rad > discs.sun_rad ? EclipseKind::Total : EclipseKind::Annular;
        eclipse.second = sky.moment(sky.contact_s(depth, first_s, greatest_s));
        eclipse.third = sky.moment(sky.contact_s(depth, last_s, greatest_s));
    }
    return eclipse;
}

/// From the Earth's centre [au], celestial axes of J2000; good to an arc-minute, and also a month
/// outside of 1900-2100: enough to see whether there may be an eclipse.
struct RoughPlaces {
    glm::dvec3 sun, moon;
    double earth_rotation_rad;

    explicit RoughPlaces(Instant utc) {
        const double utc_d = (utc - Instant()) / kDay_s;  // TT and UT1 are within minutes of it
        double helio[2][3], bary[2][3], body[2][3];
        eraEpv00(kUnixEpoch_jd, utc_d, helio, bary);
        sun = {-helio[0][0], -helio[0][1], -helio[0][2]};
        eraMoon98(kUnixEpoch_jd, utc_d, body);
        moon = {body[0][0], body[0][1], body[0][2]};
        earth_rotation_rad = eraEra00(kUnixEpoch_jd, utc_d);
    }
};

/// How far from conjunction.
struct Syzygy {
    double longitude_rad, latitude_rad;  // of the moon from the sun, ecliptic of J2000

    explicit Syzygy(Instant utc) {
        const RoughPlaces places(utc);
        double sun[]{places.sun.x, places.sun.y, places.sun.z};
        double moon[]{places.moon.x, places.moon.y, places.moon.z};
        double to_ecliptic[3][3], sun_ecliptic[3], moon_ecliptic[3];
        eraIr(to_ecliptic);
        eraRx(84381.406 * kArcsecond_rad, to_ecliptic);
        eraRxp(to_ecliptic, sun, sun_ecliptic);
        eraRxp(to_ecliptic, moon, moon_ecliptic);
        longitude_rad = std::remainder(std::atan2(moon_ecliptic[1], moon_ecliptic[0]) -
                                           std::atan2(sun_ecliptic[1], sun_ecliptic[0]),
                                       2 * kPi);
        latitude_rad = std::asin(moon_ecliptic[2] / eraPm(moon_ecliptic));
    }
};

/// The conjunction in longitude next to a time, within a minute.
Instant conjunction_near(Instant near) {
    for (int pass = 0; pass < 20; ++pass) {
        const double ahead_s = -Syzygy(near).longitude_rad / (2 * kPi) * kSynodicMonth_s;
        near = near + ahead_s;
        if (std::abs(ahead_s) < 30) break;
    }
    return near;
}

/// Beyond this latitude at conjunction the moon's shadow misses the Earth: 1 degree 35 arc-minutes
/// at most (Meeus, Astronomical Algorithms, 54).
constexpr double kLatitudeLimit_rad = radians(1.7);

/// Whether the discs may touch at a place around a conjunction: much faster than
/// eclipse_near().
bool may_touch(Instant conjunction, const geo::Geodetic& place) {
    // The discs' sum is up to 0.56 degrees; the moon moves by up to 0.11 degrees in half a step,
    // and precession since J2000 and time leave less than 0.05.
    constexpr double kNear_rad = radians(0.8), kStep_s = 900;
    const glm::dvec3 itrs = Observer(place).position_au();
    for (double t_s = -kReach_s; t_s <= kReach_s; t_s += kStep_s) {
        const RoughPlaces places(conjunction + t_s);
        const double c = std::cos(places.earth_rotation_rad),
                     s = std::sin(places.earth_rotation_rad);
        const glm::dvec3 eye(c * itrs.x - s * itrs.y, s * itrs.x + c * itrs.y, itrs.z);
        if (angle_between(places.sun - eye, places.moon - eye) < kNear_rad) return true;
    }
    return false;
}

}  // namespace

double visible_fraction(double sun_rad, double moon_rad, double separation_rad) {
    const double d = separation_rad, s = sun_rad, m = moon_rad;
    if (d >= s + m) return 1;
    if (d <= m - s) return 0;
    if (d <= s - m) return 1 - m * m / (s * s);
    // Two circular segments over the common chord.
    const double of_sun = std::acos(std::clamp((d * d + s * s - m * m) / (2 * d * s), -1.0, 1.0));
    const double of_moon = std::acos(std::clamp((d * d + m * m - s * s) / (2 * d * m), -1.0, 1.0));
    const double covered =
        s * s * (of_sun - std::sin(2 * of_sun) / 2) + m * m * (of_moon - std::sin(2 * of_moon) / 2);
    return std::clamp(1 - covered / (kPi * s * s), 0.0, 1.0);
}

double sun_visible_fraction(const Position& sun, const MoonPosition& moon) {
    return Discs(sun.direction * sun.distance_au, moon.direction * moon.distance_au).visible();
}

std::string_view name_of(EclipseKind kind) {
    constexpr std::array<std::string_view, 3> kNames{"partial", "annular", "total"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::vector<SolarEclipse> solar_eclipses(Instant from, Instant to, const geo::Geodetic& place,
                                         const EarthRotation& rotation) {
    std::vector<SolarEclipse> found;
    for (Instant conjunction = conjunction_near(from - kSynodicMonth_s / 2);
         conjunction < to + kReach_s;
         conjunction = conjunction_near(conjunction + kSynodicMonth_s)) {
        if (conjunction < from - kReach_s) continue;
        if (std::abs(Syzygy(conjunction).latitude_rad) > kLatitudeLimit_rad) continue;
        if (!may_touch(conjunction, place)) continue;
        const auto eclipse = eclipse_near(conjunction, place, rotation);
        if (eclipse && eclipse->last.utc >= from && eclipse->first.utc <= to)
            found.push_back(*eclipse);
    }
    return found;
}

std::optional<EclipseMoment> greatest_within(const SolarEclipse& eclipse,
                                             const std::vector<TimeSpan>& spans,
                                             const geo::Geodetic& place,
                                             const EarthRotation& rotation) {
    // The magnitude grows until the greatest eclipse and falls after it.
    std::optional<Instant> before, after;
    for (const TimeSpan& span : spans) {
        const Instant begin = std::max(span.begin, eclipse.first.utc);
        const Instant end = std::min(span.end, eclipse.last.utc);
        if (begin >= end) continue;
        const Instant nearest = std::clamp(eclipse.greatest.utc, begin, end);
        if (nearest == eclipse.greatest.utc) return eclipse.greatest;
        if (nearest < eclipse.greatest.utc)
            before = std::max(before.value_or(nearest), nearest);
        else
            after = std::min(after.value_or(nearest), nearest);
    }
    if (!before && !after) return std::nullopt;
    const EclipseSky sky(eclipse.greatest.utc, place, rotation);
    std::optional<EclipseMoment> best;
    for (const auto& utc : {before, after}) {
        if (!utc) continue;
        const EclipseMoment here = sky.moment(*utc - (eclipse.greatest.utc - kReach_s));
        if (!best || here.magnitude > best->magnitude) best = here;
    }
    return best;
}

}  // namespace relevo::sun
