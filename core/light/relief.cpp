#include "light/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"

namespace relevo::light {
namespace {

constexpr int kBlock = 32;  // cells a side

}  // namespace

Relief::Relief(const dem::Heightfield& field) : field_(&field) {
    dem::Statistics found = field.about.statistics;
    if (found.valid == 0) found = dem::statistics(field.height_m);
    lowest_m_ = found.min_m;
    highest_m_ = found.max_m;

    const Array2d<float>& height_m = field.height_m;
    const int columns = height_m.width(), rows = height_m.height();
    const auto blocks = [](int posts) { return std::max(1, (posts - 1 + kBlock - 1) / kBlock); };
    block_highest_m_ = Array2d<float>(blocks(columns), blocks(rows));
    parallel_for(0, block_highest_m_.height(), 8, [&](int first, int last) {
        for (int block_row = first; block_row < last; ++block_row) {
            // Cells of a block share their last posts with the next block.
            const int last_row = std::min((block_row + 1) * kBlock, rows - 1);
            for (int block = 0; block < block_highest_m_.width(); ++block) {
                const int last_column = std::min((block + 1) * kBlock, columns - 1);
                float highest_m = -std::numeric_limits<float>::infinity();
                int holes = 0;
                for (int row = block_row * kBlock; row <= last_row; ++row) {
                    const float* heights = height_m.row(row).data();
                    for (int column = block * kBlock; column <= last_column; ++column) {
                        const float h = heights[column];
                        highest_m = std::max(highest_m, h);  // a hole, NaN, changes nothing
                        holes += h != h;
                    }
                }
                block_highest_m_.at(block, block_row) = holes > 0 ? highest_m_ : highest_m;
            }
        }
    });
}

float Relief::bound_m(int first_column, int last_column, int first_row, int last_row) const {
    const auto block = [](int cell, int blocks) {
        return std::clamp(cell / kBlock, 0, blocks - 1);
    };
    const int width = block_highest_m_.width(), height = block_highest_m_.height();
    float bound_m = -std::numeric_limits<float>::infinity();
    for (int row = block(first_row, height); row <= block(last_row, height); ++row)
        for (int column = block(first_column, width); column <= block(last_column, width); ++column)
            bound_m = std::max(bound_m, block_highest_m_.at(column, row));
    return bound_m;
}

}  // namespace relevo::light
