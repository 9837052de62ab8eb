#include "sun/rise_rule.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "sun/position.h"

namespace relevo::sun {

namespace {

double seen_dip_rad(double eye_height_m, bool air) {
    constexpr double kEarthRadius_m = 6'371'000;
    if (air) return radians(1.76 / 60) * std::sqrt(eye_height_m);
    return std::acos(kEarthRadius_m / (kEarthRadius_m + eye_height_m));
}

}  // namespace

RiseRule RiseRule::at_center_elevation(double true_elevation_rad) {
    RiseRule rule{Unset{}};
    rule.elevation_rad_ = true_elevation_rad;
    const double arcmin = degrees(true_elevation_rad) * 60;
    rule.description_ = fmt::format(
        "sunrise and sunset: centre of the sun {:.6g} arc-minutes {} the horizon, without "
        "refraction{}",
        std::abs(arcmin), arcmin < 0 ? "below" : "above",
        true_elevation_rad == kUsno_rad ? " (U.S. Naval Observatory)" : "");
    return rule;
}

RiseRule RiseRule::almanac(Body body) {
    if (body == Body::Sun) return {};
    RiseRule rule{Unset{}};
    rule.body_ = body;
    rule.elevation_rad_ = radians(-34.0 / 60);
    rule.semidiameters_ = 1;
    rule.description_ =
        "moonrise and moonset: upper limb of the moon 34 arc-minutes below the horizon, without "
        "refraction (U.S. Naval Observatory)";
    return rule;
}

RiseRule RiseRule::seen(Limb limb, const Refraction& refraction, double eye_height_m, Body body) {
    if (!(eye_height_m >= 0 && eye_height_m <= 10000))
        bad_input(fmt::format(
            "sunrise: eye height {:.10g} m: impossible, expected 0 to 10000 above the sea or plain",
            eye_height_m));
    const double dip_rad = seen_dip_rad(eye_height_m, refraction.bends());
    return {limb, refraction, dip_rad,
            eye_height_m > 0
                ? fmt::format(" as seen from {:.6g} m above it (dip {:.2f} arc-minutes)",
                              eye_height_m, degrees(dip_rad) * 60)
                : "",
            body};
}

RiseRule RiseRule::seen_over_dip(Limb limb, const Refraction& refraction, double dip_rad,
                                 Body body) {
    if (!(dip_rad >= 0 && dip_rad <= radians(5)))
        bad_input(
            fmt::format("sunrise: dip of the horizon {:.10g} degrees: impossible, expected 0 to 5",
                        degrees(dip_rad)));
    return {limb, refraction, dip_rad,
            fmt::format(" {:.2f} arc-minutes below the level one", degrees(dip_rad) * 60), body};
}

RiseRule::RiseRule(Limb limb, const Refraction& refraction, double dip_rad,
                   const std::string& dip_text, Body body)
    : body_(body),
      elevation_rad_(refraction.true_rad(-dip_rad)),
      semidiameters_(limb == Limb::Upper   ? 1
                     : limb == Limb::Lower ? -1
                                           : 0) {
    const char* part = limb == Limb::Upper   ? "upper limb"
                       : limb == Limb::Lower ? "lower limb"
                                             : "centre";
    const char* name = name_of(body);
    description_ = fmt::format("{0}rise and {0}set: {1} of the {0} on the horizon{2}, {3}", name,
                               part, dip_text, refraction.description());
}

double RiseRule::center_elevation_rad(double distance_au) const {
    if (semidiameters_ == 0) return elevation_rad_;
    return elevation_rad_ - semidiameters_ * semidiameter_rad(distance_au, body_);
}

}  // namespace relevo::sun
