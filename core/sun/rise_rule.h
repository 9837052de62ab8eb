#pragma once

#include <string>

#include "base/units.h"
#include "sun/body.h"
#include "sun/refraction.h"

namespace relevo::sun {

/// Which point of the disc rises and sets.
enum class Limb { Upper, Center, Lower };

/// When the sun or the moon counts as risen: one stated definition, which every result
/// carries as text.
class RiseRule {
  public:
    /// The centre at a true elevation (without air), by default 50 arc-minutes below the horizon:
    /// 34 for refraction and 16 for the semidiameter, the rule of the U.S. Naval Observatory and of
    /// almanacs.
    RiseRule() : RiseRule(at_center_elevation(kUsno_rad)) {}
    static RiseRule at_center_elevation(double true_elevation_rad);
    /// The rule of almanacs: for the sun that of the default, for the moon the upper limb 34
    /// arc-minutes below the horizon, with the semidiameter and parallax of the moment.
    static RiseRule almanac(Body body);

    /// What an eye sees: a point of the disc on the horizon of the sea or of a plain.
    /// @param eye_height_m  above that sea or plain, 0 to 10000: the horizon dips below the level
    ///     by 1.76 arc-minutes times the root of the metres (Nautical Almanac; refraction of the
    ///     line of sight included), without an atmosphere by 1.93
    /// @throws Error (BadInput) for a height that is none
    static RiseRule seen(Limb limb, const Refraction& refraction, double eye_height_m = 0,
                         Body body = Body::Sun);

    /// The same with the dip of the horizon below the level one given itself, as measured or from
    /// another table.
    /// @param dip_rad  0 to 5 degrees
    /// @throws Error (BadInput) for a dip that is none
    static RiseRule seen_over_dip(Limb limb, const Refraction& refraction, double dip_rad,
                                  Body body = Body::Sun);

    /// True elevation that the body's centre has at that moment, at this distance [rad].
    double center_elevation_rad(double distance_au) const;

    /// "sunrise and sunset: centre of the sun 50 arc-minutes below the horizon, without refraction
    /// (U.S. Naval Observatory)".
    const std::string& description() const { return description_; }

    static constexpr double kUsno_rad = radians(-50.0 / 60);

  private:
    struct Unset {};
    explicit RiseRule(Unset) {}
    RiseRule(Limb limb, const Refraction& refraction, double dip_rad, const std::string& dip_text,
             Body body);
    Body body_ = Body::Sun;
    double elevation_rad_ = 0;
    double semidiameters_ = 0;  // added to that of the centre: 1 upper limb, -1 lower limb
    std::string description_;
};

}  // namespace relevo::sun
