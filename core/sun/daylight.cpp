#include "sun/daylight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::sun {
namespace {

constexpr double kScaleHeight_m = 8430;  // of the air's pressure
constexpr double kSolarRadius_rad = radians(0.2666);
constexpr double kNightIlluminance_lux = 0.002;

/// Optical depths of the vertical atmosphere at sea level, for red, green and blue.
struct OpticalDepths {
    glm::dvec3 rayleigh, ozone, aerosol;
};

OpticalDepths optical_depths() {
    constexpr std::array<double, 3> kWavelength_um{0.610, 0.550, 0.465};
    constexpr std::array<double, 3> kOzone_per_cm{0.120, 0.085, 0.0075};
    constexpr double kOzone_cm = 0.300;
    OpticalDepths depths{};
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double w2 = 1 / (kWavelength_um[k] * kWavelength_um[k]);
        depths.rayleigh[i] = 0.008569 * w2 * w2 * (1 + 0.0113 * w2 + 0.00013 * w2 * w2);
        depths.ozone[i] = kOzone_per_cm[k] * kOzone_cm;
        depths.aerosol[i] = 0.04 * std::pow(kWavelength_um[k], -1.3);
    }
    return depths;
}

/// Share of a disc that is above a level horizon, its centre `elevation` over it.
double risen_share(double elevation_rad) {
    const double x = std::clamp(elevation_rad / kSolarRadius_rad, -1.0, 1.0);
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi;
}

/// Seidelmann's illuminance of level ground by the sun and its sky [lux], from +5 to -18 degrees.
double twilight_illuminance_lux(double elevation_deg) {
    struct Piece {
        double from_deg;
        std::array<double, 4> l;
    };
    constexpr std::array<Piece, 4> kPieces{Piece{-0.8, {2.88, 22.26, -207.64, 1034.30}},
                                           Piece{-5, {2.88, 21.81, -258.11, -858.36}},
                                           Piece{-12, {2.70, 12.17, -431.69, -1899.83}},
                                           Piece{-18, {13.84, 262.72, 1447.42, 2797.93}}};
    for (const Piece& piece : kPieces) {
        if (elevation_deg < piece.from_deg) continue;
        const double x = elevation_deg / 90;
        return std::pow(10, piece.l[0] + x * (piece.l[1] + x * (piece.l[2] + x * piece.l[3])));
    }
    return 0;
}

}  // namespace

double air_mass(double apparent_elevation_rad) {
    const double h_deg = std::max(0.0, degrees(apparent_elevation_rad));
    return 1 / (std::sin(radians(h_deg)) + 0.50572 * std::pow(h_deg + 6.07995, -1.6364));
}

glm::dvec3 direct_transmittance(double apparent_elevation_rad, double height_m) {
    static const OpticalDepths kDepths = optical_depths();
    const double risen = risen_share(apparent_elevation_rad);
    if (risen <= 0) return glm::dvec3(0);
    const double mass = air_mass(apparent_elevation_rad);
    const double thinned = std::exp(-height_m / kScaleHeight_m);
    glm::dvec3 light;
    for (int i = 0; i < 3; ++i)
        light[i] = risen * std::exp(-mass * (thinned * (kDepths.rayleigh[i] + kDepths.aerosol[i]) +
                                             kDepths.ozone[i]));
    return light;
}

double sky_illuminance_lux(double elevation_rad) {
    if (elevation_rad >= 0) return 800 + 15500 * std::sqrt(std::sin(elevation_rad));
    static const double kScale = 800 / twilight_illuminance_lux(0);
    return std::max(kNightIlluminance_lux,
                    kScale * twilight_illuminance_lux(degrees(elevation_rad)));
}

glm::dvec3 sky_irradiance(double elevation_rad) {
    // Linear sRGB of unit luminance: 12000 K by day, deep blue at the end of civil twilight.
    constexpr glm::dvec3 kDay{0.79, 0.99, 1.72};
    constexpr glm::dvec3 kDusk{0.62, 0.97, 2.42};
    const double dusk = std::clamp(degrees(elevation_rad) / -6.0, 0.0, 1.0);
    return (kDay + dusk * (kDusk - kDay)) *
           (sky_illuminance_lux(elevation_rad) / kSolarIlluminance_lux);
}

double eclipsed_sky(double visible_fraction) {
    constexpr double kTotality = 3e-4;
    return visible_fraction + (1 - visible_fraction) * kTotality;
}

double natural_exposure(double elevation_rad, double visible_fraction, double moonlight_lux) {
    // Light on level ground, against that of a sun 45 degrees high. The eye and every camera give
    // part of the difference back; three quarters keep noon at its place, the colours of a sunset
    // in the picture and civil twilight readable.
    const auto level_lux = [](double h_rad, double visible) {
        const double direct =
            visible * dot(direct_transmittance(h_rad, 0), glm::dvec3(0.2126, 0.7152, 0.0722));
        return kSolarIlluminance_lux * direct * std::max(0.0, std::sin(h_rad)) +
               eclipsed_sky(visible) * sky_illuminance_lux(h_rad);
    };
    static const double kReference_lux = level_lux(radians(45), 1);
    // Under stars alone, as long exposures do, white ground is held at what is left.
    // Of moonlight this share of its logarithm is left over that: ground is seen, and dark.
    constexpr double kNightLevel = 0.03, kMoonlit = 0.36;
    const double moonless = level_lux(elevation_rad, visible_fraction);
    const double level = moonless + moonlight_lux;
    return std::max(
        2.2 * std::pow(kReference_lux / level, 0.74),
        kNightLevel * std::pow(level / moonless, kMoonlit) * kSolarIlluminance_lux / level);
}

namespace {
constexpr double kMiddleGrey = 0.18;
constexpr double kMeter_cd_m2 = 0.125;  // luminance at an exposure value of 0
}  // namespace

double ev100_of_exposure(double exposure) {
    return std::log2(kMiddleGrey * kUnitLuminance_cd_m2 / (exposure * kMeter_cd_m2));
}

double exposure_of_ev100(double ev100) {
    return kMiddleGrey * kUnitLuminance_cd_m2 / (std::exp2(ev100) * kMeter_cd_m2);
}

}  // namespace relevo::sun
