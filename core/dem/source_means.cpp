#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel_for.h"
#include "base/progress.h"
#include "dem/cell_parts.h"
#include "dem/source_impl.h"

namespace relevo::dem {
namespace {

/// Reading more posts takes seconds, and shows its progress.
constexpr double kSlowPosts = 1 << 28;

}  // namespace

const Resolution& coarsest_level(const Piece& piece, double columns_each, double rows_each) {
    const Resolution* best = &piece.levels.front();
    for (const Resolution& level : piece.levels)
        if (level.columns < best->columns && level.columns * columns_each >= piece.place.columns &&
            level.rows * rows_each >= piece.place.rows)
            best = &level;
    return *best;
}

/// Parts that follow each other along a line.
struct Source::Impl::Span {
    int begin = 0, end = 0;
};

/// What means are asked for.
struct Source::Impl::Means {
    Window window;
    int columns, rows;
    Progress* progress;
    double columns_each = window.columns / double(columns);  // posts
    double rows_each = window.rows / double(rows);
};

/// Sums over the parts of a window, in posts of the DEM; of some rows and columns of parts.
struct Source::Impl::Sums {
    Span across, down;
    Array2d<double> height;  // of valid posts, times area
    Array2d<double> area;    // of them

    Sums(const Span& across_, const Span& down_)
        : across(across_),
          down(down_),
          height(across.end - across.begin, down.end - down.begin),
          area(across.end - across.begin, down.end - down.begin) {}

    void add(int column, int row, double more_height, double more_area) {
        height.at(column - across.begin, row - down.begin) += more_height;
        area.at(column - across.begin, row - down.begin) += more_area;
    }
    /// Those of some of the parts.
    void add(const Sums& others) {
        for (int row = others.down.begin; row < others.down.end; ++row)
            for (int column = others.across.begin; column < others.across.end; ++column) {
                const int c = column - others.across.begin, r = row - others.down.begin;
                if (others.area.at(c, r) != 0)
                    add(column, row, others.height.at(c, r), others.area.at(c, r));
            }
    }
};

/// The parts of a line with cells of a piece, of its posts [first, first + count) alone.
/// @param begin  of the line, in posts of the piece
/// @param per    cells in a post
Parts Source::Impl::parts_of_line(double begin, double each, const Span& parts, double per,
                                  int first, int count) {
    const int from = static_cast<int>(std::lround(first * per));
    const int to = static_cast<int>(std::lround((first + count) * per));
    if (to <= from) return {};
    Parts found = parts_within(begin - from / per, each, parts.begin, parts.end, per, to - from);
    for (Part& part : found.parts)
        part.first += static_cast<std::size_t>(from);
    return found;
}

/// Adds what a raster has of some parts.
// In one piece: one pass over the cells, whose buffers all of its loops share.
void Source::Impl::add_means(int number, const Means& means, const Span& columns, const Span& rows,
                             Sums& sums) const {
    const Piece* const opened = rasters->open(number);
    if (!opened) return;
    const Piece& piece = *opened;
    const Window& window = means.window;
    const double columns_each = means.columns_each, rows_each = means.rows_each;
    const Resolution& level = coarsest_level(piece, columns_each, rows_each);
    // Cells of the level in one post.
    const double per_column = level.columns / double(piece.place.columns);
    const double per_row = level.rows / double(piece.place.rows);
    const Window own = common(piece.place, rasters->reach(number));
    const auto across = parts_of_line(window.column - piece.place.column, columns_each, columns,
                                      per_column, own.column - piece.place.column, own.columns);
    const auto down = parts_of_line(window.row - piece.place.row, rows_each, rows, per_row,
                                    own.row - piece.place.row, own.rows);
    if (across.parts.empty() || down.parts.empty()) return;
    const bool may_skip = piece.sparse && level.overview < 0;
    // What is not stored is skipped strip by strip. Tiles that rows of parts have in common are
    // decoded once: strips are as wide as GDAL's cache has room for their tiles, and are gone down
    // one after the other.
    constexpr std::size_t kMaxCells = std::size_t{1} << 18, kFewestCells = std::size_t{1} << 13;
    // With threads at several strips, and cells of up to four bytes.
    const std::size_t cached = static_cast<std::size_t>(block_bytes) / 16;
    const bool tiled = static_cast<std::size_t>(piece.block_columns) <= kFewestCells / 2;
    const std::size_t most_cells =
        may_skip ? kFewestCells
        : tiled  ? std::clamp(cached / static_cast<std::size_t>(piece.block_rows), kFewestCells,
                              kMaxCells)
                 : kMaxCells;
    const std::vector<Strip> strips = strips_of(across, most_cells);

    const auto add_rows = [&](int first, int last) {
        std::vector<float> cells;
        std::vector<double> heights;  // of valid cells, down a column of the part
        std::vector<double> weights;  // their areas
        const auto add_strip = [&](void* dataset, int row, const Strip& strip) {
            const Part& lines = down.parts[static_cast<std::size_t>(row)];
            const auto add = [&](std::size_t i, double sum, double weight) {
                sums.add(across.first + static_cast<int>(i), down.first + row,
                         sum / (per_column * per_row), weight / (per_column * per_row));
            };
            const Window within{static_cast<int>(strip.first), static_cast<int>(lines.first),
                                static_cast<int>(strip.width), static_cast<int>(lines.count)};
            if (may_skip && piece.sparse->is_empty(within)) {
                for (std::size_t i = strip.begin; i < strip.end && !std::isnan(piece.unstored_m);
                     ++i) {
                    const double weight = across.parts[i].whole() * lines.whole();
                    add(i, weight * double(piece.unstored_m), weight);
                }
                return;
            }
            heights.assign(strip.width, 0.0);
            weights.assign(strip.width, 0.0);
            // A part of a huge raster without overviews does not fit into memory at once.
            const std::size_t slice_lines =
                std::max<std::size_t>(1, (std::size_t{1} << 18) / strip.width);
            for (std::size_t k = 0; k < lines.count; ++k) {
                const std::size_t in_slice = k % slice_lines;
                if (in_slice == 0) {
                    const std::size_t n = std::min(slice_lines, lines.count - k);
                    cells.resize(strip.width * n);
                    rasters->read_level(piece, dataset, level,
                                        {within.column, within.row + static_cast<int>(k),
                                         within.columns, static_cast<int>(n)},
                                        cells.data());
                }
                const float* line = &cells[in_slice * strip.width];
                const double whole = lines.weight(k);
                for (std::size_t c = 0; c < strip.width; ++c) {
                    const double weight = std::isnan(line[c]) ? 0.0 : whole;
                    heights[c] += weight == 0 ? 0.0 : weight * double(line[c]);
                    weights[c] += weight;
                }
            }
            for (std::size_t i = strip.begin; i < strip.end; ++i) {
                const Part& part = across.parts[i];
                double sum = 0;
                double weight = 0;
                for (std::size_t k = 0; k < part.count; ++k) {
                    sum += part.weight(k) * heights[part.first - strip.first + k];
                    weight += part.weight(k) * weights[part.first - strip.first + k];
                }
                add(i, sum, weight);
            }
        };
        const auto tell = [&](const Strip& strip) {
            if (means.progress)
                means.progress->add(rows_each * double(strip.end - strip.begin) / means.columns);
        };
        rasters->read(number, piece, [&](void* dataset) {
            const int at_once = tiled ? last - first : 1;
            for (int begin = first; begin < last; begin += at_once)
                for (const Strip& strip : strips)
                    for (int row = begin; row < std::min(last, begin + at_once); ++row) {
                        add_strip(dataset, row, strip);
                        tell(strip);
                    }
        });
    };
    const auto width = static_cast<int>(across.parts.back().end() - across.parts.front().first);
    const int count = static_cast<int>(down.parts.size());
    // Every thread has a cache of its own.
    const int block_parts =
        static_cast<int>(std::min<double>(count, piece.block_rows / (rows_each * per_row)));
    if (piece.threads_pay)
        parallel_for(0, count, std::max({1, (1 << 17) / width, block_parts}), add_rows);
    else
        add_rows(0, count);
}

/// Those of `all`, of so many posts each, that have posts in [first, end).
Source::Impl::Span Source::Impl::parts_over(int first, int end, double each, const Span& all) {
    return {std::max(all.begin, static_cast<int>(std::floor(first / each))),
            std::min(all.end, static_cast<int>(std::ceil(end / each)))};
}

/// Adds all rasters. Small ones are summed up apart, at once, and added in their order: sums of
/// numbers depend on it in the last bit.
void Source::Impl::add_band(const Means& means, Sums& sums) const {
    constexpr std::int64_t kSmall = 1 << 22;  // posts
    const std::int64_t at_once = std::min<std::int64_t>(1 << 20, room_for_sums());
    const Window& window = means.window;
    std::vector<std::pair<int, Sums>> small;  // with the numbers of the rasters
    std::int64_t parts = 0;
    const auto add_small = [&] {
        parallel_for(0, static_cast<int>(small.size()), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                auto& [number, own] = small[static_cast<std::size_t>(i)];
                add_means(number, means, own.across, own.down, own);
            }
        });
        for (const auto& [number, own] : small)
            sums.add(own);
        small.clear();
        parts = 0;
    };
    const int first_row = window.row + static_cast<int>(sums.down.begin * means.rows_each);
    const int end_row = window.row + static_cast<int>(std::ceil(sums.down.end * means.rows_each));
    for (const int number :
         rasters->within({window.column, first_row, window.columns, end_row - first_row})) {
        const Window& reach = rasters->reach(number);
        const Span across =
            parts_over(reach.column - window.column, reach.end_column() - window.column,
                       means.columns_each, sums.across);
        const Span down = parts_over(reach.row - window.row, reach.end_row() - window.row,
                                     means.rows_each, sums.down);
        if (across.begin >= across.end || down.begin >= down.end) continue;
        const std::int64_t size = std::int64_t{across.end - across.begin} * (down.end - down.begin);
        const bool is_large = std::int64_t{reach.columns} * reach.rows > kSmall;
        if ((is_large && rasters->sample(number).threads_pay) || size > at_once) {
            add_small();
            add_means(number, means, across, down, sums);
            continue;
        }
        if (parts + size > at_once) add_small();
        small.emplace_back(number, Sums(across, down));
        parts += size;
    }
    add_small();
}

/// Parts whose sums fit into the memory for work.
std::int64_t Source::Impl::room_for_sums() const {
    constexpr std::int64_t kLeast = 1 << 12;
    return std::max(kLeast, work_bytes / std::int64_t{2 * sizeof(double)});
}

Array2d<float> Source::Impl::read_means(const Window& window, int columns, int rows) const {
    std::optional<Progress> progress;
    if (double(window.columns) * window.rows > kSlowPosts)
        progress.emplace(about.path + ": reading",
                         static_cast<double>(rasters->count()) * window.rows);
    const Means means{window, columns, rows, progress ? &*progress : nullptr};
    const double area = means.columns_each * means.rows_each * (1 - 1e-9);
    Array2d<float> result(columns, rows, kHole);
    // Sums take four times the memory of what they become. Bands end where blocks do.
    const std::int64_t room = room_for_sums();
    const auto band_columns = static_cast<int>(std::min<std::int64_t>(columns, room));
    int band_rows =
        std::max(1, static_cast<int>(std::min<std::int64_t>(rows, room / band_columns)));
    const int block_rows = rasters->is_one_file() ? rasters->if_open(0)->block_rows : 1;
    if (const int of_block = static_cast<int>(double(block_rows) * rows / window.rows);
        of_block > 1 && band_rows >= of_block)
        band_rows -= band_rows % of_block;
    for (int first_row = 0; first_row < rows; first_row += band_rows)
        for (int first_column = 0; first_column < columns; first_column += band_columns) {
            const int width = std::min(band_columns, columns - first_column);
            const int height = std::min(band_rows, rows - first_row);
            Sums sums({first_column, first_column + width}, {first_row, first_row + height});
            add_band(means, sums);
            for (int row = 0; row < height; ++row)
                for (int column = 0; column < width; ++column)
                    if (sums.area.at(column, row) >= 0.5 * area)
                        result.at(first_column + column, first_row + row) = static_cast<float>(
                            sums.height.at(column, row) / sums.area.at(column, row));
        }
    return result;
}

}  // namespace relevo::dem
