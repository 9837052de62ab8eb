#include "dem/spikes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel_for.h"

namespace relevo::dem {

Spikes& Spikes::operator+=(const Spikes& other) {
    count += other.count;
    limit_m = other.limit_m;
    worst_m = std::max(worst_m, other.worst_m);
    return *this;
}

Spikes find_spikes(const Array2d<float>& height_m, const glm::dvec2& post_spacing_m) {
    return find_spikes(height_m, post_spacing_m, {0, 0, height_m.width(), height_m.height()});
}

Spikes find_spikes(const Array2d<float>& height_m, const glm::dvec2& post_spacing_m,
                   const Window& window) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr int kFewest = 3;
    Spikes all;
    all.limit_m = std::clamp(6 * std::min(post_spacing_m.x, post_spacing_m.y), 100.0, 1500.0);
    const auto limit_m = static_cast<float>(all.limit_m);
    std::mutex mutex;
    const int width = height_m.width(), height = height_m.height();
    const int grain = std::max(1, 100'000 / std::max(1, window.columns));
    parallel_for(window.row, window.row + window.rows, grain, [&](int first, int last) {
        Spikes found;
        for (int row = first; row < last; ++row)
            for (int column = window.column; column < window.column + window.columns; ++column) {
                const float h = height_m.at(column, row);
                // One comparison is enough for nearly all posts: a spike leaves its left neighbour.
                if (std::isnan(h) ||
                    (column > 0 && std::abs(h - height_m.at(column - 1, row)) <= limit_m))
                    continue;
                float lowest = kInfinity, highest = -kInfinity;
                int neighbours = 0;
                for (int r = std::max(0, row - 1); r <= std::min(height - 1, row + 1); ++r)
                    for (int c = std::max(0, column - 1); c <= std::min(width - 1, column + 1);
                         ++c) {
                        const float other = height_m.at(c, r);
                        if ((c == column && r == row) || std::isnan(other)) continue;
                        lowest = std::min(lowest, other);
                        highest = std::max(highest, other);
                        ++neighbours;
                    }
                const float off_m = std::max(h - highest, lowest - h);
                if (neighbours < kFewest || !(off_m > limit_m)) continue;
                ++found.count;
                if (static_cast<double>(off_m) > found.worst_m) {
                    found.worst_m = static_cast<double>(off_m);
                    found.worst_column = column;
                    found.worst_row = row;
                }
            }
        const std::lock_guard lock(mutex);
        all.count += found.count;
        if (found.worst_m > all.worst_m) {
            all.worst_m = found.worst_m;
            all.worst_column = found.worst_column;
            all.worst_row = found.worst_row;
        }
    });
    return all;
}

}  // namespace relevo::dem
