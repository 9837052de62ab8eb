#include "climate/fine_cover.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace relevo::climate {
namespace {

constexpr double kLeastSea = 0.1;  // of a box, for its land to be an island or a coast
constexpr double kHighLand_m = 200;
// Places of the net: islands and coasts have their sides if these are no further apart than in 12
// degrees.
constexpr int kLeastSide = 33, kMostSide = 65;
constexpr double kApart_deg = 12.0 / (kLeastSide - 1);
constexpr double kWidest_deg = kApart_deg * (kMostSide - 1);
// Where places are 40 km apart no lee is desert throughout, unless the climate itself is.
constexpr float kLeastDryness = 0.65F;
constexpr double kIcelessFrom_deg = -64;  // south of the islands whose ice is not mapped
constexpr float kSnowOnBare = 0.2F;  // wind and sun leave little snow on Antarctica's bare hills

/// Makes a texel of snow that of ground with a share of mapped ice, which alone decides here.
void map_ice(float* texel, float mapped) {
    constexpr float kCertain_m = 1.5F;  // of water a year
    texel[0] = kCertain_m * (2 * mapped - 1);
    texel[1] *= kSnowOnBare + (1 - kSnowOnBare) * mapped;
}

/// Where a place of a net lies in a coarser one over the same box.
struct Between {
    int first;
    float share;

    Between(int i, int fine, int coarse) {
        const double at = static_cast<double>(i) * (coarse - 1) / (fine - 1);
        first = std::min(static_cast<int>(at), coarse - 2);
        share = static_cast<float>(at - first);
    }
};

/// Width of a box in degrees of a great circle.
double width_deg(const Box& box) {
    return (box.east_deg - box.west_deg) * std::cos(radians(0.5 * (box.south_deg + box.north_deg)));
}

/// Places along a side of a box.
int places_along(double side_deg) {
    return std::clamp(static_cast<int>(std::ceil(side_deg / kApart_deg - 1e-6)) + 1, kLeastSide,
                      kMostSide);
}

}  // namespace

FineCover::FineCover(const ClimateMap& map, const Box& box, const CoverTable& table,
                     const Heights& height_m)
    : table_(table),
      columns_(places_along(width_deg(box))),
      rows_(places_along(box.north_deg - box.south_deg)),
      rain_(columns_, rows_, 1.0F) {
    if (std::max(width_deg(box), box.north_deg - box.south_deg) > kWidest_deg) return;
    refine_rain(box, height_m);
    refine_ice(map, box);
}

geo::Geodetic FineCover::place_of(const Box& box, int column, int row) const {
    return geo::geodetic_deg(
        box.south_deg + (box.north_deg - box.south_deg) * row / (rows_ - 1),
        box.west_deg + (box.east_deg - box.west_deg) * column / (columns_ - 1));
}

void FineCover::refine_rain(const Box& box, const Heights& height_m) {
    const geo::Geodetic middle = place_of(box, columns_ / 2, rows_ / 2);
    wind_ = trade_wind(middle);
    if (wind_.share == 0) return;
    Array2d<float> heights(columns_, rows_);
    int sea = 0;
    float highest_m = 0;
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const float height = height_m(place_of(box, column, row));
            heights.at(column, row) = height > 0 ? height : 0;
            highest_m = std::max(highest_m, heights.at(column, row));
            sea += height <= 0 ? 1 : 0;
        }
    if (sea < kLeastSea * columns_ * rows_ || highest_m < kHighLand_m) {
        wind_.share = 0;
        return;
    }
    rain_ = relief_rain(
        heights,
        {(box.east_deg - box.west_deg) / (columns_ - 1) * kDegree_m * std::cos(middle.lat_rad),
         (box.north_deg - box.south_deg) / (rows_ - 1) * kDegree_m},
        wind_);
    fine_ = true;
}

void FineCover::refine_ice(const ClimateMap& map, const Box& box) {
    if (box.north_deg > kIcelessFrom_deg) return;
    ice_ = Array2d<float>(columns_, rows_);
    const double half_deg = 0.5 * (box.north_deg - box.south_deg) / (rows_ - 1);
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column)
            ice_.at(column, row) =
                static_cast<float>(map.around(place_of(box, column, row), half_deg).mapped_ice);
    fine_ = true;
}

std::vector<float> FineCover::texels(double day) const {
    const std::vector<float> coarse = table_.texels(day);
    if (!fine_) return coarse;
    const int heights = table_.heights();
    const bool wide = std::max(columns_, rows_) > kLeastSide;
    const auto index = [](int column, int row, int level, int columns, int rows) {
        return 4 * (static_cast<std::size_t>((level * rows + row) * columns + column));
    };
    std::vector<float> fine(4 * static_cast<std::size_t>(columns_ * rows_ * 2 * heights));
    for (int level = 0; level < 2 * heights; ++level) {
        const double height_m = table_.lowest_m() + table_.step_m() * (level % heights);
        const auto below = static_cast<float>(rain_above_inversion(height_m, wind_));
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) {
                float* const texel = &fine[index(column, row, level, columns_, rows_)];
                const Between x(column, columns_, table_.columns()), y(row, rows_, table_.rows());
                for (int corner = 0; corner < 4; ++corner) {
                    const int right = corner & 1, up = corner >> 1;
                    const float share =
                        (right ? x.share : 1 - x.share) * (up ? y.share : 1 - y.share);
                    const float* const of = &coarse[index(x.first + right, y.first + up, level,
                                                          table_.columns(), table_.rows())];
                    for (int k = 0; k < 4; ++k)
                        texel[k] += share * of[k];
                }
                if (level < heights) {
                    const float least = wide ? std::min(texel[0], kLeastDryness) : 0.0F;
                    texel[0] = std::max(least, texel[0] * below * rain_.at(column, row));
                }
                if (level >= heights && !ice_.empty()) map_ice(texel, ice_.at(column, row));
            }
    }
    return fine;
}

}  // namespace relevo::climate
