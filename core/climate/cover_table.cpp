#include "climate/cover_table.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "base/units.h"

namespace relevo::climate {
namespace {

constexpr double kSpacing_deg = 0.5;
constexpr int kMostHeights = 128, kMostTexels = 80000;
constexpr double kRagged_m = 100;  // standard deviation of the snow's edge
constexpr double kMappedIce_m = 1.5;

/// Weighted mean over the heights around, as far as there are any.
std::vector<float> smoothed(const std::vector<float>& values, double step_m) {
    const int reach = static_cast<int>(2 * kRagged_m / step_m);
    const int count = static_cast<int>(values.size());
    std::vector<float> result(values.size());
    for (int i = 0; i < count; ++i) {
        double sum = 0, weights = 0;
        for (int k = -reach; k <= reach; ++k) {
            const double weight = std::exp(-0.5 * std::pow(k * step_m / kRagged_m, 2));
            sum += weight * static_cast<double>(
                                values[static_cast<std::size_t>(std::clamp(i + k, 0, count - 1))]);
            weights += weight;
        }
        result[static_cast<std::size_t>(i)] = static_cast<float>(sum / weights);
    }
    return result;
}

}  // namespace

CoverTable::CoverTable(const ClimateMap& map, const Box& box, double lowest_m, double highest_m)
    : lowest_m_(lowest_m) {
    const double middle_rad = radians(0.5 * (box.south_deg + box.north_deg));
    const double width_deg = (box.east_deg - box.west_deg) * std::cos(middle_rad);
    const double height_deg = box.north_deg - box.south_deg;
    double spacing_deg = kSpacing_deg;
    do {
        columns_ = std::max(2, static_cast<int>(std::ceil(width_deg / spacing_deg)) + 1);
        rows_ = std::max(2, static_cast<int>(std::ceil(height_deg / spacing_deg)) + 1);
        spacing_deg *= 1.1;
    } while (columns_ * rows_ > kMostPlaces);
    const double range_m = std::max(highest_m - lowest_m, kStep_m);
    heights_ = std::min({kMostHeights, kMostTexels / (columns_ * rows_),
                         static_cast<int>(std::ceil(range_m / kStep_m)) + 1});
    step_m_ = range_m / (heights_ - 1);

    const double apart_deg = height_deg / (rows_ - 1);
    for (int row = 0; row < rows_; ++row) {
        const double lat_deg = box.south_deg + height_deg * row / (rows_ - 1);
        for (int column = 0; column < columns_; ++column) {
            const double lon_deg =
                box.west_deg + (box.east_deg - box.west_deg) * column / (columns_ - 1);
            places_.emplace_back(map.around(geo::geodetic_deg(lat_deg, lon_deg), apart_deg / 2));
        }
    }
    fixed_.resize(index(0, 2 * heights_));
    parallel_for(0, static_cast<int>(places_.size()), 4, [&](int first, int last) {
        for (auto place = static_cast<std::size_t>(first); place < static_cast<std::size_t>(last);
             ++place) {
            const CoverColumn& column = places_[place];
            for (int height = 0; height < heights_; ++height) {
                const double height_m = lowest_m_ + height * step_m_;
                float* const ground = &fixed_[index(place, height)];
                ground[0] = static_cast<float>(column.dryness(height_m));
                ground[1] = static_cast<float>(column.growth(height_m));
                ground[3] = static_cast<float>(column.mean_c(height_m));
                fixed_[index(place, heights_ + height)] =
                    static_cast<float>(column.ice_balance_mm(height_m) / 1000 +
                                       kMappedIce_m * column.normals().mapped_ice);
            }
        }
    });
}

std::vector<float> CoverTable::texels(double day) const {
    std::vector<float> texels = fixed_;
    parallel_for(0, static_cast<int>(places_.size()), 4, [&](int first, int last) {
        std::vector<float> shares(static_cast<std::size_t>(heights_));
        for (auto place = static_cast<std::size_t>(first); place < static_cast<std::size_t>(last);
             ++place) {
            const CoverColumn& column = places_[place];
            for (int height = 0; height < heights_; ++height) {
                const double height_m = lowest_m_ + height * step_m_;
                shares[static_cast<std::size_t>(height)] =
                    static_cast<float>(column.snow_share(height_m, day));
                texels[index(place, height) + 2] = static_cast<float>(column.green(height_m, day));
            }
            const std::vector<float> mean = smoothed(shares, step_m_);
            for (int height = 0; height < heights_; ++height)
                texels[index(place, heights_ + height) + 1] =
                    mean[static_cast<std::size_t>(height)];
        }
    });
    return texels;
}

}  // namespace relevo::climate
