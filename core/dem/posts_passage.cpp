#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "dem/content_sum.h"
#include "dem/load.h"
#include "dem/posts_impl.h"
#include "dem/survey.h"
#include "dem/tile_cache.h"

namespace relevo::dem {
namespace {

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

// Goes through the posts of a DEM once.

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

/// Reads posts that memory has room for.
void Posts::Impl::open(Source source, const LoadOptions& options) {
    own_source.emplace(std::move(source));
    const std::int64_t posts =
        std::int64_t{own_source->grid().columns()} * own_source->grid().rows();
    if (posts > options.memory.whole_posts) return;
    own_field.emplace(dem::load(*own_source, options.memory));
    check_heights(*own_field, options);
}

/// Of what is open.
void Posts::Impl::take_own(const LoadOptions& options, const PostsFacts* facts) {
    if (own_field) {
        own_source.reset();
        take(*own_field);
    } else if (facts) {
        take(*own_source, options.memory.posts, *facts);
    } else {
        take(*own_source, options.memory.posts);
        check_heights(about, spikes, options);
    }
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

}  // namespace relevo::dem
