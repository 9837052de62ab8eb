#include "dem/heightfield.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/parallel_for.h"

namespace relevo::dem {
namespace {

// Challenger Deep is at -10 935 m, Everest at 8849 m; the margin is for errors of measurement.
constexpr float kLowest_m = -11500;
constexpr float kHighest_m = 9000;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

std::string NamedTiles::text() const {
    const bool has_more = count > static_cast<std::int64_t>(first.size());
    return fmt::format("{} ({}{})", count, fmt::join(first, ", "), has_more ? ", ..." : "");
}

std::string Description::nodata_text() const {
    if (!nodata) return {};
    const bool is_float = data_type == "Float32";
    return is_float ? fmt::format("{}", static_cast<float>(*nodata)) : fmt::format("{}", *nodata);
}

bool is_of_the_earth(double height_m) {
    return height_m >= double{kLowest_m} && height_m <= double{kHighest_m};
}

Statistics statistics(const Array2d<float>& height_m) {
    return statistics(height_m, {0, 0, height_m.width(), height_m.height()});
}

Statistics statistics(const Array2d<float>& height_m, const Window& window) {
    Statistics total;
    float total_min = kInfinity;
    float total_max = -kInfinity;
    std::mutex mutex;
    const int grain = std::max(1, 100'000 / std::max(1, window.columns));
    parallel_for(window.row, window.row + window.rows, grain, [&](int first, int last) {
        float min = kInfinity;
        float max = -kInfinity;
        std::int64_t valid = 0;
        std::int64_t outliers = 0;
        for (int row = first; row < last; ++row) {
            int row_valid = 0;
            int row_outliers = 0;
            for (const float h :
                 height_m.row(row).subspan(static_cast<std::size_t>(window.column),
                                           static_cast<std::size_t>(window.columns))) {
                // Comparisons with NaN are false: a hole changes nothing.
                min = h < min ? h : min;
                max = h > max ? h : max;
                row_valid += h == h;
                row_outliers += (h < kLowest_m) | (h > kHighest_m);
            }
            valid += row_valid;
            outliers += row_outliers;
        }
        const std::lock_guard lock(mutex);
        total_min = std::min(total_min, min);
        total_max = std::max(total_max, max);
        total.valid += valid;
        total.outliers += outliers;
    });
    total.holes = std::int64_t{window.columns} * window.rows - total.valid;
    if (total.valid > 0) {
        total.min_m = total_min;
        total.max_m = total_max;
    }
    return total;
}

Statistics statistics(float height_m, std::int64_t posts) {
    if (posts == 0) return {};
    Statistics all = statistics(Array2d<float>(1, 1, height_m));
    all.valid *= posts;
    all.holes *= posts;
    all.outliers *= posts;
    return all;
}

Statistics& Statistics::operator+=(const Statistics& others) {
    if (others.valid > 0) {
        min_m = valid > 0 ? std::min(min_m, others.min_m) : others.min_m;
        max_m = valid > 0 ? std::max(max_m, others.max_m) : others.max_m;
    }
    valid += others.valid;
    holes += others.holes;
    outliers += others.outliers;
    return *this;
}

double bilinear_m(const float* first_m, std::ptrdiff_t stride, double u, double v) {
    const auto weighted = [](float height_m, double weight) {
        // A hole with no part in the sum does not spoil it.
        return weight == 0 ? 0.0 : weight * height_m;
    };
    return weighted(first_m[0], (1 - u) * (1 - v)) + weighted(first_m[1], u * (1 - v)) +
           weighted(first_m[stride], (1 - u) * v) + weighted(first_m[stride + 1], u * v);
}

double Heightfield::height_at(double column, double row) const {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    if (!(column >= 0 && row >= 0 && column <= height_m.width() - 1 &&
          row <= height_m.height() - 1))
        return kNaN;
    const int c = std::min(static_cast<int>(column), height_m.width() - 2);
    const int r = std::min(static_cast<int>(row), height_m.height() - 2);
    return bilinear_m(&height_m.at(c, r), height_m.width(), column - c, row - r);
}

geo::Geodetic Heightfield::place(int column, int row) const {
    geo::Geodetic place = grid.place(column, row);
    place.height_m = height_m.at(column, row);
    return place;
}

}  // namespace relevo::dem
