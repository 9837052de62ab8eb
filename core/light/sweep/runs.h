#pragma once

#include <algorithm>
#include <vector>

#include "light/sweep/kernels.h"
#include "light/sweep/lines.h"
#include "light/sweep/sweep.h"

namespace relevo::light {

/// How the grid lies on a sheet.
struct Orientation {
    bool transposed = false;  ///< rows of the sheet are columns of the grid
    bool mirrored = false;    ///< they are counted from the other end
    int rows = 0;             ///< of the sheet

    /// The row or column of the grid that a row of the sheet is.
    int grid_index(int row) const { return mirrored ? rows - 1 - row : row; }
};

/// Hands on what a strip finds as runs along rows of the grid, whichever way the strip goes.
class Runs {
  public:
    Runs(const Orientation& orientation, const Sweep::Use& use)
        : orientation_(orientation), use_(use) {}
    Runs(const Runs&) = delete;
    Runs& operator=(const Runs&) = delete;

    /// Posts next to each other in a row of the sheet; rows come in order.
    void add(int row, int column, int count, const float* found) {
        if (!orientation_.transposed)
            return use_({orientation_.grid_index(row), column, count, found});
        const bool goes_on =
            std::ssize(filled_) < kBufferRows && row == first_row_ + std::ssize(filled_);
        if (!goes_on || !fits(column, count)) finish();
        if (filled_.empty()) begin(row, column, count);
        const auto buffer_row = static_cast<int>(filled_.size());
        std::copy_n(found, count,
                    buffer_.data() + slot(buffer_row) * width_ + (column - first_column_));
        filled_.push_back({column, column + count});
    }
    /// To be called at the end.
    void finish() {
        if (filled_.empty()) return;
        const int rows = static_cast<int>(filled_.size());
        ColumnRange any = filled_.front(),
                    all = any;  // where some row has posts, and where all have
        for (const ColumnRange& row : filled_) {
            any = {std::min(any.begin, row.begin), std::max(any.end, row.end)};
            all = {std::max(all.begin, row.begin), std::min(all.end, row.end)};
        }
        const std::ptrdiff_t first = any.begin - first_column_;
        transpose(buffer_.data() + first, width_, kBufferRows, any.end - any.begin,
                  transposed_.data() + first * kBufferRows, kBufferRows);
        for (int column = any.begin; column < any.end; ++column) {
            if (column >= all.begin && column < all.end)
                hand_on(column, 0, rows);
            else
                hand_on_pieces(column, rows);
        }
        filled_.clear();
    }

  private:
    static constexpr std::ptrdiff_t kBufferRows = 128, kBeside = 160;

    /// Where a row of the sheet is in the buffer: so that columns of the grid come in their order.
    std::ptrdiff_t slot(int row) const {
        return orientation_.mirrored ? kBufferRows - 1 - row : row;
    }
    bool fits(int column, int count) const {
        return column >= first_column_ && column + count <= first_column_ + width_;
    }
    void begin(int row, int column, int count) {
        first_row_ = row;
        first_column_ = column - kBeside;
        width_ = (count + 2 * kBeside + 3) / 4 * 4;
        buffer_.resize(static_cast<std::size_t>(width_ * kBufferRows));
        transposed_.resize(buffer_.size());
    }
    /// A row of the grid: over rows [first, end) of the buffer.
    void hand_on(std::ptrdiff_t column, int first, int end) {
        const int left = orientation_.mirrored ? end - 1 : first;
        use_({static_cast<int>(column), orientation_.grid_index(first_row_ + left), end - first,
              transposed_.data() + (column - first_column_) * kBufferRows + slot(left)});
    }
    void hand_on_pieces(int column, int rows) {
        const auto has = [&](int row) {
            const ColumnRange& filled = filled_[static_cast<std::size_t>(row)];
            return column >= filled.begin && column < filled.end;
        };
        for (int row = 0, end = 0; row < rows; row = std::max(end, row + 1)) {
            for (end = row; end < rows && has(end);)
                ++end;
            if (end > row) hand_on(column, row, end);
        }
    }

    Orientation orientation_;
    const Sweep::Use& use_;
    int first_row_ = 0;
    std::ptrdiff_t first_column_ = 0, width_ = 0;
    std::vector<ColumnRange> filled_;  // of each row of the buffer: its posts
    std::vector<float> buffer_, transposed_;
};

}  // namespace relevo::light
