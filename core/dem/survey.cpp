#include "dem/survey.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/progress.h"
#include "dem/load.h"

namespace relevo::dem {
namespace {

constexpr std::int64_t kLeastRoom = 1 << 18;
constexpr std::int64_t kMaxRoom = 1 << 23;

/// @param at  where the part's first post is
void add(Spikes& total, const Spikes& part, const glm::ivec2& at) {
    total.count += part.count;
    total.limit_m = part.limit_m;
    if (!(part.worst_m > total.worst_m)) return;
    total.worst_m = part.worst_m;
    total.worst_column = at.x + part.worst_column;
    total.worst_row = at.y + part.worst_row;
}

/// The columns [first, last) of rows that follow each other, each with one more row above and with
/// one more column on each side where the DEM has them: those that have a part in what is said of
/// posts beside them.
class SurveyStrip {
  public:
    SurveyStrip(const Source& source, int first, int last, Survey& survey,
                std::optional<CollarSteps>& collar_steps)
        : source_(source),
          left_(std::max(0, first - 1)),
          first_(first),
          last_(last),
          right_(std::min(source.grid().columns(), last + 1)),
          survey_(survey),
          collar_steps_(collar_steps),
          spacing_m_(source.grid().post_spacing_m()) {}

    /// The next rows.
    void add(int row, int rows) {
        const Window window{left_, row, right_ - left_, rows};
        take(row, source_.read(window, window.columns, window.rows));
    }

    /// The next rows, of one height.
    void add_blank(int row, int rows, float height_m) {
        const int shown = std::min(rows, 2);
        take(row, Array2d<float>(right_ - left_, shown, height_m));
        survey_.statistics += statistics(height_m, std::int64_t{rows - shown} * (last_ - first_));
    }

  private:
    void take(int row, Array2d<float> fresh) {
        const int known = tail_.height();
        const Array2d<float> all = below_tail(std::move(fresh));
        const int column = first_ - left_, columns = last_ - first_, rows = all.height();
        survey_.statistics += statistics(all, {column, known, columns, rows - known});
        // A post's neighbours are known once the next row is; the DEM's last one has none.
        const int top = row - known, begin = known > 0 ? known - 1 : 0;
        const bool ends = top + rows == source_.grid().rows();
        const int end = ends ? rows : rows - 1;
        if (end > begin)
            dem::add(survey_.spikes,
                     find_spikes(all, spacing_m_, {column, begin, columns, end - begin}),
                     {left_, top});
        if (collar_steps_)
            collar_steps_->add(all, {column, begin, all.width() - column, rows - begin});
        if (!ends) keep_tail(all);
    }

    Array2d<float> below_tail(Array2d<float> fresh) const {
        if (tail_.empty()) return fresh;
        Array2d<float> all(tail_.width(), tail_.height() + fresh.height());
        std::copy(fresh.begin(), fresh.end(), std::copy(tail_.begin(), tail_.end(), all.begin()));
        return all;
    }

    void keep_tail(const Array2d<float>& all) {
        tail_ = Array2d<float>(all.width(), std::min(2, all.height()));
        std::copy(all.end() - static_cast<std::ptrdiff_t>(tail_.size()), all.end(), tail_.begin());
    }

    const Source& source_;
    int left_, first_, last_, right_;
    Survey& survey_;
    std::optional<CollarSteps>& collar_steps_;
    glm::dvec2 spacing_m_;
    Array2d<float> tail_;  // the last two rows
};

}  // namespace

std::optional<CollarSteps> collar_steps_of(const Source& source) {
    constexpr int kAtOnce = 1 << 20;
    const int columns = source.grid().columns(), rows = source.grid().rows();
    const auto post = [&](int column, int row) {
        return source.read({column, row, 1, 1}, 1, 1).at(0, 0);
    };
    CollarEdge edge(post(0, 0), 2 * (std::int64_t{columns} + rows));
    for (const int row : {0, rows - 1})
        for (const int column : {0, columns - 1})
            edge.add_corner(post(column, row));
    for (const int row : {0, rows - 1})
        for (int column = 0; column < columns && edge.may_be_collar();) {
            const Window piece{column, row, std::min(kAtOnce, columns - column), 1};
            if (const Source::Blank blank = source.blank(piece); blank.rows > 0)
                edge.add(blank.height_m, piece.columns);
            else
                edge.add(source.read(piece, piece.columns, 1).row(0));
            column += piece.columns;
        }
    for (const int column : {0, columns - 1})
        for (int row = 0; row < rows && edge.may_be_collar();) {
            Window piece{column, row, 1, rows - row};
            if (const Source::Blank blank = source.blank(piece); blank.rows > 0) {
                piece.rows = blank.rows;
                edge.add(blank.height_m, blank.rows);
            } else {
                piece.rows = std::min(piece.rows, kAtOnce);
                const Array2d<float> read = source.read(piece, 1, piece.rows);
                edge.add({read.data(), read.size()});
            }
            row += piece.rows;
        }
    return edge.may_be_collar() ? std::optional<CollarSteps>(edge.height_m()) : std::nullopt;
}

Survey survey(const Source& source, std::int64_t max_posts) {
    const int columns = source.grid().columns(), rows = source.grid().rows();
    Survey result;
    result.spikes.limit_m = find_spikes({}, source.grid().post_spacing_m()).limit_m;
    if (const Source::Blank all = source.blank({0, 0, columns, rows}); all.rows == rows) {
        result.statistics = statistics(all.height_m, std::int64_t{columns} * rows);
        return result;
    }
    // Read in seconds, whatever the shape; of more, what nothing else takes is not read for
    // minutes.
    constexpr std::int64_t kSoon = std::int64_t{1} << 30;
    if (std::int64_t{columns} * rows > kSoon) refuse_endless_sides(source);
    std::optional<CollarSteps> collar_steps = collar_steps_of(source);
    // Whole rows of blocks, and of these as many columns as there is room for.
    const std::int64_t room = std::clamp(max_posts / 4, kLeastRoom, kMaxRoom);
    const int block_rows =
        static_cast<int>(std::min<std::int64_t>({source.block_rows(), rows, room / 64}));
    const int strip_columns = static_cast<int>(std::min<std::int64_t>(columns, room / block_rows));
    const int band_rows = static_cast<int>(std::min<std::int64_t>(
        rows, std::max<std::int64_t>(1, room / strip_columns / block_rows) * block_rows));
    Progress progress(source.description().path + ": reading all posts", double(columns) * rows);
    for (int first = 0; first < columns;) {
        const int last =
            static_cast<int>(std::min<std::int64_t>(columns, std::int64_t{first} + strip_columns));
        SurveyStrip strip(source, first, last, result, collar_steps);
        for (int row = 0; row < rows;) {
            const Source::Blank blank =
                source.blank({std::max(0, first - 1), row,
                              std::min(columns, last + 1) - std::max(0, first - 1), rows - row});
            int count = blank.rows;
            if (count == rows) {  // nothing stands out of it
                result.statistics +=
                    statistics(blank.height_m, std::int64_t{rows} * (last - first));
            } else if (count > 0) {
                strip.add_blank(row, count, blank.height_m);
            } else {
                count = std::min(band_rows - row % band_rows, rows - row);
                strip.add(row, count);
            }
            row += count;
            progress.add(double(count) * (last - first));
        }
        first = last;
    }
    if (collar_steps) result.collar = collar_steps->collar();
    return result;
}

}  // namespace relevo::dem
