#include "base/sliding_window.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace relevo {
namespace {

constexpr std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

/// Changes each row, then each column. @param change  of a line's cells
template <typename Change>
void along_lines(Array2d<float>& cells, const Change& change) {
    std::vector<float> line;
    for (int row = 0; row < cells.height(); ++row) {
        line.assign(cells.row(row).begin(), cells.row(row).end());
        change(line);
        std::ranges::copy(line, cells.row(row).begin());
    }
    line.resize(index(cells.height()));
    for (int column = 0; column < cells.width(); ++column) {
        for (int row = 0; row < cells.height(); ++row)
            line[index(row)] = cells.at(column, row);
        change(line);
        for (int row = 0; row < cells.height(); ++row)
            cells.at(column, row) = line[index(row)];
    }
}

/// The first of each cell's window by an order, from the firsts of parts of blocks as long as it.
template <typename Before>
Array2d<float> first_around(Array2d<float> cells, int reach, const Before& before) {
    const int block = 2 * reach + 1;
    std::vector<float> forwards, backwards;  // firsts from a block's begin, and from its end
    along_lines(cells, [&](std::vector<float>& line) {
        const int count = static_cast<int>(line.size());
        forwards = backwards = line;
        for (int i = 1; i < count; ++i)
            if (i % block != 0)
                forwards[index(i)] = std::min(forwards[index(i)], forwards[index(i - 1)], before);
        for (int i = count - 2; i >= 0; --i)
            if ((i + 1) % block != 0)
                backwards[index(i)] =
                    std::min(backwards[index(i)], backwards[index(i + 1)], before);
        for (int i = 0; i < count; ++i) {
            const int first = std::max(i - reach, 0), last = std::min(i + reach, count - 1);
            const float early = backwards[index(first)], late = forwards[index(last)];
            if (first == 0)
                line[index(i)] = late;
            else if (first / block == last / block)  // the line's last block, whole or not
                line[index(i)] = early;
            else
                line[index(i)] = std::min(early, late, before);
        }
    });
    return cells;
}

}  // namespace

Array2d<float> lowest_around(Array2d<float> cells, int reach) {
    return first_around(std::move(cells), reach, std::less{});
}

Array2d<float> highest_around(Array2d<float> cells, int reach) {
    return first_around(std::move(cells), reach, std::greater{});
}

Array2d<float> mean_around(Array2d<float> cells, int reach) {
    std::vector<float> from;
    along_lines(cells, [&](std::vector<float>& line) {
        from = line;
        const int count = static_cast<int>(line.size());
        double sum = 0;
        for (int i = 0; i < std::min(reach, count); ++i)
            sum += from[index(i)];
        for (int i = 0; i < count; ++i) {
            if (i + reach < count) sum += from[index(i + reach)];
            if (i > reach) sum -= from[index(i - reach - 1)];
            const int over = std::min(i + reach, count - 1) - std::max(i - reach, 0) + 1;
            line[index(i)] = static_cast<float>(sum / over);
        }
    });
    return cells;
}

}  // namespace relevo
