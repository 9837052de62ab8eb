#pragma once

#include <algorithm>
#include <vector>

#include "light/sweep/kernels.h"
#include "light/sweep/lines.h"

namespace relevo::light {

/// The last rows of ground under lines next to each other, as crossings count them. Beside the grid
/// there is none: kNothing_m.
class GroundRows {
  public:
    /// @param line, count  the first line, and how many
    GroundRows(const SweepLines& lines, int line, int count)
        : lines_(lines),
          line_(line),
          width_(width(lines, count)),
          pitch_(pitch(lines, count)),
          height_m_(static_cast<std::size_t>(pitch_) * static_cast<std::size_t>(kept(lines)),
                    kNothing_m) {}

    /// Rows that are kept: those before a post, and the two at which the lines are meanwhile.
    static int kept(const SweepLines& lines) { return lines.nearness().near_rows + 3; }
    static int pitch(const SweepLines& lines, int count) {
        return width(lines, count) + kVectorFloats;
    }

    /// Puts a row of a sheet over the one that is kept longest.
    /// @param tilt  what is done to its heights; where from, where to and how many is set here
    void take(const Sheet& sheet, int row, RowTilt tilt) {
        const int column = first_column(row);
        const int from = std::clamp(-column, 0, width_),
                  to = std::clamp(sheet.columns - column, from, width_);
        float* const out = begin_of(row);
        std::fill(out, out + from, kNothing_m);
        std::fill(out + to, out + width_, kNothing_m);
        if (from == to) return;
        tilt.from_m = sheet.first_m + row * sheet.stride + column + from;
        tilt.to_m = out + from;
        tilt.count = to - from;
        tilt.line = column + from - lines_.row(row).column;
        tilt.between = lines_.row(row).between;
        tilt_row(tilt);
    }

    /// What crossings are over, from a line on.
    const float* from(int line) const { return height_m_.data() + (line - line_); }
    /// The ground of the posts that belong to lines, from one on.
    const float* posts(int row, int line) const {
        return from(line) + lines_.origin(row) + lines_.row(row).column;
    }

    /// The ground of a post; kNothing_m where it is not kept.
    float at(int row, int column) {
        const int i = column - first_column(row);
        return i >= 0 && i < width_ ? begin_of(row)[i] : kNothing_m;
    }
    float* begin_of(int row) {
        return height_m_.data() + static_cast<std::ptrdiff_t>(row % kept(lines_)) * pitch_;
    }
    int width() const { return width_; }
    /// The columns of the sheet that a row is taken from.
    int first_column(int row) const { return lines_.row(row).ground_column + line_; }

  private:
    static int width(const SweepLines& lines, int count) {
        return in_vectors(count + lines.ground_columns());
    }

    const SweepLines& lines_;
    int line_, width_, pitch_;
    std::vector<float> height_m_;
};

}  // namespace relevo::light
