#include "dem/posts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "dem/content_sum.h"
#include "dem/load.h"
#include "dem/survey.h"
#include "dem/tile_cache.h"
#include "dem/unearthly.h"

namespace relevo::dem {
namespace {

constexpr float kInfinite_m = std::numeric_limits<float>::infinity();
constexpr int kLeastBlock = 32;             // cells a side
constexpr std::int64_t kMaxSlab = 1 << 22;  // posts that are read at once to go through a file
constexpr int kSlab_rows = 512;             // those of the tallest usual blocks of files

/// Blocks in a line of posts. Cells of a block share their last post with the next one.
int blocks_of(int posts, int block) {
    return std::max(1, (posts - 2) / block + 1);
}

/// The highest post of a block, infinity where it has a hole.
float highest_of(const Posts::View& view, const Window& posts) {
    float highest_m = -kInfinite_m;
    int holes = 0;
    for (int row = posts.row; row < posts.row + posts.rows; ++row) {
        const float* heights = view.at(posts.column, row);
        for (int i = 0; i < posts.columns; ++i) {
            const float h = heights[i];
            highest_m = std::max(highest_m, h);  // a hole, NaN, changes nothing
            holes += h != h;
        }
    }
    return holes > 0 ? kInfinite_m : highest_m;
}

}  // namespace

struct Posts::Impl {
    /// Posts of a grid round the Earth, column 0 being `first` of theirs.
    struct Unrolled {
        const Posts& posts;
        int first, round;
        Grid grid;

        int column(int of) const { return ((of + first) % round + round) % round; }
        /// Calls `body(from, count, at)` for columns that lie next to each other in both: `from` on
        /// of the others, `at` on of these.
        template <typename Body>
        void each_piece(int begin, int end, const Body& body) const {
            for (int at = begin; at < end;) {
                const int from = column(at), count = std::min(end - at, round - from);
                body(from, count, at);
                at += count;
            }
        }
        View view(const Window& window, std::vector<float>& buffer) const;
    };
    std::optional<Unrolled> unrolled;  // instead of all that follows

    std::optional<Source> own_source;
    std::optional<Heightfield> own_field;
    const Heightfield* field = nullptr;  // of posts in memory
    const Source* source = nullptr;      // else
    Description about;
    int block = kLeastBlock;
    Array2d<float> block_highest_m;
    std::unique_ptr<TileCache> tiles;
    Array2d<float> thinned_m;   // of posts that are not in memory
    Spikes spikes;              // of such posts, where they matter
    std::uint64_t content = 0;  // of such posts
    std::once_flag outside_once;
    Array2d<std::uint8_t> outside;  // of thinned posts, made where it is asked for; empty: none is

    const Grid& grid() const {
        return unrolled ? unrolled->grid : field ? field->grid : source->grid();
    }
    int thinning() const {
        return (std::max(grid().columns(), grid().rows()) + kThinned - 1) / kThinned;
    }
    int thinned(int posts) const { return (posts - 1) / thinning() + 1; }
    float thinned_at(int column, int row) const {
        const int step = thinning();
        return field ? field->height_m.at(column * step, row * step) : thinned_m.at(column, row);
    }
    void find_outside();
    View view(const Window& window, std::vector<float>& buffer) const;
    void take(const Heightfield& in_memory);
    void take(const Source& on_demand, std::int64_t max_posts);
    void take(const Source& on_demand, std::int64_t max_posts, const PostsFacts& facts);

  private:
    template <typename Body>
    void for_blocks(const Window& slab, const Body& body);
    void find_highest(const View& view, const Window& slab);
    std::optional<Collar> go_through(std::int64_t slab_posts);
    template <typename HeightAt>
    void keep_thinned(const Window& slab, const HeightAt& height_at);
    void settle_holes();
};

/// Calls `body(highest_m, part)` for each block that has a part in a slab of posts, both ends of
/// whose cells are in it.
template <typename Body>
void Posts::Impl::for_blocks(const Window& slab, const Body& body) {
    const auto part = [&](int index, int first, int count) {  // of a block in a line of the slab
        const std::int64_t begin = std::max<std::int64_t>(first, std::int64_t{index} * block);
        const std::int64_t end =
            std::min(std::int64_t{first} + count - 1, (std::int64_t{index} + 1) * block);
        return std::pair(static_cast<int>(begin), static_cast<int>(end - begin + 1));
    };
    const int first_column = slab.column / block, first_row = slab.row / block;
    const int columns = blocks_of(slab.column % block + slab.columns, block);
    const int rows = blocks_of(slab.row % block + slab.rows, block);
    const auto grain = static_cast<int>(std::max<std::int64_t>(
        1, (1 << 18) / (std::int64_t{std::min(block, slab.rows)} * slab.columns)));
    parallel_for(first_row, first_row + rows, grain, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = first_column; column < first_column + columns; ++column) {
                const auto [x, width] = part(column, slab.column, slab.columns);
                const auto [y, height] = part(row, slab.row, slab.rows);
                body(block_highest_m.at(column, row), Window{x, y, width, height});
            }
    });
}

void Posts::Impl::find_highest(const View& view, const Window& slab) {
    for_blocks(slab, [&](float& highest_m, const Window& part) {
        highest_m = std::max(highest_m, highest_of(view, part));
    });
}

/// Of a slab of posts, whose heights `height_at` tells.
template <typename HeightAt>
void Posts::Impl::keep_thinned(const Window& slab, const HeightAt& height_at) {
    const int step = thinning();
    const auto first = [&](int from) { return (from + step - 1) / step; };
    const int end_row = first(slab.row + slab.rows), end = first(slab.column + slab.columns);
    for (int row = first(slab.row); row < end_row; ++row)
        for (int column = first(slab.column); column < end; ++column)
            thinned_m.at(column, row) = height_at(column * step, row * step);
}

void Posts::Impl::settle_holes() {
    for (float& highest_m : block_highest_m)
        if (highest_m == kInfinite_m) highest_m = about.statistics.max_m;
}

void Posts::Impl::take(const Heightfield& in_memory) {
    assert(in_memory.reduction == 1);
    field = &in_memory;
    about = in_memory.about;
    const Array2d<float>& height_m = in_memory.height_m;
    if (about.statistics.valid == 0) about.statistics = statistics(height_m);
    const int columns = blocks_of(height_m.width(), block),
              rows = blocks_of(height_m.height(), block);
    block_highest_m = Array2d<float>(columns, rows, -kInfinite_m);
    find_highest({height_m.data(), height_m.width(), 0, 0},
                 {0, 0, height_m.width(), height_m.height()});
    settle_holes();
}

void Posts::Impl::take(const Source& on_demand, std::int64_t max_posts) {
    refuse_endless_sides(on_demand);
    source = &on_demand;
    about = on_demand.description();
    const auto blocks = [&] {
        return std::int64_t{blocks_of(grid().columns(), block)} * blocks_of(grid().rows(), block);
    };
    while (blocks() > max_posts / 4)
        block *= 2;
    std::optional<Collar> collar;
    // Once more where a tile has broken on the way, of which a part was read.
    std::int64_t before = 0;
    do {
        before = source->broken_while_read();
        about.statistics = {};
        spikes = {};
        content = 0;
        block_highest_m = Array2d<float>(blocks_of(grid().columns(), block),
                                         blocks_of(grid().rows(), block), -kInfinite_m);
        thinned_m = Array2d<float>(thinned(grid().columns()), thinned(grid().rows()),
                                   std::numeric_limits<float>::quiet_NaN());
        collar = go_through(std::min(max_posts / 2, kMaxSlab));
    } while (source->broken_while_read() != before);
    report_heights(*source, about, collar);
    settle_holes();
    tiles = std::make_unique<TileCache>(on_demand, max_posts - blocks());
}

/// Without reading any post.
void Posts::Impl::take(const Source& on_demand, std::int64_t max_posts, const PostsFacts& facts) {
    refuse_endless_sides(on_demand);
    source = &on_demand;
    about = on_demand.description();
    about.statistics = facts.statistics;
    about.tiles = facts.tiles;
    on_demand.allow_voids(facts.tiles.missing.count + facts.tiles.broken.count);
    content = facts.content;
    thinned_m = facts.thinned_m;
    if (thinned_m.width() != thinned(grid().columns()) ||
        thinned_m.height() != thinned(grid().rows()) || about.statistics.valid == 0)
        bad_input(about.path + ": what is known of its posts is of another DEM");
    // One block, as high as the highest post.
    while (block < std::max(grid().columns(), grid().rows()))
        block *= 2;
    block_highest_m = Array2d<float>(1, 1, about.statistics.max_m);
    tiles = std::make_unique<TileCache>(on_demand, max_posts);
}

/// @param slab_posts  that memory has room for
std::optional<Collar> Posts::Impl::go_through(std::int64_t slab_posts) {
    const int columns = grid().columns(), rows = grid().rows();
    // Whole blocks or, where one is more than there is room for, parts of them.
    int side = std::min(block, kSlab_rows);
    while (side > kLeastBlock && std::int64_t{side} * side > slab_posts)
        side /= 2;
    const auto fitting = [&](std::int64_t posts) {
        return std::max(side, static_cast<int>(posts / side) * side);
    };
    const int slab_rows = fitting(std::min<std::int64_t>(kSlab_rows, slab_posts / side));
    const int slab_columns = fitting(slab_posts / slab_rows);
    std::optional<CollarSteps> collar_steps = collar_steps_of(*source);
    const bool look_for_spikes = spikes_matter(about, grid());
    Progress progress(about.path + ": reading all posts", double(columns) * rows);
    for (int row = 0; row < rows - 1;) {
        // Slabs share their last row and column with the next ones. What no file stores is one.
        int count = std::min(slab_rows, rows - 1 - row), width = slab_columns;
        if (const int blank = source->blank({0, row, columns, rows - row}).rows;
            blank == rows - row || blank > slab_rows) {
            count = blank == rows - row ? blank - 1 : (blank - 1) / slab_rows * slab_rows;
            width = columns - 1;
        }
        for (int column = 0; column < columns - 1;) {
            const Window slab{column, row, std::min(width, columns - 1 - column) + 1, count + 1};
            // Counted are those that are not the first of a slab that follows.
            const bool ends_right = slab.column + slab.columns == columns;
            const bool ends_below = slab.row + slab.rows == rows;
            const int own_columns = slab.columns - (ends_right ? 0 : 1);
            const int own_rows = slab.rows - (ends_below ? 0 : 1);
            if (const Source::Blank blank = source->blank(slab); blank.rows == slab.rows) {
                const float height_m = std::isnan(blank.height_m) ? kInfinite_m : blank.height_m;
                for_blocks(slab, [&](float& highest_m, const Window&) {
                    highest_m = std::max(highest_m, height_m);
                });
                keep_thinned(slab, [&](int, int) { return blank.height_m; });
                about.statistics +=
                    statistics(blank.height_m, std::int64_t{own_columns} * own_rows);
                content += content_of(blank.height_m, {column, row, own_columns, own_rows});
            } else {
                const Array2d<float> height_m = source->read(slab, slab.columns, slab.rows);
                const View read{height_m.data(), height_m.width(), slab.column, slab.row};
                find_highest(read, slab);
                keep_thinned(slab, [&](int c, int r) { return *read.at(c, r); });
                if (collar_steps) collar_steps->add(height_m, {0, 0, slab.columns, slab.rows});
                about.statistics += statistics(height_m, {0, 0, own_columns, own_rows});
                content += content_of(read, {column, row, own_columns, own_rows});
                // Those at the seams of slabs are too few to matter.
                if (look_for_spikes)
                    spikes += find_spikes(height_m, grid().post_spacing_m(),
                                          {1, 1, slab.columns - 2, slab.rows - 2});
            }
            progress.add(double(own_columns) * own_rows);
            column += slab.columns - 1;
        }
        row += count;
    }
    return collar_steps ? collar_steps->collar() : std::nullopt;
}

Posts::View Posts::Impl::Unrolled::view(const Window& window, std::vector<float>& buffer) const {
    const int from = column(window.column);
    if (from + window.columns <= round) {
        View view = posts.view({from, window.row, window.columns, window.rows}, buffer);
        view.column += window.column - from;
        return view;
    }
    buffer.resize(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows));
    std::vector<float> part;
    each_piece(window.column, window.end_column(), [&](int first_column, int count, int at) {
        const View view = posts.view({first_column, window.row, count, window.rows}, part);
        for (int row = 0; row < window.rows; ++row)
            std::copy_n(view.at(first_column, window.row + row), count,
                        buffer.data() + std::ptrdiff_t{row} * window.columns + at - window.column);
    });
    return {buffer.data(), window.columns, window.column, window.row};
}

Posts::View Posts::Impl::view(const Window& window, std::vector<float>& buffer) const {
    if (unrolled) return unrolled->view(window, buffer);
    if (field) return {field->height_m.data(), field->height_m.width(), 0, 0};
    buffer.resize(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows));
    tiles->copy(window, buffer.data());
    return {buffer.data(), window.columns, window.column, window.row};
}

Posts::Posts(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Posts::Posts(Posts&&) noexcept = default;
Posts& Posts::operator=(Posts&&) noexcept = default;
Posts::~Posts() = default;

Posts::Posts(const Heightfield& field) : impl_(std::make_unique<Impl>()) {
    impl_->take(field);
}

Posts::Posts(const Source& source, std::int64_t max_posts) : impl_(std::make_unique<Impl>()) {
    impl_->take(source, max_posts);
}

Posts Posts::load(std::span<const std::string> paths, const LoadOptions& options,
                  const PostsFacts* facts) {
    auto impl = std::make_unique<Impl>();
    impl->own_source.emplace(Source::open(paths, options));
    const Grid& grid = impl->own_source->grid();
    const bool beyond_memory =
        std::int64_t{grid.columns()} * grid.rows() > options.memory.whole_posts;
    if (beyond_memory && facts) {
        impl->take(*impl->own_source, options.memory.posts, *facts);
    } else if (beyond_memory) {
        impl->take(*impl->own_source, options.memory.posts);
        check_heights(impl->about, impl->spikes, options);
    } else {
        impl->own_field.emplace(dem::load(*impl->own_source, options.memory));
        check_heights(*impl->own_field, options);
        impl->own_source.reset();
        impl->take(*impl->own_field);
    }
    return Posts(std::move(impl));
}

PostsFacts Posts::facts() const {
    const Impl& impl = *impl_;
    assert(!impl.unrolled);
    PostsFacts facts{impl.about.statistics,
                     Array2d<float>(impl.thinned(grid().columns()), impl.thinned(grid().rows())),
                     content(), impl.about.tiles};
    for (int row = 0; row < facts.thinned_m.height(); ++row)
        for (int column = 0; column < facts.thinned_m.width(); ++column)
            facts.thinned_m.at(column, row) = impl.thinned_at(column, row);
    return facts;
}

std::uint64_t Posts::content() const {
    const Impl& impl = *impl_;
    assert(!impl.unrolled);
    if (!impl.field) return impl.content;
    const Array2d<float>& all = impl.field->height_m;
    return content_of({all.data(), all.width(), 0, 0}, {0, 0, all.width(), all.height()});
}

Posts Posts::unrolled(const Posts& posts, int first, int columns) {
    const Grid& grid = posts.grid();
    Affine affine = grid.affine();
    affine.x0 += first * affine.x_column;
    auto impl = std::make_unique<Impl>();
    impl->unrolled.emplace(Impl::Unrolled{posts, first, grid.columns_per_turn().value(),
                                          Grid(columns, grid.rows(), affine, grid.crs())});
    return Posts(std::move(impl));
}

std::optional<Posts> Posts::around(const Posts& posts, const geo::Geodetic& place) {
    const std::optional<int> turn = posts.grid().columns_per_turn();
    const double column = posts.grid().post(place).x;
    if (!turn || !std::isfinite(column)) return std::nullopt;
    return unrolled(posts, static_cast<int>(std::lround(column)) - *turn / 2, *turn + 1);
}

const Grid& Posts::grid() const {
    return impl_->grid();
}

const Description& Posts::about() const {
    if (impl_->unrolled) return impl_->unrolled->posts.about();
    return impl_->about;
}

bool Posts::in_memory() const {
    return impl_->field != nullptr;
}

float Posts::bound_m(int first_column, int last_column, int first_row, int last_row) const {
    if (impl_->unrolled) {
        // The cell across the first column has its corners in the cells on either side.
        float bound_m = -kInfinite_m;
        impl_->unrolled->each_piece(first_column, last_column + 2, [&](int from, int count, int) {
            bound_m = std::max(bound_m, impl_->unrolled->posts.bound_m(from, from + count - 1,
                                                                       first_row, last_row));
        });
        return bound_m;
    }
    const Array2d<float>& highest_m = impl_->block_highest_m;
    const auto block = [size = impl_->block](int cell, int blocks) {
        return std::clamp(cell / size, 0, blocks - 1);
    };
    const int width = highest_m.width(), height = highest_m.height();
    float bound_m = -kInfinite_m;
    for (int row = block(first_row, height); row <= block(last_row, height); ++row)
        for (int column = block(first_column, width); column <= block(last_column, width); ++column)
            bound_m = std::max(bound_m, highest_m.at(column, row));
    return bound_m;
}

Posts::View Posts::view(const Window& window, std::vector<float>& buffer) const {
    assert(window.column >= 0 && window.row >= 0 && window.columns > 0 && window.rows > 0 &&
           window.column + window.columns <= grid().columns() &&
           window.row + window.rows <= grid().rows());
    return impl_->view(window, buffer);
}

int Posts::thinning() const {
    if (impl_->unrolled) return impl_->unrolled->posts.thinning();
    return impl_->thinning();
}

float Posts::thinned_m(int column, int row) const {
    if (const auto& unrolled = impl_->unrolled)
        return unrolled->posts.thinned_m(unrolled->column(column), row);
    const int step = thinning();
    const auto nearest = [&](int post, int posts) {
        return std::min((post + step / 2) / step, (posts - 1) / step);
    };
    return impl_->thinned_at(nearest(column, grid().columns()), nearest(row, grid().rows()));
}

/// Spreads from the voids at the edges of the thinned grid.
void Posts::Impl::find_outside() {
    const int columns = thinned(grid().columns()), rows = thinned(grid().rows());
    const bool is_round = grid().columns_per_turn().has_value();
    std::vector<std::pair<int, int>> open;
    const auto take = [&](int column, int row) {
        if (is_round) column = (column + columns) % columns;
        if (column < 0 || row < 0 || column >= columns || row >= rows ||
            !std::isnan(thinned_at(column, row)))
            return;
        if (outside.empty()) outside = Array2d<std::uint8_t>(columns, rows, 0);
        if (std::exchange(outside.at(column, row), 1) == 0) open.emplace_back(column, row);
    };
    for (int column = 0; column < columns; ++column)
        take(column, 0), take(column, rows - 1);
    for (int row = 0; row < rows && !is_round; ++row)
        take(0, row), take(columns - 1, row);
    while (!open.empty()) {
        const auto [column, row] = open.back();
        open.pop_back();
        for (int down = -1; down <= 1; ++down)
            for (int on = -1; on <= 1; ++on)
                take(column + on, row + down);
    }
}

bool Posts::is_outside(int column, int row) const {
    Impl& impl = *impl_;
    if (const auto& unrolled = impl.unrolled)
        return unrolled->posts.is_outside(unrolled->column(column), row);
    std::call_once(impl.outside_once, [&] { impl.find_outside(); });
    const int step = impl.thinning();
    // Slivers along the edge may lie between thinned posts, as the rims of voids do.
    const int to_side = std::min(column, grid().columns() - 1 - column),
              to_end = std::min(row, grid().rows() - 1 - row);
    if (step > 1 && (grid().columns_per_turn() ? to_end : std::min(to_side, to_end)) < step)
        return true;
    if (impl.outside.empty()) return false;
    const int beside = step > 1 ? 1 : 0;
    const int c = column / step, r = row / step;
    const int columns = impl.outside.width(), rows = impl.outside.height();
    for (int y = r; y <= std::min(r + beside, rows - 1); ++y)
        for (int x = c; x <= c + beside; ++x) {
            if (x >= columns && !grid().columns_per_turn()) continue;
            if (impl.outside.at(x % columns, y) != 0) return true;
        }
    return false;
}

double Posts::height_at(double column, double row) const {
    if (!(column >= 0 && row >= 0 && column <= grid().columns() - 1 && row <= grid().rows() - 1))
        return std::numeric_limits<double>::quiet_NaN();
    const int c = std::min(static_cast<int>(column), grid().columns() - 2);
    const int r = std::min(static_cast<int>(row), grid().rows() - 2);
    std::vector<float> buffer;
    const View four = view({c, r, 2, 2}, buffer);
    return bilinear_m(four.at(c, r), four.stride, column - c, row - r);
}

}  // namespace relevo::dem
