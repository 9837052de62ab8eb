#include "sky/moments.h"

#include "base/units.h"
#include "sky/air.h"

namespace relevo::sky {
namespace {

// Suns are dense about the horizon.
constexpr double kFold = 0.4;
double folded(double sine) {
    return sine / (kFold + std::abs(sine));
}
double lowest() {
    static const double kLowest = folded(std::sin(radians(DiffuseTable::kLowestSun_deg)));
    return kLowest;
}

DiffuseTable::Place place(double at, int nodes) {
    const double scaled = std::clamp(at, 0.0, 1.0) * (nodes - 1);
    const int first = std::min(static_cast<int>(scaled), nodes - 2);
    return {first, static_cast<float>(scaled - first)};
}

}  // namespace

double DiffuseTable::height_of(int row) {
    const double u = row / (kHeights - 1.0);
    return kTopOfAir_m * u * u;
}

double DiffuseTable::sun_of(int column) {
    const double x = lowest() + column / (kSuns - 1.0) * (folded(1) - lowest());
    return kFold * x / (1 - std::abs(x));
}

DiffuseTable::Place DiffuseTable::row_of(double height_m) {
    return place(std::sqrt(std::max(height_m, 0.0) / kTopOfAir_m), kHeights);
}

DiffuseTable::Place DiffuseTable::column_of(double sun_sine) {
    return place((folded(sun_sine) - lowest()) / (folded(1) - lowest()), kSuns);
}

Values DiffuseTable::level(double height_m, double sun_sine) const {
    const Place row = row_of(height_m), column = column_of(sun_sine);
    Values sum{};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const float weight =
                (j ? row.share : 1 - row.share) * (i ? column.share : 1 - column.share);
            const Values& node = at(row.first + j, column.first + i).level;
            for (std::size_t k = 0; k < kWavelengths; ++k)
                sum[k] += weight * node[k];
        }
    }
    return sum;
}

}  // namespace relevo::sky
