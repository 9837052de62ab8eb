#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "dem/content_sum.h"
#include "dem/load.h"
#include "dem/posts_impl.h"
#include "dem/surroundings.h"
#include "dem/tile_cache.h"

namespace relevo::dem {
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

Posts::Posts(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

Posts Posts::in(std::shared_ptr<const Posts> surroundings, int rim) const {
    Posts nested(impl_);
    nested.surroundings_ = std::move(surroundings);
    nested.rim_ = rim;
    return nested;
}

Posts::Posts(Posts&&) noexcept = default;
Posts& Posts::operator=(Posts&&) noexcept = default;
Posts::~Posts() = default;

Posts::Posts(const Heightfield& field) : impl_(std::make_shared<Impl>()) {
    impl_->take(field);
}

Posts::Posts(const Source& source, std::int64_t max_posts) : impl_(std::make_shared<Impl>()) {
    impl_->take(source, max_posts);
}

Posts Posts::load(std::span<const std::string> paths, const LoadOptions& given,
                  const PostsFacts* facts) {
    LoadOptions options = given;
    if (!given.surroundings.empty()) {
        options.memory.posts /= 2;
        options.memory.whole_posts /= 2;
    }
    auto impl = std::make_shared<Impl>();
    impl->open(Source::open(paths, options), options);
    std::shared_ptr<const Posts> around;
    if (!given.surroundings.empty())
        around = load_surroundings(*impl->own_source, impl->own_field ? &*impl->own_field : nullptr,
                                   options);
    impl->take_own(options, facts);
    const int rim = around ? rim_of(impl->grid(), around->grid(), options.memory) : 0;
    return Posts(std::move(impl)).in(std::move(around), rim);
}

Posts Posts::load(Source source, const LoadOptions& options) {
    auto impl = std::make_shared<Impl>();
    impl->open(std::move(source), options);
    impl->take_own(options, nullptr);
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
    auto impl = std::make_shared<Impl>();
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
