#include "sky/atmosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sky/columns.h"

namespace relevo::sky {
namespace {

constexpr int kViewSteps = 40;

/// Directions over which light at a place is summed, by elevation; those around are even.
struct Ring {
    double sine, weight;  // weights of all sum to 2
};
constexpr int kAround = 6, kTableSteps = 20;

/// Gauss-Legendre nodes above and below the horizon, dense about it.
std::vector<Ring> rings(double horizon) {
    constexpr std::array<double, 4> kNodes{0.1834346424956498, 0.5255324099163290,
                                           0.7966664774136267, 0.9602898564975363};
    constexpr std::array<double, 4> kWeights{0.3626837833783620, 0.3137066458778873,
                                             0.2223810344533745, 0.1012285362903763};
    std::vector<Ring> made;
    for (const double side : {1.0, -1.0}) {
        const double reach = side - horizon;
        for (std::size_t i = 0; i < 4; ++i) {
            for (const double sign : {-1.0, 1.0}) {
                const double x = 0.5 + 0.5 * sign * kNodes[i];
                made.push_back({horizon + reach * x * x, kWeights[i] * x * std::abs(reach)});
            }
        }
    }
    return made;
}

/// The part of the aerosol's phase function that the harmonics have, without what counts as not
/// scattered [1/sr].
float smooth_phase(const Coefficients& air, double cosine) {
    constexpr double g = kAerosolAsymmetry;
    const double f = air.forward, c2 = cosine * cosine;
    return static_cast<float>((1 - f + 3 * (g - f) * cosine + 2.5 * (g * g - f) * (3 * c2 - 1) +
                               3.5 * (g * g * g - f) * cosine * (5 * c2 - 3) +
                               1.125 * (g * g * g * g - f) * (c2 * (35 * c2 - 30) + 3)) /
                              (4 * kPi));
}

/// Adds what a ray brings to the light of a place.
void add(const Coefficients& air, const Brought& brought, double sine, const Sun& sun,
         double solid_angle, Diffuse& to) {
    const auto direction =
        harmonics(harmonic_powers(sine), std::sqrt(1 - sine * sine) * sun.azimuth_cos);
    const float phase = smooth_phase(air, ray_sun_cosine(sine, sun));
    const auto weight = static_cast<float>(solid_angle);
    const auto level = static_cast<float>(std::max(sine, 0.0));
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        const float radiance =
            weight * (brought.air[k] + phase * brought.aerosol[k] + air.albedo * brought.ground[k]);
        for (std::size_t c = 0; c < kHarmonics; ++c)
            to.moments[c][k] += direction[c] * radiance;
        to.level[k] += level * radiance;
    }
}

/// The light that arrives everywhere after one more scattering of `sources`.
DiffuseTable scatter(const Coefficients& air, const Sources& sources) {
    std::vector<Sun> suns;
    for (int column = 0; column < DiffuseTable::kSuns; ++column)
        for (int i = 0; i < kAround; ++i)
            suns.push_back({DiffuseTable::sun_of(column), std::cos((i + 0.5) * kPi / kAround)});
    DiffuseTable made;
    parallel_for(0, DiffuseTable::kHeights, 1, [&](int first, int last) {
        std::vector<Brought> brought(suns.size());
        for (int row = first; row < last; ++row) {
            const double height = DiffuseTable::height_of(row);
            for (const Ring& ring : rings(horizon_sine(height))) {
                const Path path = path_of(height, ring.sine);
                brought.assign(suns.size(), Brought{.through = filled(1)});
                integrate(air, sources, {height, ring.sine, suns}, step_ends(path, kTableSteps),
                          path.ground, brought);
                for (std::size_t i = 0; i < suns.size(); ++i)
                    add(air, brought[i], ring.sine, suns[i], 2 * kPi * ring.weight / kAround,
                        made.at(row, static_cast<int>(i) / kAround));
            }
        }
    });
    return made;
}

/// Adds an order of scattering to a sum, each value times a factor that may depend on it.
template <class Factor>
void add(DiffuseTable& to, const DiffuseTable& order, const Factor& factor) {
    for (int row = 0; row < DiffuseTable::kHeights; ++row) {
        for (int column = 0; column < DiffuseTable::kSuns; ++column) {
            Diffuse& sum = to.at(row, column);
            const Diffuse& one = order.at(row, column);
            for (std::size_t k = 0; k < kWavelengths; ++k) {
                const float times = factor(row, column, k);
                for (std::size_t c = 0; c < kHarmonics; ++c)
                    sum.moments[c][k] += times * one.moments[c][k];
                sum.level[k] += times * one.level[k];
            }
        }
    }
}

DiffuseTable all_orders(const Coefficients& air) {
    constexpr int kOrders = 4;
    DiffuseTable order = scatter(air, {.sun = true, .diffuse = nullptr});
    DiffuseTable sum = order;
    for (int i = 2; i <= kOrders; ++i) {
        DiffuseTable next = scatter(air, {.sun = false, .diffuse = &order});
        if (i < kOrders) {
            add(sum, next, [](int, int, std::size_t) { return 1.0f; });
        } else {
            // Further orders are each the same share of the one before.
            add(sum, next, [&](int row, int column, std::size_t k) {
                const float before = order.at(row, column).moments[0][k];
                const float ratio = before > 0 ? next.at(row, column).moments[0][k] / before : 0.0f;
                return 1 / (1 - std::clamp(ratio, 0.0f, 0.9f));
            });
        }
        order = std::move(next);
    }
    return sum;
}

Spectrum spectrum(const Values& values) {
    Spectrum made{};
    std::copy(values.begin(), values.end(), made.begin());
    return made;
}

}  // namespace

Atmosphere::Atmosphere(const Air& air)
    : coefficients_(sky::coefficients(air)), diffuse_(all_orders(coefficients_)) {}

Atmosphere::Atmosphere(const Air& air, DiffuseTable diffuse)
    : coefficients_(sky::coefficients(air)), diffuse_(std::move(diffuse)) {}

std::vector<Brought> Atmosphere::brought(double height_m, double sine, std::span<const Sun> suns,
                                         double distance_m) const {
    const double height = std::max(height_m, 0.0);
    Path path = path_of(height, sine);
    const bool whole = distance_m >= path.end_m;
    path.end_m = std::clamp(distance_m, path.begin_m, path.end_m);
    path.lowest_m = std::min(path.lowest_m, path.end_m);
    std::vector<Brought> made(suns.size(), Brought{.through = filled(1)});
    integrate(coefficients_, {.sun = true, .diffuse = &diffuse_}, {height, sine, suns},
              step_ends(path, kViewSteps), path.ground && whole, made);
    return made;
}

Spectrum Atmosphere::scattered_in(const View& view, double distance_m) const {
    const Sun sun{view.sun_sine, view.azimuth_cos};
    const Brought one = brought(view.height_m, view.sine, std::span(&sun, 1), distance_m).front();
    const double phase = aerosol_phase(ray_sun_cosine(view.sine, sun));
    Spectrum radiance{};
    for (std::size_t k = 0; k < kWavelengths; ++k)
        radiance[k] =
            kPi * (one.air[k] + phase * one.aerosol[k] + coefficients_.albedo * one.ground[k]);
    return radiance;
}

Spectrum Atmosphere::radiance(const View& view) const {
    return scattered_in(view, kWhole_m);
}

Spectrum Atmosphere::transmittance(double height_m, double sine, double distance_m) const {
    constexpr Sun kAny;
    return spectrum(brought(height_m, sine, std::span(&kAny, 1), distance_m).front().through);
}

Spectrum Atmosphere::sunlight(const SunRays& rays, double elevation_rad) const {
    // Gauss-Chebyshev nodes of the second kind: strips of the disc.
    constexpr int kStrips = 7;
    Spectrum mean{};
    for (int i = 1; i <= kStrips; ++i) {
        const double angle = i * kPi / (kStrips + 1);
        const auto column = rays.towards(elevation_rad + kSunRadius_rad * std::cos(angle));
        if (!column) continue;
        const double weight = 2 * std::sin(angle) * std::sin(angle) / (kStrips + 1);
        for (std::size_t k = 0; k < kWavelengths; ++k)
            mean[k] += weight * passed(column->rayleigh_m * coefficients_.rayleigh[k] +
                                       column->aerosol_m * coefficients_.aerosol[k] +
                                       column->ozone_m * coefficients_.ozone[k]);
    }
    return mean;
}

Spectrum Atmosphere::sky_irradiance(double height_m, double sun_sine) const {
    Spectrum level = spectrum(diffuse_.level(height_m, sun_sine));
    // What counts as not scattered comes from around the sun.
    const double h = std::max(height_m, 0.0);
    const Values passed = sky::sunlight(coefficients_, coefficients_.aerosol_taken, h, sun_sine);
    const Values direct = sky::sunlight(coefficients_, coefficients_.aerosol, h, sun_sine);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        level[k] += (passed[k] - direct[k]) * std::max(sun_sine, 0.0);
    return level;
}

}  // namespace relevo::sky
