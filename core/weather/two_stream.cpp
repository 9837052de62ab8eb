#include "weather/two_stream.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::weather {
namespace {

void check(const CloudLayerOptics& layer) {
    const auto refuse = [](std::string_view what, double value) {
        bad_input(fmt::format("clouds: expected {} but got {}", what, value));
    };
    if (!(layer.optical_depth >= 0) || std::isinf(layer.optical_depth))
        refuse("an optical depth of 0 or more", layer.optical_depth);
    if (!(layer.asymmetry > -1 && layer.asymmetry < 1))
        refuse("an asymmetry of -1 to 1", layer.asymmetry);
    if (!(layer.single_scattering_albedo >= 0 && layer.single_scattering_albedo <= 1))
        refuse("a single-scattering albedo of 0 to 1", layer.single_scattering_albedo);
}

/// A layer without its forward peak f = g^2 (Joseph et al., equations 5 and 13).
struct Scaled {
    double tau, omega, g;

    explicit Scaled(const CloudLayerOptics& layer) {
        const double f = layer.asymmetry * layer.asymmetry;
        const double scattered = layer.single_scattering_albedo * f;
        tau = (1 - scattered) * layer.optical_depth;
        omega = scattered >= 1 ? 0 : (1 - f) * layer.single_scattering_albedo / (1 - scattered);
        g = layer.asymmetry / (1 + layer.asymmetry);
    }
    // Coefficients of Eddington's approximation (Meador and Weaver, table 1).
    double gamma1() const { return (7 - omega * (4 + 3 * g)) / 4; }
    double gamma2() const { return -(1 - omega * (4 - 3 * g)) / 4; }
    double gamma3(double mu) const { return (2 - 3 * g * mu) / 4; }
};

/// Nothing is absorbed: equation 24 of Meador and Weaver.
/// @param kept  of the beam, exp(-tau / mu) of the scaled layer
LayerLight conservative_beam(const Scaled& layer, double mu, double kept) {
    const double a = layer.gamma1() * layer.tau;
    const double b = layer.gamma3(mu) - layer.gamma1() * mu;
    const double reflected = (a + b * (1 - kept)) / (1 + a);
    return {kept, 1 - reflected - kept, reflected};
}

/// Equations 14 and 15 of Meador and Weaver, both divided by exp(k tau) so that they hold for any
/// optical depth.
LayerLight absorbing_beam(const Scaled& layer, double mu, double kept) {
    const double g1 = layer.gamma1(), g2 = layer.gamma2();
    const double g3 = layer.gamma3(mu), g4 = 1 - g3;
    double k = std::sqrt(std::max(g1 * g1 - g2 * g2, 1e-14));
    // At k mu = 1 both sides of the fraction vanish.
    if (std::abs(1 - k * mu) < 1e-4) k *= 1 + 2e-4;
    const double a1 = g1 * g4 + g2 * g3, a2 = g1 * g3 + g2 * g4;
    const double less = std::exp(-2 * k * layer.tau), half = std::exp(-k * layer.tau);
    const double share = layer.omega / ((1 - k * k * mu * mu) * ((k + g1) + (k - g1) * less));
    const double reflected =
        share * ((1 - k * mu) * (a2 + k * g3) - (1 + k * mu) * (a2 - k * g3) * less -
                 2 * k * (g3 - a2 * mu) * kept * half);
    const double scattered =
        -share * ((1 + k * mu) * (a1 + k * g4) * kept - (1 - k * mu) * (a1 - k * g4) * less * kept -
                  2 * k * (g4 + a1 * mu) * half);
    return {kept, scattered, reflected};
}

}  // namespace

LayerLight beam_through(const CloudLayerOptics& layer, double mu) {
    check(layer);
    if (!(mu > 0 && mu <= 1))
        bad_input(fmt::format("clouds: expected a cosine above 0 and at most 1 but got {}", mu));
    const Scaled scaled(layer);
    const double kept = std::exp(-scaled.tau / mu);
    LayerLight light = 1 - layer.single_scattering_albedo < 1e-9
                           ? conservative_beam(scaled, mu, kept)
                           : absorbing_beam(scaled, mu, kept);
    light.reflected = std::clamp(light.reflected, 0.0, 1.0);
    // The forward peak passes, but it is scattered light.
    const double direct = std::exp(-layer.optical_depth / mu);
    light.diffuse = std::max(light.diffuse + light.direct - direct, 0.0);
    light.direct = direct;
    return light;
}

LayerLight sky_through(const CloudLayerOptics& layer) {
    check(layer);
    const Scaled scaled(layer);
    const double g1 = scaled.gamma1(), g2 = scaled.gamma2();
    if (1 - layer.single_scattering_albedo < 1e-9) {
        const double reflected = g1 * scaled.tau / (1 + g1 * scaled.tau);
        return {0, 1 - reflected, reflected};
    }
    const double k = std::sqrt(std::max(g1 * g1 - g2 * g2, 1e-14));
    const double less = std::exp(-2 * k * scaled.tau), half = std::exp(-k * scaled.tau);
    const double share = 1 / ((k + g1) + (k - g1) * less);
    return {0, 2 * k * half * share, g2 * (1 - less) * share};
}

LayerLight over_ground(const LayerLight& through, const LayerLight& sky, double albedo) {
    const double total = through.transmitted() / (1 - albedo * sky.reflected);
    // What leaves at the top: reflected at once, or by the ground and then through the layer.
    return {through.direct, total - through.direct,
            through.reflected + albedo * total * sky.diffuse};
}

}  // namespace relevo::weather
