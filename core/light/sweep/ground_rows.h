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

    /// Rows that are kept: the post's own, those before it on which its own ray is followed, and
    /// the two between which the lines are meanwhile.
    static int kept(const SweepLines& lines) { return lines.sampling().near_rows + 3; }
    static int pitch(const SweepLines& lines, int count) {
        return width(lines, count) + kVectorFloats;
    }

    /// Loads a row of a sheet over the oldest one.
    /// @param fall_m, fall_per_line_m, height_offset_m  added to its heights, as RowTilt has it
    void load(const Sheet& sheet, int row, float fall_m = 0, float fall_per_line_m = 0,
              float height_offset_m = 0) {
        const int column = first_column(row);
        const int from = std::clamp(-column, 0, width_),
                  to = std::clamp(sheet.columns - column, from, width_);
        float* const out = begin_of(row);
        std::fill(out, out + from, kNothing_m);
        std::fill(out + to, out + width_, kNothing_m);
        if (from == to) return;
        tilt_row({.from_m = sheet.first_m + row * sheet.stride + column + from,
                  .stride = sheet.stride,
                  .to_m = out + from,
                  .count = to - from,
                  .fall_m = fall_m,
                  .fall_per_line_m = fall_per_line_m,
                  // The line of the first of these posts, were each on the line that it belongs to.
                  .line = column + from - lines_.row(row).column,
                  .post_offset = lines_.row(row).post_offset,
                  .height_offset_m = height_offset_m});
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
