#include "render/block_means.h"

#include <cmath>
#include <limits>

#include "base/parallel_for.h"

namespace relevo::render {

Array2d<float> block_means(const Array2d<float>& height_m, int side, float factor) {
    const int columns = height_m.width() / side, rows = height_m.height() / side;
    Array2d<float> means(columns, rows);
    parallel_for(0, rows, 8, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < columns; ++column) {
                float sum = 0;
                int count = 0;
                for (int y = row * side; y < (row + 1) * side; ++y)
                    for (int x = column * side; x < (column + 1) * side; ++x) {
                        const float h = height_m.at(x, y);
                        if (std::isnan(h)) continue;
                        sum += h;
                        ++count;
                    }
                means.at(column, row) = count > 0 ? factor * sum / static_cast<float>(count)
                                                  : std::numeric_limits<float>::quiet_NaN();
            }
    });
    return means;
}

}  // namespace relevo::render
