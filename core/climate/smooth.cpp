#include "climate/smooth.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace relevo::climate {
namespace {

/// @param along  of (cells, first index, step, count): one row or column
template <typename Line>
void each_line(Array2d<float>& cells, const Line& line) {
    const auto width = static_cast<std::size_t>(cells.width());
    for (int row = 0; row < cells.height(); ++row)
        line(cells.data() + static_cast<std::size_t>(row) * width, std::size_t{1}, cells.width());
    for (int column = 0; column < cells.width(); ++column)
        line(cells.data() + column, width, cells.height());
}

template <typename Better>
Array2d<float> extreme_around(const Array2d<float>& cells, int reach, const Better& better) {
    Array2d<float> result = cells;
    std::vector<float> values;
    each_line(result, [&](float* line, std::size_t step, int count) {
        values.resize(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i)
            values[static_cast<std::size_t>(i)] = line[static_cast<std::size_t>(i) * step];
        for (int i = 0; i < count; ++i) {
            float best = values[static_cast<std::size_t>(i)];
            for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k)
                best = better(best, values[static_cast<std::size_t>(k)]);
            line[static_cast<std::size_t>(i) * step] = best;
        }
    });
    return result;
}

}  // namespace

void smooth(Array2d<float>& cells, double sigma) {
    const int reach = static_cast<int>(2.5 * sigma + 0.5);
    if (reach == 0) return;
    std::vector<float> weights;
    float sum = 0;
    for (int k = -reach; k <= reach; ++k) {
        weights.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
        sum += weights.back();
    }
    std::vector<float> values;
    each_line(cells, [&](float* line, std::size_t step, int count) {
        values.resize(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i)
            values[static_cast<std::size_t>(i)] = line[static_cast<std::size_t>(i) * step];
        for (int i = 0; i < count; ++i) {
            float total = 0;
            for (int k = -reach; k <= reach; ++k)
                total += weights[static_cast<std::size_t>(k + reach)] *
                         values[static_cast<std::size_t>(std::clamp(i + k, 0, count - 1))];
            line[static_cast<std::size_t>(i) * step] = total / sum;
        }
    });
}

Array2d<float> lowest_around(const Array2d<float>& cells, int reach) {
    return extreme_around(cells, reach, [](float a, float b) { return std::min(a, b); });
}

Array2d<float> highest_around(const Array2d<float>& cells, int reach) {
    return extreme_around(cells, reach, [](float a, float b) { return std::max(a, b); });
}

void fill_outwards(std::span<Array2d<float>> layers, const std::function<bool(int, int)>& has) {
    if (layers.empty()) return;
    const int width = layers[0].width(), height = layers[0].height();
    Array2d<std::uint8_t> filled(width, height);
    std::vector<std::pair<int, int>> rim;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            if (has(column, row)) {
                filled.at(column, row) = 1;
                rim.emplace_back(column, row);
            }
    const auto around = [&](int column, int row, const auto& visit) {
        for (int j = std::max(0, row - 1); j <= std::min(height - 1, row + 1); ++j)
            for (int i = std::max(0, column - 1); i <= std::min(width - 1, column + 1); ++i)
                visit(i, j);
    };
    while (!rim.empty()) {
        std::vector<std::pair<int, int>> next;
        for (const auto& [column, row] : rim)
            around(column, row, [&](int i, int j) {
                if (filled.at(i, j)) return;
                filled.at(i, j) = 2;
                next.emplace_back(i, j);
            });
        for (const auto& [column, row] : next)
            for (Array2d<float>& layer : layers) {
                float sum = 0, count = 0;
                around(column, row, [&](int i, int j) {
                    if (filled.at(i, j) != 1) return;
                    sum += layer.at(i, j);
                    count += 1;
                });
                layer.at(column, row) = sum / std::max(count, 1.0F);
            }
        for (const auto& [column, row] : next)
            filled.at(column, row) = 1;
        rim = std::move(next);
    }
}

}  // namespace relevo::climate
