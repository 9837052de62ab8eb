#include "dem/content_sum.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <vector>

#include "base/parallel_for.h"

namespace relevo::dem {
namespace {

/// splitmix64: G. Steele et al., OOPSLA 2014. Odd, so that a product loses nothing of it.
std::uint64_t hash(std::uint64_t number) {
    std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (z ^ z >> 31) | 1;
}

constexpr std::uint64_t kRows = std::uint64_t{1} << 40;  // so that rows are not columns

std::uint64_t hash_of_row(int row) {
    return hash(kRows + static_cast<std::uint64_t>(row));
}

std::uint64_t hash_of_column(int column) {
    return hash(static_cast<std::uint64_t>(column));
}

std::uint64_t hash_of_height(float height_m) {
    return std::isnan(height_m) ? 0 : hash(~std::uint64_t{std::bit_cast<std::uint32_t>(height_m)});
}

}  // namespace

std::uint64_t content_of(const Posts::View& view, const Window& window) {
    std::vector<std::uint64_t> columns;
    for (int column = window.column; column < window.end_column(); ++column)
        columns.push_back(hash_of_column(column));
    std::atomic<std::uint64_t> sum = 0;
    const int grain = std::max(1, (1 << 18) / std::max(1, window.columns));
    parallel_for(window.row, window.end_row(), grain, [&](int first, int last) {
        std::uint64_t part = 0;
        for (int row = first; row < last; ++row) {
            const float* const heights = view.at(window.column, row);
            std::uint64_t line = 0;
            for (std::size_t i = 0; i < columns.size(); ++i)
                line += columns[i] * hash_of_height(heights[i]);
            part += line * hash_of_row(row);
        }
        sum += part;
    });
    return sum;
}

std::uint64_t content_of(float height_m, const Window& window) {
    std::uint64_t rows = 0, columns = 0;
    for (int row = window.row; row < window.end_row(); ++row)
        rows += hash_of_row(row);
    for (int column = window.column; column < window.end_column(); ++column)
        columns += hash_of_column(column);
    return rows * columns * hash_of_height(height_m);
}

}  // namespace relevo::dem
