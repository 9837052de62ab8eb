#include "dem/posts.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <mutex>
#include <optional>

#include "base/parallel_for.h"
#include "dem/frame.h"
#include "dem/load.h"
#include "dem/tile_cache.h"

namespace relevo::dem {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kLeastBlock = 32;              // cells a side
constexpr std::int64_t kMostSlab = 1 << 22;  // posts that are read at once to go through a file
constexpr int kSlab_rows = 512;              // those of the tallest usual blocks of files

/// Blocks in a line of posts. Cells of a block share their last post with the next one.
int blocks_of(int posts, int block) {
    return std::max(1, (posts - 1 + block - 1) / block);
}

/// The highest post of a block, infinity where it has a hole.
float highest_of(const Posts::View& view, const Window& posts) {
    float highest_m = -kInfinity;
    int holes = 0;
    for (int row = posts.row; row < posts.row + posts.rows; ++row) {
        const float* heights = view.at(posts.column, row);
        for (int i = 0; i < posts.columns; ++i) {
            const float h = heights[i];
            highest_m = std::max(highest_m, h);  // a hole, NaN, changes nothing
            holes += h != h;
        }
    }
    return holes > 0 ? kInfinity : highest_m;
}

void add(Statistics& total, const Statistics& part) {
    if (part.valid > 0) {
        total.min_m = total.valid > 0 ? std::min(total.min_m, part.min_m) : part.min_m;
        total.max_m = total.valid > 0 ? std::max(total.max_m, part.max_m) : part.max_m;
    }
    total.valid += part.valid;
    total.holes += part.holes;
    total.outliers += part.outliers;
}

/// What looks for a frame inside of a DEM, where its edge may be one.
std::optional<FrameSteps> frame_steps_of(const Source& source) {
    const int columns = source.grid().columns(), rows = source.grid().rows();
    FrameEdge edge(source.read({0, 0, 1, 1}, 1, 1).at(0, 0));
    for (const Window& line : {Window{0, 0, columns, 1}, Window{0, rows - 1, columns, 1},
                               Window{0, 0, 1, rows}, Window{columns - 1, 0, 1, rows}})
        edge.add(source.read(line, line.columns, line.rows));
    if (!edge.may_be_frame()) return std::nullopt;
    return FrameSteps(edge.height_m());
}

}  // namespace

struct Posts::Impl {
    std::optional<Source> own_source;
    std::optional<Heightfield> own_field;
    const Heightfield* field = nullptr;  // of posts in memory
    const Source* source = nullptr;      // else
    Description about;
    int block = kLeastBlock;
    Array2d<float> block_highest_m;
    std::unique_ptr<TileCache> tiles;

    const Grid& grid() const { return field ? field->grid : source->grid(); }
    View view(const Window& window, std::vector<float>& buffer) const;
    void take(const Heightfield& in_memory);
    void take(const Source& on_demand, std::int64_t max_posts);

  private:
    Window posts_of_block(int column, int row) const;
    void find_highest(const View& view, const Window& blocks);
    void go_through(std::int64_t slab_posts);
    void settle_holes();
};

/// Both ends of the cells included.
Window Posts::Impl::posts_of_block(int column, int row) const {
    const int first_column = column * block, first_row = row * block;
    return {first_column, first_row, std::min(block, grid().columns() - 1 - first_column) + 1,
            std::min(block, grid().rows() - 1 - first_row) + 1};
}

void Posts::Impl::find_highest(const View& view, const Window& blocks) {
    const int grain = std::max(1, (1 << 18) / (block * block * blocks.columns));
    parallel_for(blocks.row, blocks.row + blocks.rows, grain, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = blocks.column; column < blocks.column + blocks.columns; ++column)
                block_highest_m.at(column, row) = highest_of(view, posts_of_block(column, row));
    });
}

void Posts::Impl::settle_holes() {
    for (float& highest_m : block_highest_m)
        if (highest_m == kInfinity) highest_m = about.statistics.max_m;
}

void Posts::Impl::take(const Heightfield& in_memory) {
    assert(in_memory.reduction == 1);
    field = &in_memory;
    about = in_memory.about;
    const Array2d<float>& height_m = in_memory.height_m;
    if (about.statistics.valid == 0) about.statistics = statistics(height_m);
    const int columns = blocks_of(height_m.width(), block),
              rows = blocks_of(height_m.height(), block);
    block_highest_m = Array2d<float>(columns, rows);
    find_highest({height_m.data(), height_m.width(), 0, 0}, {0, 0, columns, rows});
    settle_holes();
}

void Posts::Impl::take(const Source& on_demand, std::int64_t max_posts) {
    source = &on_demand;
    about = on_demand.description();
    const auto blocks = [&] {
        return std::int64_t{blocks_of(grid().columns(), block)} * blocks_of(grid().rows(), block);
    };
    while (blocks() > max_posts / 4)
        block *= 2;
    block_highest_m =
        Array2d<float>(blocks_of(grid().columns(), block), blocks_of(grid().rows(), block));
    go_through(std::clamp(max_posts / 2, std::int64_t{block} * block, kMostSlab));
    settle_holes();
    tiles = std::make_unique<TileCache>(on_demand, max_posts - blocks());
}

/// @param slab_posts  that memory has room for
void Posts::Impl::go_through(std::int64_t slab_posts) {
    const int columns = grid().columns(), rows = grid().rows();
    const int slab_rows = std::max(1, kSlab_rows / block);  // of blocks
    const auto slab_columns = static_cast<int>(std::clamp<std::int64_t>(
        slab_posts / (std::int64_t{slab_rows} * block * block), 1, columns));
    std::optional<FrameSteps> frame_steps = frame_steps_of(*source);
    for (int row = 0; row < block_highest_m.height(); row += slab_rows)
        for (int column = 0; column < block_highest_m.width(); column += slab_columns) {
            const Window blocks{column, row,
                                std::min(slab_columns, block_highest_m.width() - column),
                                std::min(slab_rows, block_highest_m.height() - row)};
            const Window first = posts_of_block(blocks.column, blocks.row);
            const Window last =
                posts_of_block(blocks.column + blocks.columns - 1, blocks.row + blocks.rows - 1);
            const Window slab{first.column, first.row, last.column + last.columns - first.column,
                              last.row + last.rows - first.row};
            const Array2d<float> height_m = source->read(slab, slab.columns, slab.rows);
            const View view{height_m.data(), height_m.width(), slab.column, slab.row};
            find_highest(view, blocks);
            if (frame_steps) frame_steps->add(height_m);
            // The last column and row of a slab are the first of the next one, or the DEM's last.
            const bool ends_right = slab.column + slab.columns == columns;
            const bool ends_below = slab.row + slab.rows == rows;
            add(about.statistics, statistics(height_m, slab.columns - (ends_right ? 0 : 1),
                                             slab.rows - (ends_below ? 0 : 1)));
        }
    report_heights(about, frame_steps ? frame_steps->frame() : std::nullopt);
}

Posts::View Posts::Impl::view(const Window& window, std::vector<float>& buffer) const {
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

Posts Posts::load(std::span<const std::string> paths, const LoadOptions& options) {
    auto impl = std::make_unique<Impl>();
    impl->own_source.emplace(Source::open(paths, options));
    const Grid& grid = impl->own_source->grid();
    if (std::int64_t{grid.columns()} * grid.rows() > options.max_posts) {
        impl->take(*impl->own_source, options.max_posts);
    } else {
        impl->own_field.emplace(dem::load(*impl->own_source, options.max_posts));
        impl->own_source.reset();
        impl->take(*impl->own_field);
    }
    return Posts(std::move(impl));
}

const Grid& Posts::grid() const {
    return impl_->grid();
}

const Description& Posts::about() const {
    return impl_->about;
}

bool Posts::in_memory() const {
    return impl_->field != nullptr;
}

float Posts::bound_m(int first_column, int last_column, int first_row, int last_row) const {
    const Array2d<float>& highest_m = impl_->block_highest_m;
    const auto block = [size = impl_->block](int cell, int blocks) {
        return std::clamp(cell / size, 0, blocks - 1);
    };
    const int width = highest_m.width(), height = highest_m.height();
    float bound_m = -kInfinity;
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
