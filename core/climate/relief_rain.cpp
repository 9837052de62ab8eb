#include "climate/relief_rain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include "base/fft.h"
#include "base/units.h"

namespace relevo::climate {
namespace {

using Complex = std::complex<double>;

// Of Smith and Barstad's model.
constexpr double kSensitivity = 0.004;  // [kg/m3]
constexpr double kWind_m_s = 8;
constexpr double kStability_per_s = 0.005;
constexpr double kVapour_m = 2500;        // height scale of water vapour
constexpr double kDelay_s = 1000;         // in cloud, and again as rain
constexpr float kBackground_mm_h = 0.6F;  // rain without relief
constexpr float kInversion_m = 2000, kDries_m = 800;
constexpr float kLeast = 0.25F, kMost = 2.5F;

double smoothstep(double from, double to, double value) {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Heights up to the inversion, with as much room around, so that one end does not rain on the
/// other: the transform repeats them.
ComplexField waves_of(const Array2d<float>& height_m) {
    const unsigned side = static_cast<unsigned>(2 * std::max(height_m.width(), height_m.height()));
    const int n = static_cast<int>(std::bit_ceil(side));
    ComplexField waves(n, n);
    for (int row = 0; row < height_m.height(); ++row)
        for (int column = 0; column < height_m.width(); ++column)
            waves.at(column, row) = std::clamp(height_m.at(column, row), 0.0F, kInversion_m);
    fft(waves, /*inverse=*/false);
    return waves;
}

/// Rain of a wave of height 1 [kg/m2/s a metre].
Complex rain_of_wave(const glm::dvec2& wave, const glm::dvec2& wind_m_s) {
    const double along = wind_m_s.x * wave.x + wind_m_s.y * wave.y;
    if (std::abs(along) < 1e-9) return 0;
    const double steep = (kStability_per_s * kStability_per_s - along * along) / (along * along) *
                         (wave.x * wave.x + wave.y * wave.y);
    // Long waves tilt against the wind, short ones fade upwards.
    const Complex upwards = steep >= 0 ? Complex(std::copysign(std::sqrt(steep), along), 0)
                                       : Complex(0, std::sqrt(-steep));
    const Complex i(0, 1), late = 1.0 + i * along * kDelay_s;
    return kSensitivity * i * along / ((1.0 - i * upwards * kVapour_m) * late * late);
}

}  // namespace

TradeWind trade_wind(const geo::Geodetic& place) {
    const double lat_deg = degrees(place.lat_rad), away_deg = std::abs(lat_deg);
    const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad));
    const bool monsoon = lat_deg > -12 && lon_deg > 40 && lon_deg < 155;
    return {
        .from_rad = radians(lat_deg > 0 ? 65 : 115),
        .share = monsoon ? 0 : smoothstep(5, 10, away_deg) * (1 - smoothstep(29, 33, away_deg))};
}

Array2d<float> relief_rain(const Array2d<float>& height_m, const glm::dvec2& apart_m,
                           const TradeWind& wind) {
    ComplexField waves = waves_of(height_m);
    const int n = waves.width();
    const glm::dvec2 wind_m_s{-kWind_m_s * std::sin(wind.from_rad),
                              -kWind_m_s * std::cos(wind.from_rad)};
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const glm::dvec2 wave =
                2 * kPi / n * glm::dvec2(frequency(column, n), frequency(row, n)) / apart_m;
            waves.at(column, row) *= std::complex<float>(kHour_s * rain_of_wave(wave, wind_m_s));
        }
    fft(waves, /*inverse=*/true);

    Array2d<float> factors(height_m.width(), height_m.height());
    double sum = 0;
    int land = 0;
    for (int row = 0; row < factors.height(); ++row)
        for (int column = 0; column < factors.width(); ++column) {
            const float rain = std::max(kBackground_mm_h + waves.at(column, row).real(), 0.0F);
            factors.at(column, row) = rain;
            if (height_m.at(column, row) <= 0) continue;
            sum += rain;
            ++land;
        }
    const float mean = sum > 0 ? static_cast<float>(sum / land) : kBackground_mm_h;
    const auto share = static_cast<float>(wind.share);
    for (float& factor : factors)
        factor = 1 + share * (std::clamp(factor / mean, kLeast, kMost) - 1);
    return factors;
}

double rain_above_inversion(double height_m, const TradeWind& wind) {
    return 1 -
           wind.share * (1 - std::exp(-std::max(height_m - double{kInversion_m}, 0.0) / kDries_m));
}

}  // namespace relevo::climate
