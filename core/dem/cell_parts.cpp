#include "dem/cell_parts.h"

#include <algorithm>
#include <cmath>

namespace relevo::dem {

Parts parts_within(double begin, double each, int first_part, int end_part, double per, int cells) {
    Parts result;
    for (int i = first_part; i < end_part; ++i) {
        const double from = std::max(0.0, (begin + each * i) * per);
        const double to = std::min<double>(cells, (begin + each * (i + 1)) * per);
        // What is below a millionth of a cell is rounding.
        if (to - from < 1e-6) continue;
        if (result.parts.empty()) result.first = i;
        const int first = std::clamp(static_cast<int>(std::floor(from + 1e-6)), 0, cells - 1);
        const int last = std::clamp(static_cast<int>(std::ceil(to - 1e-6)), first + 1, cells);
        const auto weight = [&](int cell) {
            return std::min(to, cell + 1.0) - std::max(from, double(cell));
        };
        result.parts.push_back({static_cast<std::size_t>(first),
                                static_cast<std::size_t>(last - first), weight(first),
                                weight(last - 1)});
    }
    return result;
}

std::vector<Strip> strips_of(const Parts& across, std::size_t most_cells) {
    std::vector<Strip> strips;
    for (std::size_t i = 0; i < across.parts.size(); ++i) {
        const Part& part = across.parts[i];
        if (strips.empty() || part.end() - strips.back().first > most_cells)
            strips.push_back({i, i, part.first, 0});
        strips.back().end = i + 1;
        strips.back().width = part.end() - strips.back().first;
    }
    return strips;
}

}  // namespace relevo::dem
