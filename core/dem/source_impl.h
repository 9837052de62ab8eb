#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "dem/cell_parts.h"
#include "dem/rasters.h"
#include "dem/source.h"

// What Source is made of. Inside of the layer only.

namespace relevo::dem {

/// The coarsest level that still has a cell for every `columns_each` by `rows_each` posts.
const Resolution& coarsest_level(const Piece& piece, double columns_each, double rows_each);

struct Source::Impl {
    explicit Impl(std::span<const std::string> paths) : files(paths) {}

    OpenedFiles files;  // first: made before they are opened
    std::optional<Rasters> rasters;
    std::optional<Grid> grid;
    Description about;
    std::int64_t work_bytes = 0;   // MemoryBudget::work_bytes
    std::int64_t block_bytes = 0;  // MemoryBudget::block_bytes
    float shift_m = 0;             // of all heights, by raise()
    bool leaves_earth = false;     // some posts have no place

    /// Leaves the posts of a window. Rasters keep theirs, of which some are then outside.
    void crop(const Window& window);
    Blank blank(const Window& window) const;

    // source_read.cpp
    Array2d<float> read_stored(const Window& window) const;
    struct RasterPart;
    void read_part(RasterPart& part) const;
    void read_large(const RasterPart& part, const Window& window, Array2d<float>& height_m) const;

    // source_means.cpp
    Array2d<float> read_means(const Window& window, int columns, int rows) const;
    struct Means;
    struct Span;
    struct Sums;
    static Span parts_over(int first, int end, double each, const Span& all);
    static Parts parts_of_line(double begin, double each, const Span& parts, double per, int first,
                               int count);
    std::int64_t room_for_sums() const;
    void add_band(const Means& means, Sums& sums) const;
    void add_means(int number, const Means& means, const Span& columns, const Span& rows,
                   Sums& sums) const;
};

}  // namespace relevo::dem
