#include "climate/relief_rain.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

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
constexpr double kBackground_mm_h = 0.6;  // rain without relief
constexpr double kInversion_m = 2000, kDries_m = 800;
constexpr float kLeast = 0.25F, kMost = 2.5F;

double smoothstep(double from, double to, double value) {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Periodic values with room around a net, so that one end does not rain on the other.
class Waves {
  public:
    explicit Waves(const Array2d<float>& height_m)
        : columns_(2 * height_m.width()),
          rows_(2 * height_m.height()),
          values_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
        for (int row = 0; row < height_m.height(); ++row)
            for (int column = 0; column < height_m.width(); ++column)
                at(column, row) =
                    std::clamp(static_cast<double>(height_m.at(column, row)), 0.0, kInversion_m);
    }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    Complex& at(int column, int row) {
        return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)];
    }

    /// The discrete Fourier transform by its sums: nets have few places.
    /// @param sign  -1: to waves, 1: back, times the number of values
    void transform(double sign) {
        for (int row = 0; row < rows_; ++row)
            along(columns_, sign, [&](int i) -> Complex& { return at(i, row); });
        for (int column = 0; column < columns_; ++column)
            along(rows_, sign, [&](int i) -> Complex& { return at(column, i); });
    }

  private:
    template <typename At>
    static void along(int count, double sign, const At& at) {
        std::vector<Complex> sums(static_cast<std::size_t>(count));
        for (int k = 0; k < count; ++k)
            for (int i = 0; i < count; ++i)
                sums[static_cast<std::size_t>(k)] +=
                    at(i) * std::polar(1.0, sign * 2 * kPi * (i * k % count) / count);
        for (int k = 0; k < count; ++k)
            at(k) = sums[static_cast<std::size_t>(k)];
    }

    int columns_, rows_;
    std::vector<Complex> values_;
};

/// Wave number of a wave [1/m].
double wave_number(int i, int count, double apart_m) {
    return 2 * kPi * (i <= count / 2 ? i : i - count) / (count * apart_m);
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
    Waves waves(height_m);
    const glm::dvec2 wind_m_s{-kWind_m_s * std::sin(wind.from_rad),
                              -kWind_m_s * std::cos(wind.from_rad)};
    waves.transform(-1);
    const double seconds = 3600.0 / (waves.columns() * waves.rows());
    for (int row = 0; row < waves.rows(); ++row)
        for (int column = 0; column < waves.columns(); ++column)
            waves.at(column, row) *=
                seconds * rain_of_wave({wave_number(column, waves.columns(), apart_m.x),
                                        wave_number(row, waves.rows(), apart_m.y)},
                                       wind_m_s);
    waves.transform(1);

    Array2d<float> factors(height_m.width(), height_m.height());
    double sum = 0;
    int land = 0;
    for (int row = 0; row < factors.height(); ++row)
        for (int column = 0; column < factors.width(); ++column) {
            const double rain = std::max(kBackground_mm_h + waves.at(column, row).real(), 0.0);
            factors.at(column, row) = static_cast<float>(rain);
            if (height_m.at(column, row) <= 0) continue;
            sum += rain;
            ++land;
        }
    const auto mean = static_cast<float>(land > 0 && sum > 0 ? sum / land : kBackground_mm_h);
    const auto share = static_cast<float>(wind.share);
    for (float& factor : factors)
        factor = 1 + share * (std::clamp(factor / mean, kLeast, kMost) - 1);
    return factors;
}

double rain_above_inversion(double height_m, const TradeWind& wind) {
    return 1 - wind.share * (1 - std::exp(-std::max(height_m - kInversion_m, 0.0) / kDries_m));
}

}  // namespace relevo::climate
