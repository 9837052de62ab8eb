#include "sky/columns.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sky/path.h"

namespace relevo::sky {
namespace {

Column column_of(double height_m, double sine) {
    constexpr int kSteps = 24;
    // A ray at the horizon grazes the ground and goes on.
    Path path = path_of(height_m, std::max(sine, horizon_sine(height_m) + 1e-12));
    double rayleigh = 0, aerosol = 0, ozone = 0;
    const std::vector<double> ends = step_ends(path, kSteps);
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double step = ends[i] - ends[i - 1];
        // Simpson's rule.
        for (int k = 0; k <= 2; ++k) {
            const double h = height_at(height_m, sine, ends[i - 1] + 0.5 * k * step);
            const double weight = (k == 1 ? 4 : 1) * step / 6;
            rayleigh += weight * rayleigh_density(h);
            aerosol += weight * aerosol_density(h);
            ozone += weight * ozone_density(h);
        }
    }
    return {static_cast<float>(rayleigh), static_cast<float>(aerosol), static_cast<float>(ozone)};
}

float mix(float a, float b, float t) {
    return a + t * (b - a);
}
Column mix(const Column& a, const Column& b, float t) {
    return {mix(a.rayleigh_m, b.rayleigh_m, t), mix(a.aerosol_m, b.aerosol_m, t),
            mix(a.ozone_m, b.ozone_m, t)};
}

}  // namespace

Columns::Columns() : table_(static_cast<std::size_t>(kSines * kHeights)) {
    parallel_for(0, kHeights, 1, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const double u = row / (kHeights - 1.0), h = kTopOfAir_m * u * u;
            const double edge = horizon_sine(h);
            for (int column = 0; column < kSines; ++column) {
                const double t = column / (kSines - 1.0);
                table_[static_cast<std::size_t>(row * kSines + column)] =
                    column_of(h, edge + (1 - edge) * t * t);
            }
        }
    });
}

Column Columns::towards(double height_m, double sine) const {
    const double h = std::clamp(height_m, 0.0, kTopOfAir_m);
    const double edge = horizon_sine(h);
    const double x = std::sqrt(std::clamp((sine - edge) / (1 - edge), 0.0, 1.0)) * (kSines - 1);
    const double y = std::sqrt(h / kTopOfAir_m) * (kHeights - 1);
    const int column = std::min(static_cast<int>(x), kSines - 2);
    const int row = std::min(static_cast<int>(y), kHeights - 2);
    const Column* at = &table_[static_cast<std::size_t>(row * kSines + column)];
    const auto right = static_cast<float>(x - column), up = static_cast<float>(y - row);
    return mix(mix(at[0], at[1], right), mix(at[kSines], at[kSines + 1], right), up);
}

const Columns& Columns::shared() {
    static const Columns kColumns;
    return kColumns;
}

double disc_above_horizon(double height_m, double sine) {
    const double edge = horizon_sine(height_m);
    // Close to the horizon an angle is its difference of sines over the cosine.
    const double x = (sine - edge) / (kSunRadius_rad * std::sqrt(1 - edge * edge));
    if (x >= 1) return 1;
    if (x <= -1) return 0;
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi;
}

}  // namespace relevo::sky
