#include "climate/smooth.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace relevo::climate {
namespace {

/// Filters rows, then columns.
/// @param value  of a line's cells before and an index: what is there afterwards
template <typename Value>
void filter(Array2d<float>& cells, const Value& value) {
    std::vector<float> before;
    const auto line = [&](float* first, std::size_t step, int count) {
        before.clear();
        for (int i = 0; i < count; ++i)
            before.push_back(first[static_cast<std::size_t>(i) * step]);
        for (int i = 0; i < count; ++i)
            first[static_cast<std::size_t>(i) * step] = value(std::as_const(before), i);
    };
    const auto width = static_cast<std::size_t>(cells.width());
    for (int row = 0; row < cells.height(); ++row)
        line(cells.data() + static_cast<std::size_t>(row) * width, 1, cells.width());
    for (int column = 0; column < cells.width(); ++column)
        line(cells.data() + column, width, cells.height());
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
    filter(cells, [&](const std::vector<float>& line, int i) {
        float total = 0;
        for (int k = -reach; k <= reach; ++k) {
            const int at = std::clamp(i + k, 0, static_cast<int>(line.size()) - 1);
            total +=
                weights[static_cast<std::size_t>(k + reach)] * line[static_cast<std::size_t>(at)];
        }
        return total / sum;
    });
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
