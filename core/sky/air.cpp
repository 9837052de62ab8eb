#include "sky/air.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relevo::sky {
namespace {

/// Vertical optical depth of the air at sea level.
double rayleigh_depth(double um) {
    const double per_um2 = 1 / (um * um);
    return 0.008569 * per_um2 * per_um2 * (1 + per_um2 * (0.0113 + 0.00013 * per_um2));
}

/// Layers of constant lapse rate, by geopotential height.
struct Layer {
    double base_km, temperature_k, lapse_k_per_km;
};
constexpr std::array<Layer, 7> kLayers{
    Layer{0, 288.15, -6.5}, Layer{11, 216.65, 0},    Layer{20, 216.65, 1}, Layer{32, 228.65, 2.8},
    Layer{47, 270.65, 0},   Layer{51, 270.65, -2.8}, Layer{71, 214.65, -2}};

/// Logarithms of the density relative to sea level, every kilometre up to the top of the air.
constexpr int kDensities = 101;
std::array<double, kDensities> log_densities() {
    constexpr double kEarth_km = 6356.766, kGravity_k_per_km = 34.163195;  // g M / R
    constexpr double kHighest_km = 84.852;  // 86 km; above, the temperature is taken as constant
    std::array<double, kDensities> logs{};
    for (int km = 0; km < kDensities; ++km) {
        const double height = kEarth_km * km / (kEarth_km + km);  // geopotential
        double log_pressure = 0, temperature = kLayers[0].temperature_k;
        for (std::size_t i = 0; i < kLayers.size(); ++i) {
            const auto& [base, at_base, lapse] = kLayers[i];
            if (height <= base) break;
            const double end = i + 1 < kLayers.size() ? kLayers[i + 1].base_km : kHighest_km;
            const double rise = std::min(height, end) - base;
            temperature = at_base + lapse * rise;
            log_pressure -= kGravity_k_per_km *
                            (lapse == 0 ? rise / at_base : std::log(temperature / at_base) / lapse);
        }
        if (height > kHighest_km)
            log_pressure -= kGravity_k_per_km * (height - kHighest_km) / temperature;
        logs[static_cast<std::size_t>(km)] =
            log_pressure - std::log(temperature / kLayers[0].temperature_k);
    }
    return logs;
}

/// A height between two of the table: the logarithm of the density, and its slope [1/km].
struct LogDensity {
    double log, slope;
};
LogDensity log_density(double height_m) {
    static const std::array<double, kDensities> kLogs = log_densities();
    const double km = 1e-3 * height_m;
    const auto i = std::min(static_cast<std::size_t>(std::max(km, 0.0)),
                            static_cast<std::size_t>(kDensities - 2));
    const double slope = kLogs[i + 1] - kLogs[i];
    return {kLogs[i] + (km - static_cast<double>(i)) * slope, slope};
}

}  // namespace

double rayleigh_density(double height_m) {
    return std::exp(log_density(height_m).log);
}

double rayleigh_density_slope(double height_m) {
    const auto [log, slope] = log_density(height_m);
    return 1e-3 * slope * std::exp(log);
}

double aerosol_depth(const Air& air, double um) {
    return air.angstrom_beta * std::pow(um, -air.angstrom_alpha);
}

Extinction extinction(const Air& air) {
    constexpr double kMoleculesOfDobsonUnit_per_m2 = 2.687e20;
    constexpr double kOzoneThickness_m = 15000;  // the layer's column over its peak density
    const double ozone_per_m3 = air.ozone_du * kMoleculesOfDobsonUnit_per_m2 / kOzoneThickness_m;
    Extinction result;
    for (int i = 0; i < kWavelengths; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double um = wavelength_um(i);
        result.rayleigh[k] = rayleigh_depth(um) / kRayleighColumn_m;
        result.aerosol[k] = aerosol_depth(air, um) / kAerosolScaleHeight_m;
        result.ozone[k] = ozone_per_m3 * ozone_cross_section()[k];
    }
    return result;
}

double white_extinction(const Air& air) {
    constexpr double kWay_m = 1000;
    const Extinction at_sea = extinction(air);
    Spectrum passed{};
    for (std::size_t k = 0; k < kWavelengths; ++k)
        passed[k] = std::exp(-kWay_m * (at_sea.rayleigh[k] + at_sea.aerosol[k]));
    const glm::dvec3 colour = colour_of(passed);
    return -std::log(0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b) / kWay_m;
}

}  // namespace relevo::sky
