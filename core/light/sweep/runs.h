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
    int line(int row) const { return mirrored ? rows - 1 - row : row; }
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
        if (!orientation_.transposed) return use_({orientation_.line(row), column, count, found});
        const bool goes_on = std::ssize(lines_) < kLines && row == first_row_ + std::ssize(lines_);
        if (!goes_on || !fits(column, count)) finish();
        if (lines_.empty()) begin(row, column, count);
        const auto line = static_cast<int>(lines_.size());
        std::copy_n(found, count, block_.data() + slot(line) * width_ + (column - first_column_));
        lines_.push_back({column, column + count});
    }
    /// To be called at the end.
    void finish() {
        if (lines_.empty()) return;
        const int lines = static_cast<int>(lines_.size());
        transpose(block_.data(), width_, kLines, width_, turned_.data(), kLines);
        ColumnRange any = lines_.front(),
                    all = any;  // where some line has posts, and where all have
        for (const ColumnRange& line : lines_) {
            any = {std::min(any.begin, line.begin), std::max(any.end, line.end)};
            all = {std::max(all.begin, line.begin), std::min(all.end, line.end)};
        }
        for (int column = any.begin; column < any.end; ++column) {
            if (column >= all.begin && column < all.end)
                hand_on(column, 0, lines);
            else
                hand_on_pieces(column, lines);
        }
        lines_.clear();
    }

  private:
    static constexpr std::ptrdiff_t kLines = 128, kBeside = 160;

    /// Where a line is in a block: so that columns of the grid come in their order.
    std::ptrdiff_t slot(int line) const { return orientation_.mirrored ? kLines - 1 - line : line; }
    bool fits(int column, int count) const {
        return column >= first_column_ && column + count <= first_column_ + width_;
    }
    void begin(int row, int column, int count) {
        first_row_ = row;
        first_column_ = column - kBeside;
        width_ = (count + 2 * kBeside + 3) / 4 * 4;
        block_.resize(static_cast<std::size_t>(width_ * kLines));
        turned_.resize(block_.size());
    }
    /// A row of the grid, over lines [first, end) of the block.
    void hand_on(std::ptrdiff_t column, int first, int end) {
        const int left = orientation_.mirrored ? end - 1 : first;
        use_({static_cast<int>(column), orientation_.line(first_row_ + left), end - first,
              turned_.data() + (column - first_column_) * kLines + slot(left)});
    }
    void hand_on_pieces(int column, int lines) {
        const auto has = [&](int line) {
            const ColumnRange& at = lines_[static_cast<std::size_t>(line)];
            return column >= at.begin && column < at.end;
        };
        for (int line = 0, end = 0; line < lines; line = std::max(end, line + 1)) {
            for (end = line; end < lines && has(end);)
                ++end;
            if (end > line) hand_on(column, line, end);
        }
    }

    Orientation orientation_;
    const Sweep::Use& use_;
    int first_row_ = 0;
    std::ptrdiff_t first_column_ = 0, width_ = 0;
    std::vector<ColumnRange> lines_;  // of each row of the block: where it has been found
    std::vector<float> block_, turned_;
};

}  // namespace relevo::light
