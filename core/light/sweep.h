#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

/// The shadows that ground casts, for every post of a grid at once. This file, sweep_kernels.h,
/// shade_cells.h and their sources need nothing else of the project but base/parallel_for.h,
/// base/wide_loops.h and a constant of base/units.h.
namespace relevo::light {

class ShadeCells;

/// A figure for each way over a grid: along a row, from column to column, and along a column.
struct GridPair {
    double column = 0, row = 0;
};

/// A sun over a part of a grid, about a point of that part.
struct SweepSun {
    GridPair reference;  ///< the point
    /// Posts that a metre of ground leads towards the sun. Its length is what the spacing of the
    /// posts is that way, which need not be the same along rows and columns.
    GridPair towards;
    /// Where the grid shows rays as bent: change of `towards` with each metre, and of that.
    GridPair bend, twist;
    /// Of the elevation, as seen: how a ray comes down at the point, and by how much more from post
    /// to post. On a round Earth that is so much for each metre towards the sun as the ground turns
    /// away from it, refraction of the air included.
    double tangent = 0;
    GridPair tangent_a_post;

    /// From the reference to where the ray through it is after so many metres towards the sun.
    GridPair way(double distance_m) const;
    /// After how many metres it is at a row, from the reference on; less than 0 away from the sun.
    /// NaN where it turns back before.
    double distance_m(double row) const;
    /// The same with rows for columns.
    SweepSun transposed() const;
    /// Whether a sweep goes from column to column and not from row to row: as the ray's larger step
    /// is, unless that is set. Against it a sweep is slower, and finds the same.
    bool along_columns() const {
        return columns_set.value_or(std::abs(towards.row) < std::abs(towards.column));
    }
    std::optional<bool> columns_set;
    double tangent_at(double column, double row) const {
        return tangent + tangent_a_post.column * (column - reference.column) +
               tangent_a_post.row * (row - reference.row);
    }
};

/// A sun over a map that is true to scale.
/// @param spacing_m      from column to column and from row to row
/// @param direction      horizontally to the sun, a unit vector of metres
/// @param elevation_rad  as seen from `reference`
/// @param curvature      of the ground under a line of sight [1/m]: (1 - k) / R; 0: a plane
SweepSun sun_over_map(const GridPair& spacing_m, const GridPair& direction, double elevation_rad,
                      const GridPair& reference = {}, double curvature = 0);

/// Posts [column, column + columns) by [row, row + rows).
struct SweepWindow {
    int column = 0, row = 0, columns = 0, rows = 0;
};

/// For each row of a window, or each of its columns where sweeps of the sun go along these, the
/// first post that the ray through the reference does not leave behind; from the window's first one
/// to the one after its last. None where that ray turns back there.
std::optional<std::vector<int>> first_posts(const SweepSun& ray, const SweepWindow& window);

/// Posts next to each other, as a sweep comes to them: along a row, or along a column.
struct SweepRun {
    bool along_column;
    int line;   ///< the row or the column
    int first;  ///< the first post on it
    int count;
    const float* height_m;  ///< `count` of them
    const float* found;     ///< likewise: heights of the shadow's edge, or tangents of the horizon
};

/// Heights at the posts of a grid, and the shadows over them.
///
/// Rays of the sun are lines over the grid, half a post apart, all of one shape. A sweep goes away
/// from the sun, row by row (or column by column, as the sun stands), and lets every line fall with
/// the sun and rise to the ground under it: to all its crossings with the rows and columns of the
/// grid, heights being linear from post to post there. A post lies between two lines, and has the
/// mean of their heights by its distance from them; but for the ground of the nearest rows, which
/// is where an error would be shade, its own ray is followed. A post costs the same however far
/// shadows reach.
///
/// Accuracy: towards the eight directions of the compass rose on square posts exact, but for float:
/// else what lies farther off than the nearest rows is met within a quarter of a post of the ray
/// (tests/light/test_sweep.cpp has shares and figures). Every post gets the same bits whatever the
/// number of threads and the width of the processor's vectors. Speed: bench_light.
///
/// Safe on several threads at once.
class Sweep {
  public:
    /// @param height_m  the first post; NaN is a hole, which shades nothing. Outlives this
    /// @param stride    from row to row
    Sweep(const float* height_m, int columns, int rows, std::ptrdiff_t stride);

    /// Puts the heights of a window into an array, row by row; called on several threads at once.
    using Read = std::function<void(const SweepWindow&, std::vector<float>&)>;
    /// Heights that are read where they are needed, strip by strip, so that a sweep of any length
    /// takes little memory. What is found is the same, to the bit.
    /// @param lowest_m, highest_m  of all posts
    Sweep(Read read, int columns, int rows, float lowest_m, float highest_m);

    /// The height of the shadow's edge: how high the rays that pass over the ground before a post
    /// are at the post. What is lower there is in the shade; the post itself is lit where it is as
    /// high or higher, and its height less the edge is the margin. Minus infinity where nothing of
    /// the grid lies towards the sun. Holes have one, too.
    /// @param sun     its tangent may be of any sign and size; a ray that is bent must not
    ///     turn back over the grid
    /// @param window  of the grid, where it is wanted; ground outside of it shades all the same
    /// @param edge_m  the window's first post
    /// @param stride  of `edge_m`, from row to row
    /// @param lanes   of the processor's vectors that are used at most, 4 to kMostLanes
    void shadow_edge(const SweepSun& sun, const SweepWindow& window, float* edge_m,
                     std::ptrdiff_t stride, int lanes = kMostLanes) const;

    using Use = std::function<void(const SweepRun&)>;
    /// The same without an array for them: calls `use` on several threads, once for each post of
    /// the window. All runs are along rows or all along columns, as SweepSun::along_columns() has
    /// it. A post's edge is the same bits whatever the window, where there is a floor.
    /// @param floor_m  edges are no lower, and ground so far off that it makes only lower ones is
    ///     not swept. Under the lowest post it changes no shade
    void each_edge(const SweepSun& sun, const SweepWindow& window, const Use& use,
                   int lanes = kMostLanes, float floor_m = kNoFloor_m) const;

    /// The tangent of the horizon's elevation for all posts of a window, each as seen from the
    /// ground there: minus infinity where nothing of the grid lies that way. Called on several
    /// threads, once for each post. Each line carries a fan of rays over the ground that it came
    /// over, so that a post costs the same however far it sees; the ground of the nearest rows is
    /// looked at along the post's own ray, as for edges, and more of them. Horizons under -4
    /// degrees are those of the nearest rows alone. Accuracy: between two rays of the fan too low
    /// by the square of what they are apart (tests/light/test_horizons.cpp has shares and figures).
    /// @param way        its tangents mean nothing
    /// @param curvature  of the ground under a line of sight [1/m]
    /// @param reach_m    how far the ground is looked at
    void each_horizon(const SweepSun& way, double curvature, double reach_m,
                      const SweepWindow& window, const Use& use, int lanes = kMostLanes) const;

    class Blocks;

    static constexpr int kMostLanes = 16;
    /// What is kept for each post of a grid besides its height: that once more, turned, and where
    /// shade can be, along rows and along columns.
    static constexpr double kBytesAPost = 4 + 2 * 1.75;
    static constexpr float kNoFloor_m = -std::numeric_limits<float>::infinity();

    float lowest_m() const { return lowest_m_; }    ///< infinity where there are only holes
    float highest_m() const { return highest_m_; }  ///< minus infinity likewise

  private:
    struct View;
    View view(const SweepSun& sun, const SweepWindow& window) const;
    View edge_view(const SweepSun& sun, const SweepWindow& window) const;
    double drop_m(float floor_m) const;  // that matters of what rays fall by
    const float* transposed() const;
    const ShadeCells& cells(bool along_columns) const;
    template <typename OneStrip, typename Make, typename Look>
    void sweep_strips(View& view, double drop_m, const Make& make, const Look& look) const;

    const float* height_m_ = nullptr;
    Read read_;  // instead
    int columns_, rows_;
    std::ptrdiff_t stride_ = 0;
    float lowest_m_, highest_m_;
    // Made for the first sun that needs them; cells of rows, and of columns.
    mutable std::once_flag once_, cells_once_[2];
    mutable std::vector<float> transposed_;
    mutable std::shared_ptr<const ShadeCells> cells_[2];
};

/// The edges of several suns over a window, block by block: some rows (or columns) of it for one
/// sun after the other, then the next ones, so that the ground and what is kept of its posts stays
/// in the processor's cache. Of a window they are those of Sweep::each_edge(), to the bit; of
/// several suns with one shape of rays but for what floats round differently. A sun that differs
/// across its rays, as over a grid in degrees, has bands of posts between rays, each with lines of
/// its own. For one thread.
class Sweep::Blocks {
  public:
    /// Suns whose rays have one shape over the grid: what these meet is looked up once for all.
    struct Suns {
        SweepSun sun;
        /// What is added to its tangent for each of them; kMostLevels at most.
        std::vector<double> more{0};
    };
    /// Posts between two rays, over which suns are one: or several of which each is taken for some
    /// posts.
    struct Band {
        std::vector<Suns> suns;
        /// Where its posts begin and end on each of the window's lines, as first_posts() has them;
        /// none: where the window does. Both none: a window, over which lines are found otherwise.
        std::shared_ptr<const std::vector<int>> begin = nullptr, end = nullptr;
    };
    /// A moment, or some whose suns have one shape of rays.
    struct Sun {
        std::vector<Band> bands;  ///< with each post of the window once
        /// Else those posts may be left out which are lit, or in the shade, by all that is known
        /// before they are looked at, now and at the moments before and after.
        bool all_posts = true;
    };
    static constexpr int kMostLevels = 6;
    /// @param suns     one after the other in time, that go_together()
    /// @param floor_m  as Sweep::each_edge() has it
    /// @param earth_curvature  of the smooth Earth around the grid, as high as some of its posts:
    ///     it hides suns that are lower than level. Edges do not have it; where all_posts is not
    ///     asked for, those that are under its own may be lower still
    Blocks(const Sweep& sweep, const std::vector<Sun>& suns, const SweepWindow& window,
           float floor_m, double earth_curvature);
    ~Blocks();
    Blocks(const Blocks&) = delete;
    Blocks& operator=(const Blocks&) = delete;

    /// Whether all go along rows, or all along columns, and come from one side.
    static bool go_together(const std::vector<Sun>& suns);

    /// The next block of the window; none where all are done.
    std::optional<SweepWindow> next();
    /// Takes a run, and for each of the suns the edges there; those of the first are `run.found`.
    using UseEach = std::function<void(const SweepRun& run, const float* const* found)>;
    /// To be called once for all suns of each band of each moment in each block; `use` as
    /// Sweep::each_edge() has it, along columns or rows as the suns go.
    void each_edge(std::size_t moment, std::size_t band, std::size_t suns, const UseEach& use);
    /// Posts of a block that are in the shade at the first moment, others among them which are
    /// looked at then: what is left out else is lit. Runs have neither heights nor edges.
    void each_dark(const Use& use) const;

  private:
    struct OneShape;
    struct OneBand;
    struct BlockTerms;
    struct Moment;
    void add_band(const Band& band, const SweepWindow& window, float floor_m, Moment& moment);
    void leave_out(const std::vector<Sun>& suns, double earth_curvature);
    void read(int row, int end_row);

    const Sweep& sweep_;
    std::unique_ptr<View> view_;  // of the window
    std::unique_ptr<BlockTerms> terms_;
    std::vector<std::unique_ptr<Moment>> moments_;
    std::vector<OneShape*> shapes_;  // of all moments
    std::vector<float> buffer_;
    int row_, end_row_;  // of the block, as the suns go
};

/// Rows for columns.
/// @param rows, columns          of `from`
/// @param from_stride, to_stride from row to row
void transpose(const float* from, std::ptrdiff_t from_stride, int rows, int columns, float* to,
               std::ptrdiff_t to_stride);

}  // namespace relevo::light
