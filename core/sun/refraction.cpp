#include "sun/refraction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "sun/interpolate.h"

namespace relevo::sun {

namespace {

constexpr double kZeroCelsius_k = 273.15;
constexpr double kGas_j_per_kmol_k = 8314.36;
constexpr double kDryAir_kg_per_kmol = 28.9644;
constexpr double kWater_kg_per_kmol = 18.0152;
constexpr double kModelRadius_m = 6'378'120;
constexpr double kTropopause_m = 11'000;
constexpr double kTop_m = 80'000;
constexpr double kWaterExponent = 18.36;  // of temperature, in the pressure of water vapour
constexpr int kEntries = 512;
constexpr double kLowestAir_m = -1400;    // 1193 hPa; no land is lower than -430 m
constexpr double kHighestAir_m = 31'000;  // 10 hPa: a hundredth of the air lies above

void check_air(const Air& air) {
    if (!(air.pressure_hpa >= 10 && air.pressure_hpa <= 1200))
        bad_input(
            fmt::format("refraction: pressure {:.10g} hPa: no air on Earth, expected 10 "
                        "to 1200; give the pressure at the place",
                        air.pressure_hpa));
    if (!(air.temperature_c >= -100 && air.temperature_c <= 70))
        bad_input(
            fmt::format("refraction: temperature {:.10g} C: no air on Earth, expected "
                        "-100 to 70 degrees Celsius",
                        air.temperature_c));
}

/// Index of refraction n and r dn/dr.
struct Optics {
    double n, r_dn_dr;
};

/// Air in two shells, by the equations of Hohenkerk and Sinclair.
class Shells {
  public:
    explicit Shells(const Atmosphere& a) {
        const double p = a.air.pressure_hpa;
        temperature_k_ = a.air.temperature_c + kZeroCelsius_k;
        lapse_ = a.lapse_k_per_m;
        observer_m_ = kModelRadius_m + a.height_m;
        const double gravity =
            9.784 * (1 - 0.0026 * std::cos(2 * a.latitude_rad) - 0.00000028 * a.height_m);
        const double um2 = a.wavelength_um * a.wavelength_um;
        const double refractivity =
            (287.6155 + 1.62887 / um2 + 0.01360 / (um2 * um2)) * kZeroCelsius_k * 1e-6 / 1013.25;
        hydrostatic_ = gravity * kDryAir_kg_per_kmol / kGas_j_per_kmol_k;
        const double gamma = hydrostatic_ / lapse_;
        gamma_minus_2_ = gamma - 2;
        delta_minus_2_ = kWaterExponent - 2;

        // Saturated vapour over the place: Gill, Atmosphere-Ocean Dynamics (1982), A4.5-A4.7.
        const double c = a.air.temperature_c;
        const double saturated = std::pow(10, (0.7859 + 0.03477 * c) / (1 + 0.00412 * c)) *
                                 (1 + p * (4.5e-6 + 6e-10 * c * c));
        const double vapour =
            a.relative_humidity * saturated / (1 - (1 - a.relative_humidity) * saturated / p);
        const double w = vapour * (1 - kWater_kg_per_kmol / kDryAir_kg_per_kmol) * gamma /
                         (kWaterExponent - gamma);
        dry_ = refractivity * (p + w) / temperature_k_;
        wet_ = (refractivity * w + 11.2684e-6 * vapour) / temperature_k_;
        dry_slope_ = (gamma - 1) * lapse_ * dry_ / temperature_k_;
        wet_slope_ = (kWaterExponent - 1) * lapse_ * wet_ / temperature_k_;

        tropopause_m_ = kModelRadius_m + std::max(kTropopause_m, a.height_m);
        tropopause_k_ = temperature_at(tropopause_m_);
        n_tropopause_ = troposphere(tropopause_m_).n;
    }

    Optics troposphere(double r) const {
        const double t = temperature_at(r);
        const double ratio = t / temperature_k_;
        const double dry = std::pow(ratio, gamma_minus_2_);
        const double wet = std::pow(ratio, delta_minus_2_);
        return {1 + (dry_ * dry - wet_ * wet) * ratio, r * (-dry_slope_ * dry + wet_slope_ * wet)};
    }

    Optics stratosphere(double r) const {
        const double b = hydrostatic_ / tropopause_k_;
        const double w = (n_tropopause_ - 1) * std::exp(-b * (r - tropopause_m_));
        return {1 + w, -r * b * w};
    }

    /// Refraction of the ray that reaches the place at this zenith distance.
    double refraction_rad(double zenith_rad) const {
        if (zenith_rad < 1e-9) return 0;
        const double invariant = troposphere(observer_m_).n * observer_m_ * std::sin(zenith_rad);
        const auto zenith_at = [&](double r, double n) {
            return std::asin(std::min(1.0, invariant / (n * r)));
        };
        const double z_tropopause = zenith_at(tropopause_m_, n_tropopause_);
        const double top_m = kModelRadius_m + kTop_m;
        const double z_top = zenith_at(top_m, stratosphere(top_m).n);
        double sum = integral(invariant, z_top, z_tropopause, top_m,
                              [this](double r) { return stratosphere(r); });
        if (tropopause_m_ > observer_m_)
            sum += integral(invariant, z_tropopause, zenith_rad, tropopause_m_,
                            [this](double r) { return troposphere(r); });
        return sum;
    }

  private:
    double temperature_at(double r) const {
        return std::clamp(temperature_k_ - lapse_ * (r - observer_m_), 100.0, 320.0);
    }

    /// The integral of -r dn/dr / (n + r dn/dr) over the local zenith distance, which is smooth
    /// where the textbook's integral over height is not: Auer and Standish. Gauss-Legendre, 24
    /// nodes; doubling them changes nothing by 0.001 arcsec (tests/sun/test_refraction.cpp).
    template <typename Shell>
    static double integral(double invariant, double z_from, double z_to, double r, Shell shell) {
        static const auto nodes = gauss_legendre();
        double sum = 0;
        for (const auto& [x, weight] : nodes) {
            const double z = 0.5 * (z_from + z_to) + 0.5 * (z_to - z_from) * x;
            // Snell: n r sin z is the same along the ray. Newton's method, from the last radius.
            const double target = invariant / std::sin(z);
            Optics here = shell(r);
            for (int i = 0; i < 12; ++i) {
                const double step = (here.n * r - target) / (here.n + here.r_dn_dr);
                r -= step;
                here = shell(r);
                if (std::abs(step) < 1e-3) break;
            }
            sum += weight * -here.r_dn_dr / (here.n + here.r_dn_dr);
        }
        return 0.5 * (z_to - z_from) * sum;
    }

    static constexpr int kNodes = 24;
    struct Node {
        double x, weight;
    };
    static std::array<Node, kNodes> gauss_legendre() {
        std::array<Node, kNodes> nodes;
        for (int i = 0; i < kNodes; ++i) {
            double x = -std::cos(kPi * (i + 0.75) / (kNodes + 0.5));
            double slope = 1;
            for (int pass = 0; pass < 20; ++pass) {
                double before = 1, p = x;
                for (int k = 2; k <= kNodes; ++k) {
                    const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                    before = p;
                    p = next;
                }
                slope = kNodes * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            nodes[static_cast<std::size_t>(i)] = {x, 2 / ((1 - x * x) * slope * slope)};
        }
        return nodes;
    }

    double temperature_k_, lapse_, observer_m_, hydrostatic_, gamma_minus_2_, delta_minus_2_;
    double dry_, wet_, dry_slope_, wet_slope_;
    double tropopause_m_, tropopause_k_, n_tropopause_;
};

double saemundsson_rad(double true_rad, double strength) {
    const double h_deg = std::max(degrees(true_rad), -1.0);
    const double r_arcmin = 1.02 / std::tan(radians(h_deg + 10.3 / (h_deg + 5.11)));
    // Meeus' constant for none at the zenith. JPL Horizons adds it, too: its refracted elevations
    // of 2024, printed to 1e-6 degrees, come out to 2e-6 with it.
    constexpr double kZenith_arcmin = 0.0019279;
    return strength * radians((r_arcmin + kZenith_arcmin) / 60);
}

}  // namespace

Air standard_air(double height_m) {
    const double h = std::clamp(height_m, -5000.0, 32000.0);
    constexpr double kLapse = 0.0065, kSeaLevel_k = 288.15, kExponent = 5.25588;
    constexpr double kTropopause_k = 216.65, kTropopause_hpa = 226.32;
    if (h <= 11000) {
        const double t = kSeaLevel_k - kLapse * h;
        return {1013.25 * std::pow(t / kSeaLevel_k, kExponent), t - kZeroCelsius_k};
    }
    if (h <= 20000)
        return {kTropopause_hpa * std::exp(-(h - 11000) / 6341.62), kTropopause_k - kZeroCelsius_k};
    const double t = kTropopause_k + 0.001 * (h - 20000);
    return {54.7489 * std::pow(t / kTropopause_k, -34.1632), t - kZeroCelsius_k};
}

double Refraction::Table::node_rad(int node) const {
    const double u = static_cast<double>(node) / (kEntries - 1);
    return lowest_rad + (kPi / 2 - lowest_rad) * u * u;
}

double Refraction::Table::at(double elevation_rad) const {
    const double share = (elevation_rad - lowest_rad) / (kPi / 2 - lowest_rad);
    if (!(share > 0)) return refraction_rad.front();
    const double u = std::min(1.0, std::sqrt(share)) * (kEntries - 1);
    const int node = std::clamp(static_cast<int>(u), 1, kEntries - 3);
    const CubicWeights weights(u - node);
    double sum = 0;
    for (int k = 0; k < 4; ++k)
        sum += weights.w[k] * refraction_rad[static_cast<std::size_t>(node - 1 + k)];
    return sum;
}

Refraction Refraction::none() {
    return {};
}

Refraction Refraction::saemundsson(const Air& air) {
    check_air(air);
    Refraction result;
    result.model_ = Model::Saemundsson;
    result.strength_ = air.pressure_hpa / 1010 * 283 / (273 + air.temperature_c);
    result.description_ = fmt::format("Saemundsson's refraction, {:.5g} hPa, {:.4g} C",
                                      air.pressure_hpa, air.temperature_c);
    return result;
}

Refraction Refraction::integrated(const Atmosphere& atmosphere) {
    check_air(atmosphere.air);
    if (!(atmosphere.height_m >= -12e3 && atmosphere.height_m <= 32e3))
        bad_input(
            fmt::format("refraction: height {:.10g} m: no air to integrate, expected "
                        "-12000 to 32000; use no refraction",
                        atmosphere.height_m));
    if (!(atmosphere.lapse_k_per_m >= 0.003 && atmosphere.lapse_k_per_m <= 0.01))
        bad_input(
            fmt::format("refraction: lapse {:.10g} K/m: not a troposphere, expected 0.003 "
                        "to 0.01",
                        atmosphere.lapse_k_per_m));
    const Shells shells(atmosphere);
    // To the sea horizon, and on to a ray 500 m below it (or below a place in a depression) for
    // the sun's lower edge; lower down, rays would run through air that nobody has.
    constexpr double kBelow_m = 500;
    const double dip_rad =
        std::acos((kModelRadius_m + std::min(0.0, atmosphere.height_m) - kBelow_m) /
                  (kModelRadius_m + atmosphere.height_m));
    Refraction result;
    result.model_ = Model::Table;
    Table& apparent = result.of_apparent_;
    apparent.lowest_rad = -dip_rad;
    apparent.refraction_rad.resize(kEntries);
    parallel_for(0, kEntries, 32, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            apparent.refraction_rad[static_cast<std::size_t>(i)] =
                shells.refraction_rad(kPi / 2 - apparent.node_rad(i));
    });

    Table& real = result.of_true_;
    real.lowest_rad = apparent.lowest_rad - apparent.refraction_rad.front();
    double refraction = apparent.refraction_rad.front();
    for (int i = 0; i < kEntries; ++i) {
        const double elevation = real.node_rad(i);
        // Refraction falls with elevation, by at most a third of it: this converges fast.
        for (int pass = 0; pass < 60; ++pass) {
            const double next = apparent.at(elevation + refraction);
            const bool done = std::abs(next - refraction) < 1e-12;
            refraction = next;
            if (done) break;
        }
        real.refraction_rad.push_back(refraction);
    }
    result.description_ =
        fmt::format("refraction integrated through the atmosphere, {:.0f} hPa, {:.1f} C, {:.0f} m",
                    atmosphere.air.pressure_hpa, atmosphere.air.temperature_c, atmosphere.height_m);
    return result;
}

Refraction Refraction::standard(const geo::Geodetic& place) {
    // Ground so low is a sea's floor, and the air over that begins at the sea.
    const double height_m = place.height_m < kLowestAir_m ? 0 : place.height_m;
    if (height_m > kHighestAir_m) {
        Refraction vacuum;
        vacuum.description_ = fmt::format("no refraction, above the air at {:.0f} m", height_m);
        return vacuum;
    }
    Atmosphere atmosphere;
    atmosphere.height_m = height_m;
    atmosphere.air = standard_air(height_m);
    atmosphere.latitude_rad = place.lat_rad;
    return integrated(atmosphere);
}

double Refraction::apparent_rad(double true_rad) const {
    switch (model_) {
        case Model::Saemundsson:
            return true_rad + saemundsson_rad(true_rad, strength_);
        case Model::Table:
            return true_rad + of_true_.at(true_rad);
        case Model::None:
            break;
    }
    return true_rad;
}

double Refraction::true_rad(double apparent_rad) const {
    if (model_ == Model::Table) return apparent_rad - of_apparent_.at(apparent_rad);
    if (model_ == Model::None) return apparent_rad;
    double true_rad = apparent_rad;
    for (int pass = 0; pass < 60; ++pass) {
        const double next = apparent_rad - saemundsson_rad(true_rad, strength_);
        const bool done = std::abs(next - true_rad) < 1e-12;
        true_rad = next;
        if (done) break;
    }
    return true_rad;
}

}  // namespace relevo::sun
