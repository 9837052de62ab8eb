#include "figure/figure.h"

#include <algorithm>
#include <cmath>

namespace relevo::figure {

Array2d<std::uint8_t> mask_of(const Array2d<float>& lit) {
    Array2d<std::uint8_t> mask(lit.width(), lit.height());
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask.data()[i] = std::isnan(lit.data()[i]) ? 255 : lit.data()[i] > 0;
    return mask;
}

std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts) {
    constexpr int kBlock = 512;  // blocks of the output file [posts]
    const int fitting = static_cast<int>(std::sqrt(static_cast<double>(most_posts)));
    const int side = std::max(kBlock, fitting / kBlock * kBlock);
    std::vector<dem::Window> parts;
    for (int row = 0; row < window.rows; row += side)
        for (int column = 0; column < window.columns; column += side)
            parts.push_back({window.column + column, window.row + row,
                             std::min(side, window.columns - column),
                             std::min(side, window.rows - row)});
    return parts;
}

}  // namespace relevo::figure
