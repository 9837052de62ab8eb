#include "dem/source.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "dem/cell_parts.h"
#include "dem/clip.h"
#include "dem/folder.h"
#include "dem/gdal_support.h"
#include "dem/on_earth.h"
#include "dem/piece.h"

namespace relevo::dem {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
/// Handles kept open between reads. A process may have 1024 files open; tiles come in thousands.
constexpr std::size_t kMaxIdle = 128;
/// Of more than these, some seconds of reading, progress is told.
constexpr double kManyPosts = 1 << 28;

/// The part of a window that a piece covers; no columns or rows where it covers none.
Window overlap(const Window& a, const Window& b) {
    const int column = std::max(a.column, b.column);
    const int row = std::max(a.row, b.row);
    return {column, row, std::min(a.column + a.columns, b.column + b.columns) - column,
            std::min(a.row + a.rows, b.row + b.rows) - row};
}

bool is_empty(const Window& window) {
    return window.columns <= 0 || window.rows <= 0;
}

/// The coarsest level that still has a cell for every `columns_each` by `rows_each` posts.
const Resolution& coarsest_level(const Piece& piece, double columns_each, double rows_each) {
    const Resolution* best = &piece.levels.front();
    for (const Resolution& level : piece.levels)
        if (level.columns < best->columns && level.columns * columns_each >= piece.place.columns &&
            level.rows * rows_each >= piece.place.rows)
            best = &level;
    return *best;
}

}  // namespace

struct Source::Impl {
    std::vector<Piece> pieces;
    std::optional<Grid> grid;
    Description about;
    bool threads_pay = false;
    int block_rows = 1;
    int tallest_block = 1;
    std::int64_t work_bytes = 0;  // for sums
    bool leaves_earth = false;    // some posts have no place

    // Open handles that no call is using, the one used last at the end; a GDAL dataset serves one
    // thread at a time.
    struct Idle {
        const Piece* piece;
        Dataset dataset;
    };
    mutable std::mutex mutex;
    mutable std::vector<Idle> idle;

    void crop(const Window& window);
    template <typename Body>
    void borrow(const Piece& piece, const Body& body) const;
    Array2d<float> read_stored(const Window& window) const;
    Array2d<float> read_means(const Window& window, int columns, int rows) const;
    struct Sums;
    void add_means(const Piece& piece, const Window& window, int columns, int rows, Sums& sums,
                   Progress* progress) const;
    Blank blank(const Window& window) const;
};

/// Leaves the posts of a window. Pieces keep theirs, of which some are then outside.
void Source::Impl::crop(const Window& window) {
    grid = grid->part(window, window.columns, window.rows);
    for (Piece& piece : pieces) {
        piece.place.column -= window.column;
        piece.place.row -= window.row;
    }
}

template <typename Body>
void Source::Impl::borrow(const Piece& piece, const Body& body) const {
    Dataset mine;
    {
        const std::lock_guard lock(mutex);
        const auto found = std::find_if(idle.rbegin(), idle.rend(),
                                        [&](const Idle& one) { return one.piece == &piece; });
        if (found != idle.rend()) {
            mine = std::move(found->dataset);
            idle.erase(std::next(found).base());
        }
    }
    if (!mine) mine = piece.open();
    body(mine.get());
    const std::lock_guard lock(mutex);
    if (idle.size() >= kMaxIdle) idle.erase(idle.begin());
    idle.push_back({&piece, std::move(mine)});
}

Array2d<float> Source::Impl::read_stored(const Window& window) const {
    Array2d<float> height_m(window.columns, window.rows, kHole);
    // Pieces of whole rows of blocks, large enough to be worth a thread.
    constexpr int kPosts = 1 << 17;
    const int wanted_rows = std::max(1, kPosts / window.columns);
    const int slice_rows = (wanted_rows + block_rows - 1) / block_rows * block_rows;
    const int first_slice = window.row / slice_rows;
    const int last_slice = (window.row + window.rows + slice_rows - 1) / slice_rows;
    const auto read_slice = [&](const Piece& piece, void* dataset, const Window& slice) {
        const Window part = overlap(slice, piece.place);
        const Window own{part.column - piece.place.column, part.row - piece.place.row, part.columns,
                         part.rows};
        if (piece.sparse && piece.sparse->is_empty(own)) {
            for (int row = part.row - window.row; row < part.row - window.row + part.rows; ++row)
                for (int column = 0; column < part.columns && !std::isnan(piece.unstored_m);
                     ++column)
                    height_m.at(part.column - window.column + column, row) = piece.unstored_m;
            return;
        }
        if (pieces.size() == 1) {
            piece.read(dataset, piece.levels.front(), own, &height_m.at(0, slice.row - window.row));
            return;
        }
        std::vector<float> heights(static_cast<std::size_t>(part.columns) *
                                   static_cast<std::size_t>(part.rows));
        piece.read(dataset, piece.levels.front(), own, heights.data());
        const float* from = heights.data();
        for (int row = 0; row < part.rows; ++row) {
            float* const to =
                &height_m.at(part.column - window.column, part.row + row - window.row);
            for (int column = 0; column < part.columns; ++column, ++from)
                to[column] = std::isnan(*from) ? to[column] : *from;
        }
    };
    const auto read_slices = [&](int first, int last) {
        const int from = std::max(first * slice_rows, window.row);
        const int to = std::min(last * slice_rows, window.row + window.rows);
        const Window all{window.column, from, window.columns, to - from};
        for (const Piece& piece : pieces) {
            if (is_empty(overlap(all, piece.place))) continue;
            borrow(piece, [&](void* dataset) {
                for (int i = first; i < last; ++i) {
                    const int begin = std::max(i * slice_rows, window.row);
                    const int end = std::min((i + 1) * slice_rows, window.row + window.rows);
                    const Window slice{window.column, begin, window.columns, end - begin};
                    if (!is_empty(overlap(slice, piece.place))) read_slice(piece, dataset, slice);
                }
            });
        }
    };
    if (threads_pay)
        parallel_for(first_slice, last_slice, 1, read_slices);
    else
        read_slices(first_slice, last_slice);
    return height_m;
}

/// Sums over the parts of a window, in posts of the DEM; of some rows and columns of parts.
struct Source::Impl::Sums {
    int first_column = 0, first_row = 0;
    Array2d<double> height;  // of valid posts, times area
    Array2d<double> area;    // of them
};

// In one piece: one pass over the cells, whose buffers all of its loops share.
void Source::Impl::add_means(const Piece& piece, const Window& window, int columns, int rows,
                             Sums& sums, Progress* progress) const {
    const double columns_each = window.columns / double(columns);
    const double rows_each = window.rows / double(rows);
    const Resolution& level = coarsest_level(piece, columns_each, rows_each);
    // Cells of the level in one post.
    const double per_column = level.columns / double(piece.place.columns);
    const double per_row = level.rows / double(piece.place.rows);
    const auto across =
        parts_within(window.column - piece.place.column, columns_each, sums.first_column,
                     sums.first_column + sums.height.width(), per_column, level.columns);
    const auto down = parts_within(window.row + sums.first_row * rows_each - piece.place.row,
                                   rows_each, 0, sums.height.height(), per_row, level.rows);
    if (across.parts.empty() || down.parts.empty()) return;
    const bool may_skip = piece.sparse && level.overview < 0;
    // What is not stored is skipped strip by strip. Tiles that rows of parts have in common are
    // decoded once: strips are as wide as GDAL's cache has room for their tiles, and are gone down
    // one after the other.
    constexpr std::size_t kMaxCells = std::size_t{1} << 18, kFewestCells = std::size_t{1} << 13,
                          kCached = std::size_t{1} << 24;
    const bool tiled = static_cast<std::size_t>(piece.block_columns) <= kFewestCells / 2;
    const std::size_t most_cells =
        may_skip ? kFewestCells
        : tiled  ? std::clamp(kCached / static_cast<std::size_t>(piece.block_rows), kFewestCells,
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
                const int column = across.first - sums.first_column + static_cast<int>(i);
                sums.height.at(column, down.first + row) += sum / (per_column * per_row);
                sums.area.at(column, down.first + row) += weight / (per_column * per_row);
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
                    piece.read(dataset, level,
                               {within.column, within.row + static_cast<int>(k), within.columns,
                                static_cast<int>(n)},
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
            if (progress) progress->add(rows_each * double(strip.end - strip.begin) / columns);
        };
        borrow(piece, [&](void* dataset) {
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

Array2d<float> Source::Impl::read_means(const Window& window, int columns, int rows) const {
    const double area =
        window.columns / double(columns) * (window.rows / double(rows)) * (1 - 1e-9);
    Array2d<float> result(columns, rows, kHole);
    std::optional<Progress> progress;
    if (double(window.columns) * window.rows > kManyPosts)
        progress.emplace(about.path + ": reading",
                         static_cast<double>(pieces.size()) * window.rows);
    // Sums take four times the memory of what they become. Bands end where blocks do.
    const std::int64_t room =
        std::max<std::int64_t>(1 << 12, work_bytes / std::int64_t{2 * sizeof(double)});
    const auto band_columns = static_cast<int>(std::min<std::int64_t>(columns, room));
    int band_rows =
        std::max(1, static_cast<int>(std::min<std::int64_t>(rows, room / band_columns)));
    if (const int of_block = static_cast<int>(double(block_rows) * rows / window.rows);
        of_block > 1 && band_rows >= of_block)
        band_rows -= band_rows % of_block;
    for (int first_row = 0; first_row < rows; first_row += band_rows)
        for (int first_column = 0; first_column < columns; first_column += band_columns) {
            const int width = std::min(band_columns, columns - first_column);
            const int height = std::min(band_rows, rows - first_row);
            Sums sums{first_column, first_row, Array2d<double>(width, height),
                      Array2d<double>(width, height)};
            for (const Piece& piece : pieces)
                add_means(piece, window, columns, rows, sums, progress ? &*progress : nullptr);
            for (int row = 0; row < height; ++row)
                for (int column = 0; column < width; ++column)
                    if (sums.area.at(column, row) >= 0.5 * area)
                        result.at(first_column + column, first_row + row) = static_cast<float>(
                            sums.height.at(column, row) / sums.area.at(column, row));
        }
    return result;
}

Source::Source(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Source::Source(Source&&) noexcept = default;
Source& Source::operator=(Source&&) noexcept = default;
Source::~Source() = default;

Source Source::open(const std::string& path, const LoadOptions& options) {
    return open(std::span(&path, 1), options);
}

Source Source::open(std::span<const std::string> given, const LoadOptions& options) {
    if (given.empty()) bad_input("no DEM given; name one or more files");
    std::vector<std::string> paths;
    std::vector<std::string> folders;  // that they are from, empty for what was named itself
    for (const std::string& name : given)
        for (std::string& path : rasters_of(name)) {
            folders.push_back(path == name ? "" : name);
            paths.push_back(std::move(path));
        }
    if (options.bounds && paths.size() > 1)
        bad_usage(
            fmt::format("--bounds: it says where one file is, but there are {}", paths.size()));
    allow_blocks(options.memory.block_bytes);
    auto impl = std::make_unique<Impl>();
    impl->work_bytes = options.memory.work_bytes;
    std::vector<Dataset> opened(std::min(paths.size(), kMaxIdle));
    for (std::size_t i = 0; i < paths.size(); ++i) {
        Dataset dataset;
        try {
            impl->pieces.push_back(open_piece(paths[i], options, paths.size(), dataset));
        } catch (const Error& error) {
            if (folders[i].empty()) throw;
            throw Error(error.code(), fmt::format("{}; it is one of {} in {}, name the right ones",
                                                  error.what(), paths.size(), folders[i]));
        }
        if (i < kMaxIdle) opened[i] = std::move(dataset);
    }
    impl->grid = join(impl->pieces, impl->about);
    if (!options.crop.empty()) impl->crop(crop_of(*impl->grid, options.crop));
    settle_earth(*impl->grid, impl->about, impl->leaves_earth);
    for (std::size_t i = 0; i < opened.size(); ++i)
        if (!impl->pieces[i].resampling)
            impl->idle.push_back({&impl->pieces[i], std::move(opened[i])});
    for (const Piece& piece : impl->pieces) {
        impl->threads_pay = impl->threads_pay || piece.threads_pay;
        impl->tallest_block = std::max(impl->tallest_block, piece.block_rows);
    }
    if (impl->pieces.size() == 1) impl->block_rows = impl->pieces.front().block_rows;
    // Of several files, what holds for one alone begins with its name.
    for (const std::string& sentence : impl->about.guesses)
        log::info(paths.size() == 1 ? fmt::format("{}: {}", paths.front(), sentence) : sentence);
    for (const std::string& sentence : impl->about.warnings)
        log::warning(sentence);
    return Source(std::move(impl));
}

const Grid& Source::grid() const {
    return *impl_->grid;
}

const Description& Source::description() const {
    return impl_->about;
}

Array2d<float> Source::read(const Window& window, int columns, int rows) const {
    assert(window.column >= 0 && window.row >= 0 &&
           window.column + window.columns <= grid().columns() &&
           window.row + window.rows <= grid().rows());
    assert(columns > 0 && rows > 0 && columns <= window.columns && rows <= window.rows);
    Array2d<float> height_m = columns == window.columns && rows == window.rows
                                  ? impl_->read_stored(window)
                                  : impl_->read_means(window, columns, rows);
    if (impl_->leaves_earth) cut_to_earth(grid().part(window, columns, rows), height_m);
    return height_m;
}

Source::Blank Source::Impl::blank(const Window& window) const {
    Blank blank{window.rows, kHole};
    if (leaves_earth) return {0, kHole};
    for (const Piece& piece : pieces) {
        const Window part = overlap(window, piece.place);
        if (is_empty(part)) continue;
        int rows = part.row - window.row;
        if (rows == 0 && piece.sparse) {
            rows = piece.sparse->empty_rows({part.column - piece.place.column,
                                             part.row - piece.place.row, part.columns, part.rows});
            // Of several, what lies on top would have to be found out.
            if (pieces.size() == 1)
                blank.height_m = piece.unstored_m;
            else if (!std::isnan(piece.unstored_m))
                rows = 0;
            // Below the piece only others can have heights.
            if (rows == part.rows) continue;
        }
        blank.rows = std::min(blank.rows, rows);
    }
    return blank;
}

Source::Blank Source::blank(const Window& window) const {
    return impl_->blank(window);
}

int Source::block_rows() const {
    return impl_->tallest_block;
}

glm::ivec2 Source::block_size() const {
    if (impl_->pieces.size() > 1) return {256, 256};
    const Piece& piece = impl_->pieces.front();
    return {piece.block_columns, piece.block_rows};
}

double Source::stored(int column, int row) const {
    for (auto piece = impl_->pieces.rbegin(); piece != impl_->pieces.rend(); ++piece) {
        const Window own = overlap({column, row, 1, 1}, piece->place);
        if (is_empty(own)) continue;
        double number = 0;
        float height_m = kHole;
        impl_->borrow(*piece, [&](void* dataset) {
            const int x = column - piece->place.column, y = row - piece->place.row;
            piece->read(dataset, piece->levels.front(), {x, y, 1, 1}, &height_m);
            number = piece->stored(dataset, x, y);
        });
        if (!std::isnan(height_m)) return number;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

Array2d<float> Source::read() const {
    return read({0, 0, grid().columns(), grid().rows()}, grid().columns(), grid().rows());
}

double Source::cells_for_means(int side) const {
    double cells = 0;
    for (const Piece& piece : impl_->pieces) {
        const Resolution& level = coarsest_level(piece, side, side);
        cells += double{1} * level.columns * level.rows;
    }
    return cells;
}

double Source::height_at(const geo::Geodetic& place) const {
    const glm::dvec2 post = grid().post(place);
    if (!(post.x >= 0 && post.y >= 0 && post.x <= grid().columns() - 1 &&
          post.y <= grid().rows() - 1))
        return std::numeric_limits<double>::quiet_NaN();
    const Window four{std::min(static_cast<int>(post.x), grid().columns() - 2),
                      std::min(static_cast<int>(post.y), grid().rows() - 2), 2, 2};
    const Heightfield field{read(four, 2, 2), grid().part(four, 2, 2), description()};
    return field.height_at(post.x - four.column, post.y - four.row);
}

}  // namespace relevo::dem
