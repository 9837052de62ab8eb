#include "light/point/clear_sky.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace relevo::light {
namespace {

/// Of a clean dry air, for each air mass.
double rayleigh_thickness(double mass) {
    if (mass > 20) return 1 / (10.4 + 0.718 * mass);
    const double m = mass;
    return 1 / (6.6296 + m * (1.7513 + m * (-0.1202 + m * (0.0065 - 0.00013 * m))));
}

double air_mass(double elevation_rad, double height_m) {
    const double h = elevation_rad;
    const double lifted_deg = degrees(h + 0.061359 * (0.1594 + h * (1.123 + 0.065656 * h)) /
                                              (1 + h * (28.9344 + 277.3971 * h)));
    const double pressure = std::exp(-height_m / 8434.5);  // in that at sea level
    return pressure /
           (std::sin(radians(lifted_deg)) + 0.50572 * std::pow(lifted_deg + 6.07995, -1.6364));
}

}  // namespace

ClearSky::ClearSky(double linke, double distance_au)
    : linke_(linke), outside_(kSolarConstant / (distance_au * distance_au)) {
    const double t = linke;
    transmission_ = -0.015843 + t * (0.030543 + 0.0003797 * t);
    const double a1 = 0.26463 + t * (-0.061581 + 0.0031408 * t);
    a1_ = a1 * transmission_ < 0.0022 ? 0.0022 / transmission_ : a1;
    a2_ = 2.04020 + t * (0.018945 - 0.011161 * t);
    a3_ = -1.3025 + t * (0.039231 + 0.0085079 * t);
}

double ClearSky::beam(double elevation_rad, double height_m) const {
    if (elevation_rad <= 0) return 0;
    const double mass = air_mass(elevation_rad, height_m);
    return outside_ * std::exp(-0.8662 * linke_ * mass * rayleigh_thickness(mass));
}

double ClearSky::diffuse(double elevation_rad) const {
    if (elevation_rad <= 0) return 0;
    const double s = std::sin(elevation_rad);
    return std::max(0.0, outside_ * transmission_ * (a1_ + s * (a2_ + a3_ * s)));
}

}  // namespace relevo::light
