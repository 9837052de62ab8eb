#include "dem/membrane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/vec2.hpp>

namespace relevo::dem {
namespace {

constexpr int kRounds = 12;  // of relaxation at each spacing

/// Means of two by two posts, of those that have a height.
Array2d<float> halved(const Array2d<float>& fine) {
    Array2d<float> coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2);
    for (int y = 0; y < coarse.height(); ++y)
        for (int x = 0; x < coarse.width(); ++x) {
            float sum = 0;
            int valid = 0;
            for (int j = 2 * y; j < std::min(2 * y + 2, fine.height()); ++j)
                for (int i = 2 * x; i < std::min(2 * x + 2, fine.width()); ++i) {
                    if (std::isnan(fine.at(i, j))) continue;
                    sum += fine.at(i, j);
                    ++valid;
                }
            coarse.at(x, y) = valid > 0 ? sum / static_cast<float>(valid) : std::nanf("");
        }
    return coarse;
}

/// Between the middles of coarse posts.
float sampled(const Array2d<float>& coarse, int x, int y) {
    const auto place = [](int fine, int count) {
        return std::clamp(0.5f * (static_cast<float>(fine) - 0.5f), 0.0f,
                          static_cast<float>(count - 1));
    };
    const float u = place(x, coarse.width()), v = place(y, coarse.height());
    const int left = static_cast<int>(u), above = static_cast<int>(v);
    const int right = std::min(left + 1, coarse.width() - 1);
    const int below = std::min(above + 1, coarse.height() - 1);
    const float s = u - static_cast<float>(left), t = v - static_cast<float>(above);
    return (1 - t) * ((1 - s) * coarse.at(left, above) + s * coarse.at(right, above)) +
           t * ((1 - s) * coarse.at(left, below) + s * coarse.at(right, below));
}

}  // namespace

void span_membrane(Array2d<float>& height_m) {
    const int columns = height_m.width(), rows = height_m.height();
    std::vector<glm::ivec2> unknown;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            if (std::isnan(height_m.at(x, y))) unknown.emplace_back(x, y);
    if (unknown.empty()) return;
    if (columns <= 1 && rows <= 1) {
        height_m.at(0, 0) = 0;
        return;
    }
    Array2d<float> coarse = halved(height_m);
    span_membrane(coarse);
    for (const glm::ivec2 at : unknown)
        height_m.at(at.x, at.y) = sampled(coarse, at.x, at.y);
    for (int round = 0; round < kRounds; ++round)
        for (const glm::ivec2 at : unknown) {
            const int west = std::max(at.x - 1, 0), east = std::min(at.x + 1, columns - 1);
            const int north = std::max(at.y - 1, 0), south = std::min(at.y + 1, rows - 1);
            height_m.at(at.x, at.y) = 0.25f * (height_m.at(west, at.y) + height_m.at(east, at.y) +
                                               height_m.at(at.x, north) + height_m.at(at.x, south));
        }
}

}  // namespace relevo::dem
