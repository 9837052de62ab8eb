#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "base/window.h"
#include "light/sweep/ray.h"

/// Shadows and horizons of all posts of a grid at once. The files of this folder need nothing of
/// the project but base/, so that other programs can take them.
namespace relevo::light {

struct Sheet;
struct ShadowTables;

/// The posts that a sweep is for: those of a window, or of these the ones between two rays. Tiles
/// side by side that share a ray have each post once.
struct TilePosts {
    Window window;
    std::optional<Ray> after{};   ///< posts on this ray or after it, along the rows of the sweep
    std::optional<Ray> before{};  ///< and before this one
};

/// What was found of posts next to each other in a row of the grid.
struct SweepRun {
    int row, column;  ///< of the first one
    int count;
    const float* found;  ///< heights of shadows [m], or tangents of horizons
};

/// Heights at the posts of a grid, and the light over them.
///
/// Rays of the sun are lines over the grid, half a post apart, all of one shape. A sweep goes away
/// from the sun, row by row (or column by column, as the sun stands), and lets every line fall with
/// the sun and rise to the ground under it: to all its crossings with the rows and columns of the
/// grid, heights being linear from post to post there. A post lies between two lines, and has the
/// mean of their heights by its distance from them; but for the ground of the nearest rows, where
/// an error would show as false shade, its own ray is followed. A post costs the same however far
/// shadows reach.
///
/// Accuracy: towards the eight directions of the compass rose on square posts exact up to the
/// rounding of floats: else what lies farther off than the nearest rows is met within a quarter of
/// a post of the ray (tests/light/test_sweep.cpp has shares and figures). Every post gets the same
/// bits whatever the window asked for, the number of threads and the width of the processor's
/// vectors. Speed: bench_light.
///
/// Safe on several threads at once.
class Sweep {
  public:
    /// @param height_m  the first post; NaN is a hole, which shades nothing. Outlives this
    /// @param stride    from row to row
    Sweep(const float* height_m, int columns, int rows, std::ptrdiff_t stride);

    /// Where the heights of a window are: the first post's, and how far it is from row to row.
    struct Heights {
        const float* first_m;
        std::ptrdiff_t stride;
    };
    /// Returns where they are; what is not in memory is read into the array. Called on several
    /// threads.
    using Read = std::function<Heights(const Window&, std::vector<float>&)>;
    /// Heights that are read where they are needed, strip by strip, so that a sweep of any length
    /// takes little memory. What is found is the same, to the bit.
    /// @param lowest_m, highest_m  of all posts
    Sweep(Read read, int columns, int rows, float lowest_m, float highest_m);

    /// Called on several threads, once for each post.
    using Use = std::function<void(const SweepRun&)>;

    /// The height of the shadow: how high the rays that pass over the ground before a post are at
    /// the post. What is lower there is in the shade; the post itself is lit where it is as high or
    /// higher, and its height less the shadow's is its clearance. Holes have one, too.
    /// @param sun      its tangent may be of any sign and size
    /// @param posts    where it is wanted; ground outside of them shades all the same
    /// @param floor_m  shadows are no lower, and ground so far off that it makes only lower ones is
    ///     not swept. A post between a line above it and a line below has no far shade. Minus
    ///     infinity: none; then shadows are minus infinity where nothing of the grid lies towards
    ///     the sun
    void each_shadow(const SweepSun& sun, const TilePosts& posts, float floor_m,
                     const Use& use) const;

    /// The same sweep for a device: geometry alone, no height is read.
    ShadowTables shadow_tables(const SweepSun& sun, const TilePosts& posts, float floor_m) const;

    /// The tangent of the horizon's elevation, as seen from the ground at each post; less than
    /// -1e20 where nothing of the grid lies that way. Each line carries a fan of rays over the
    /// ground that it came over, so that a post costs the same however far it sees. Horizons under
    /// -4 degrees are those of the nearest rows alone. Accuracy: between two rays of the fan too
    /// low by the square of what they are apart (tests/light/test_horizons.cpp has figures).
    /// @param curvature  of the ground under a line of sight [1/m]
    /// @param reach_m    how far the ground is looked at
    void each_horizon(const Ray& ray, double curvature, double reach_m, const TilePosts& posts,
                      const Use& use) const;

    float lowest_m() const { return lowest_m_; }    ///< infinity where there are only holes
    float highest_m() const { return highest_m_; }  ///< minus infinity likewise

    /// What is kept for each post of a grid besides its height: that once more, turned.
    static constexpr double kBytesAPost = 4;
    static constexpr float kNoFloor_m = -std::numeric_limits<float>::infinity();

  private:
    struct Job;
    Job geometry(const SweepSun& sun, const TilePosts& posts) const;
    Job job_for(const SweepSun& sun, const TilePosts& posts) const;
    double most_fall_m(float floor_m) const;
    const float* transposed() const;
    void read(const Job& job, const Window& window, Sheet& sheet, std::vector<float>& buffer) const;
    template <typename Strip, typename Make>
    void sweep_strips(const Job& job, double drop_m, const Make& make, const Use& use) const;

    const float* height_m_ = nullptr;
    Read read_;  // instead
    int columns_, rows_;
    std::ptrdiff_t stride_ = 0;
    float lowest_m_, highest_m_;
    mutable std::once_flag once_;
    mutable std::vector<float> transposed_;  // made for the first sweep along columns
};

/// Where the posts of a tile between rays begin and end on a line of its window: a row or, for rays
/// that go along columns, a column. None where one of its rays turns back before it, or where the
/// two cross.
std::optional<std::pair<int, int>> range_of(const TilePosts& posts, int line, bool along_columns);

}  // namespace relevo::light
