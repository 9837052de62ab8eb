#include "dem/survey.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/progress.h"

namespace relevo::dem {
namespace {

constexpr std::int64_t kLeastPosts = 1 << 18;
constexpr std::int64_t kMaxPosts = 1 << 23;

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
class Strip {
  public:
    Strip(const Source& source, int first, int last, Survey& survey,
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
        const Array2d<float> read = source_.read(window, window.columns, window.rows);
        const int before = tail_.height();
        Array2d<float> all(window.columns, before + rows);
        std::copy(tail_.begin(), tail_.end(), all.begin());
        std::copy(read.begin(), read.end(), all.begin() + before * std::ptrdiff_t{window.columns});
        take(all, row - before, before, read);
        keep_tail(all);
    }

    /// The next rows, of one height.
    void add_blank(int row, int rows, float height_m) {
        const int shown = std::min(rows, 2);
        const Array2d<float> begin(right_ - left_, shown, height_m);
        const int before = tail_.height();
        Array2d<float> all(right_ - left_, before + shown);
        std::copy(tail_.begin(), tail_.end(), all.begin());
        std::copy(begin.begin(), begin.end(), all.begin() + before * std::ptrdiff_t{all.width()});
        take(all, row - before, before, begin);
        survey_.statistics += statistics(height_m, std::int64_t{rows - shown} * (last_ - first_));
        keep_tail(all);
    }

  private:
    /// @param row    of the DEM, where `all` begins
    /// @param known  rows at its beginning that statistics have had
    /// @param fresh  those after them
    void take(const Array2d<float>& all, int row, int known, const Array2d<float>& fresh) {
        const Window own{first_ - left_, 0, last_ - first_, fresh.height()};
        survey_.statistics += own.column == 0 ? statistics(fresh, own.columns, own.rows)
                                              : statistics(part_of(fresh, own));
        // A post's neighbours are known once the next row is; the DEM's last one has none.
        const int begin = known > 0 ? known - 1 : 0;
        const bool ends = row + all.height() == source_.grid().rows();
        const int end = ends ? all.height() : all.height() - 1;
        if (end > begin) {
            const Window core{own.column, begin, own.columns, end - begin};
            dem::add(survey_.spikes, find_spikes(all, spacing_m_, core), {left_, row});
        }
        if (collar_steps_)
            collar_steps_->add(
                part_of(all, {own.column, begin, all.width() - own.column, all.height() - begin}));
    }

    static Array2d<float> part_of(const Array2d<float>& all, const Window& window) {
        Array2d<float> part(window.columns, window.rows);
        for (int row = 0; row < window.rows; ++row)
            std::copy_n(&all.at(window.column, window.row + row), window.columns, &part.at(0, row));
        return part;
    }

    void keep_tail(const Array2d<float>& all) {
        const int rows = std::min(2, all.height());
        tail_ = part_of(all, {0, all.height() - rows, all.width(), rows});
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
    std::optional<CollarSteps> collar_steps = collar_steps_of(source);
    // Whole rows of blocks, and of these as many columns as there is room for.
    const std::int64_t room = std::clamp(max_posts / 4, kLeastPosts, kMaxPosts);
    const int block_rows =
        static_cast<int>(std::min<std::int64_t>({source.block_rows(), rows, room / 64}));
    const int strip_columns = static_cast<int>(std::min<std::int64_t>(columns, room / block_rows));
    const int band_rows = static_cast<int>(std::min<std::int64_t>(
        rows, std::max<std::int64_t>(1, room / strip_columns / block_rows) * block_rows));
    Progress progress(source.description().path + ": reading all posts", double(columns) * rows);
    for (int first = 0; first < columns;) {
        const int last =
            static_cast<int>(std::min<std::int64_t>(columns, std::int64_t{first} + strip_columns));
        Strip strip(source, first, last, result, collar_steps);
        for (int row = 0; row < rows;) {
            const Source::Blank blank =
                source.blank({std::max(0, first - 1), row,
                              std::min(columns, last + 1) - std::max(0, first - 1), rows - row});
            int count = blank.rows;
            if (count > 0) {
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
