#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel_for.h"
#include "dem/source_impl.h"

namespace relevo::dem {
namespace {

/// A window of a piece, in its own posts.
Window own_window(const Piece& piece, const Window& part) {
    return {part.column - piece.place.column, part.row - piece.place.row, part.columns, part.rows};
}

/// Puts heights over those that are there; voids show what is below.
/// @param part  where they are on the DEM
/// @param window  what `height_m` is of
/// @returns by how much a height differs at most from that below it [m]
float put_over(const float* heights, const Window& part, const Window& window,
               Array2d<float>& height_m) {
    float most_m = 0;
    for (int row = 0; row < part.rows; ++row) {
        float* const to = &height_m.at(part.column - window.column, part.row + row - window.row);
        for (int column = 0; column < part.columns; ++column, ++heights) {
            const float off_m = std::abs(*heights - to[column]);
            most_m = off_m > most_m ? off_m : most_m;  // not of NaN
            to[column] = std::isnan(*heights) ? to[column] : *heights;
        }
    }
    return most_m;
}

/// Heights of a part of a piece. @param height_m  with room for them, row after row
void read_piece(const Rasters& rasters, const Piece& piece, void* dataset, const Window& part,
                float* height_m) {
    const Window own = own_window(piece, part);
    if (piece.sparse && piece.sparse->is_empty(own))
        std::fill_n(height_m, std::ptrdiff_t{part.columns} * part.rows, piece.unstored_m);
    else
        rasters.read_level(piece, dataset, piece.levels.front(), own, height_m);
}

}  // namespace

/// What a window has of a raster.
struct Source::Impl::RasterPart {
    int raster;
    Window window;  ///< of the DEM
    std::vector<float> height_m;
};

/// Opens the raster, leaves of the window what it has, and reads that.
void Source::Impl::read_part(RasterPart& part) const {
    const Piece* const piece = rasters->open(part.raster);
    part.window = piece ? common(part.window, piece->place) : Window{};
    if (part.window.is_empty()) return;
    part.height_m.resize(static_cast<std::size_t>(part.window.columns) *
                         static_cast<std::size_t>(part.window.rows));
    if (!rasters->read(part.raster, *piece, [&](void* dataset) {
            read_piece(*rasters, *piece, dataset, part.window, part.height_m.data());
        }))
        part.window = {};
}

/// Reads slices of whole rows of blocks, each large enough to be worth a thread.
void Source::Impl::read_large(const RasterPart& large, const Window& window,
                              Array2d<float>& height_m) const {
    constexpr int kPosts = 1 << 17;
    const Piece* const piece = rasters->open(large.raster);
    const Window part = piece ? common(large.window, piece->place) : Window{};
    if (part.is_empty()) return;
    const int wanted_rows = std::max(1, kPosts / part.columns);
    const int slice_rows =
        (wanted_rows + piece->block_rows - 1) / piece->block_rows * piece->block_rows;
    // A single file has all columns of the window and nothing below it.
    const bool in_place = rasters->is_one_file();
    const auto read_slice = [&](void* dataset, const Window& slice) {
        if (in_place) {
            read_piece(*rasters, *piece, dataset, slice, &height_m.at(0, slice.row - window.row));
            return;
        }
        std::vector<float> heights(static_cast<std::size_t>(slice.columns) *
                                   static_cast<std::size_t>(slice.rows));
        read_piece(*rasters, *piece, dataset, slice, heights.data());
        rasters->note_step(large.raster, put_over(heights.data(), slice, window, height_m));
    };
    const auto read_slices = [&](int first, int last) {
        rasters->read(large.raster, *piece, [&](void* dataset) {
            for (int i = first; i < last; ++i) {
                const Window slice{part.column, piece->place.row + i * slice_rows, part.columns,
                                   slice_rows};
                read_slice(dataset, common(slice, part));
            }
        });
    };
    const int first = (part.row - piece->place.row) / slice_rows;
    const int last = (part.end_row() - 1 - piece->place.row) / slice_rows + 1;
    if (piece->threads_pay)
        parallel_for(first, last, 1, read_slices);
    else
        read_slices(first, last);
}

Array2d<float> Source::Impl::read_stored(const Window& window) const {
    constexpr std::int64_t kSmall = 1 << 20, kAtOnce = 1 << 22;  // posts
    Array2d<float> height_m(window.columns, window.rows, kHole);
    std::vector<RasterPart> parts;  // small ones, read at once
    std::int64_t posts = 0;
    const auto read_parts = [&] {
        parallel_for(0, static_cast<int>(parts.size()), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i)
                read_part(parts[static_cast<std::size_t>(i)]);
        });
        // In their order: the later is on top.
        for (const RasterPart& part : parts)
            rasters->note_step(part.raster,
                               put_over(part.height_m.data(), part.window, window, height_m));
        parts.clear();
        posts = 0;
    };
    for (const int raster : rasters->within(window)) {
        RasterPart part{raster, common(window, rasters->reach(raster)), {}};
        const std::int64_t size = std::int64_t{part.window.columns} * part.window.rows;
        if (size > kSmall || rasters->is_one_file()) {
            read_parts();
            read_large(part, window, height_m);
            continue;
        }
        if (posts + size > kAtOnce) read_parts();
        parts.push_back(std::move(part));
        posts += size;
    }
    read_parts();
    return height_m;
}

}  // namespace relevo::dem
