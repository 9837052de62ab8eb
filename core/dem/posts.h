#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dem/grid.h"
#include "dem/heightfield.h"
#include "dem/source.h"

namespace relevo::dem {

/// What is known of a DEM once all of its posts have been read.
struct PostsFacts {
    Statistics statistics;
    Array2d<float> thinned_m;   ///< Posts::thinned_m(), every Posts::thinning()-th post each way
    std::uint64_t content = 0;  ///< Posts::content()
    TileReport tiles;
};

/// Every post of a DEM, whether memory holds them all or not, for figures that means would falsify.
///
/// The DEM is gone through once. From then on the lowest and the highest post are known, and the
/// highest of each block of posts, so that whoever looks for high ground skips blocks that cannot
/// matter. Of a DEM beyond the memory allowed, posts are read from the file where they are asked
/// for, in tiles of which those used last are kept. What is found is the same either way.
///
/// Safe on several threads at once.
class Posts {
  public:
    /// Posts in memory.
    /// @param field  all posts, not means of them; it must outlive this
    explicit Posts(const Heightfield& field);

    /// Posts on demand.
    /// @param source     must outlive this
    /// @param max_posts  that are kept: a quarter at most for the highest of blocks, the rest tiles
    /// @throws Error (BadInput) where the file is damaged, here and later, and where not one post
    ///     has a height
    Posts(const Source& source, std::int64_t max_posts);

    /// Opens files and holds their posts in memory where LoadOptions::memory allows that. With
    /// LoadOptions::surroundings these are read too, with half of the memory; posts in memory that
    /// have no height get theirs.
    /// @throws Error (BadInput) as dem::load, and for heights that no ground of the Earth has
    /// @param facts  of the same DEM: one beyond memory is then opened and not read, and its
    /// heights
    ///     are not checked again. Figures are the same; bound_m() is the highest post everywhere
    static Posts load(std::span<const std::string> paths, const LoadOptions& options = {},
                      const PostsFacts* facts = nullptr);
    /// The same of what is open already, without surroundings.
    static Posts load(Source source, const LoadOptions& options);
    /// Of posts that are not unrolled().
    PostsFacts facts() const;
    /// A hash of all heights and their places (content_of()). Of posts that are not unrolled().
    std::uint64_t content() const;

    /// The posts of a grid that goes round the Earth, starting at another column and repeated as
    /// often as wanted: column 0 is `first` of the others.
    /// @param posts  Grid::columns_per_turn() is a number; outlives this
    static Posts unrolled(const Posts& posts, int first, int columns);
    /// A turn of them with a place in the middle; none of a grid that does not go round the Earth.
    static std::optional<Posts> around(const Posts& posts, const geo::Geodetic& place);

    /// The same posts with a wider DEM around them, whose ground shades them, too.
    /// @param surroundings  null: none
    /// @param rim           of how many posts, as rimmed() makes it
    Posts in(std::shared_ptr<const Posts> surroundings, int rim = 0) const;
    /// That DEM; null: there is none.
    const Posts* surroundings() const { return surroundings_.get(); }
    int rim() const { return rim_; }

    Posts(Posts&&) noexcept;
    Posts& operator=(Posts&&) noexcept;
    ~Posts();

    const Grid& grid() const;
    const Description& about() const;  ///< its statistics are those of all posts
    bool in_memory() const;            ///< as one array: not so of unrolled posts
    float lowest_m() const { return about().statistics.min_m; }
    float highest_m() const { return about().statistics.max_m; }

    /// The highest that the ground can be within a box of cells: no less than the highest post at
    /// their corners; where one of these is a hole, highest_m(), for a hole may hide that.
    /// @param first_column, last_column, first_row, last_row  of cells (between posts), inclusive
    float bound_m(int first_column, int last_column, int first_row, int last_row) const;

    /// Where heights are in memory.
    struct View {
        const float* first_m;   ///< of post (column, row), NaN for a hole
        std::ptrdiff_t stride;  ///< from row to row
        int column, row;

        const float* at(int c, int r) const { return first_m + (r - row) * stride + (c - column); }
    };
    /// Posts of a window and perhaps others around it.
    /// @param window  inside of the grid
    /// @param buffer  where they are put unless memory holds them already; the view ends with it
    View view(const Window& window, std::vector<float>& buffer) const;

    /// The height of a post near another one, as a look around from afar needs it: of every
    /// thinning()-th post in each direction the nearest, which is always at hand.
    float thinned_m(int column, int row) const;
    /// Hangs on nothing but the grid: 1 for grids of up to kThinned posts a side.
    int thinning() const;
    static constexpr int kThinned = 512;

    /// Whether a post without a height lies outside of the DEM: in a void that reaches the edge of
    /// the grid, by thinned_m(), so to thinning() posts. Voids within the DEM are none such.
    bool is_outside(int column, int row) const;

    /// As Heightfield::height_at().
    double height_at(double column, double row) const;

  private:
    struct Impl;
    explicit Posts(std::shared_ptr<Impl> impl);
    std::shared_ptr<Impl> impl_;
    std::shared_ptr<const Posts> surroundings_;
    int rim_ = 0;
};

}  // namespace relevo::dem
