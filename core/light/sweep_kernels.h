#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

/// What light/sweep does to many posts at once, with the widest vectors that a processor has. Every
/// width finds the same bits.
namespace relevo::light::kernel {

constexpr float kNothing_m = -std::numeric_limits<float>::infinity();  // where nothing shades

/// Ground under rays, in an array of its rows: at the i-th line it is
/// rows[p + i] + part * (rows[q + i] - rows[p + i]) high.
struct Ground {
    std::int32_t p, q;
    float part;
};

/// Of all lines, how far they have come down: fall + ramp * line.
struct Slope {
    float fall = 0, ramp = 0;
};

/// Rays of one shape that come down more or less steeply, each on a level of its own: what they
/// meet is looked up once.
constexpr int kMostLevels = 6;

/// Whole vectors of lines that rise to their ground: height[i] = max(height[i], all ground). NaN, a
/// hole, changes nothing.
struct Lift {
    float* height_m;  // of the first level; those of the next begin `pitch` on
    int lines;
    const float* rows;  // at the first line, here and below
    const Ground* ground;
    int grounds;
    int levels;
    std::ptrdiff_t pitch;
    const float* over_m;  // for each ground and each further level: how much higher it is there
};

/// A row of ground, to whose heights is added what rays have fallen by there, so that they are
/// level.
struct Tilted {
    const float* from;
    const float* next;  // what will be taken next: fetched into the cache
    float* to;
    int lines;      // any number
    int line;       // the first one
    float between;  // how far on towards the next line each post stands
    Slope slope;
    float base_m;  // added, too
};

/// Posts between the lines before and behind them, whose own rays are followed over the nearest
/// ground. A line below the floor counts as one that has met nothing, so that a post's edge does
/// not hang on how far off ground is swept; a post beside such a line has nothing from either.
struct EdgeSight {
    float* edge_m;                     // of the first level; those of the next begin `pitch` on
    int posts;                         // filled up to whole vectors
    const float *before_m, *behind_m;  // the lines, likewise; null: there are none yet
    float part;                        // of the way between them
    int line;                          // as Tilted has it, and the next ones
    float between;
    const float* falls;  // of each level
    float ramp;
    float base_m;  // taken away again
    float floor_m;
    const float* rows;
    const Ground* ground;
    int grounds;
    int levels;
    std::ptrdiff_t edge_pitch, line_pitch;
    const float* over_m;  // as Lift has it
};

/// Ground before posts next to each other, as their own rays meet it.
struct Sight {
    float* tangent;  // max(tangent, that of all ground)
    const float* height_m;
    int posts;
    const float* rows;
    const Ground* ground;
    const Slope* slopes;  // 1 / distance, and what the ground has sunk by there
    int grounds;
};

/// Tangents of rays, some degrees apart, that every line carries over its ground: for each the
/// post that holds it up, whose distance and height are known. Between two of them a horizon is
/// seen over that post's neighbours, from where their difference is of second order.
constexpr std::array kFanDegrees{-4.0, -2.5, -1.3, -0.3, 0.7,  1.7,  2.9,  4.2,  5.6,  7.1,
                                 8.7,  10.4, 12.2, 14.1, 16.1, 18.2, 20.5, 23.0, 25.7, 28.6,
                                 31.8, 35.2, 38.8, 42.6, 46.8, 51.4, 57.0, 64.0, 73.0};
constexpr int kRays = kFanDegrees.size();
constexpr int kFanPoints = 4;  // of the ground that a fan is laid over at once

/// A post of ground under each line, less what that has sunk by below the tangent plane.
struct FanPoint {
    Ground ground;
    float sunk_m, distance_m;  // away from the sun
};

/// Whole vectors of lines, whose fans are raised to points of ground.
struct FanLift {
    float *height_m, *distance_m;  // of the first ray's; those of the next begin `pitch` on
    std::ptrdiff_t pitch;
    int lines;
    const float* tangents;  // kRays
    const float* rows;
    const FanPoint* points;
    const float* rises;  // for each ray those of the points: tangent * distance
};

/// Posts next to each other behind fans, one for each.
struct FanSight {
    float* tangent;
    const float* ground_m;
    const float *height_m, *distance_m;  // as in FanLift
    std::ptrdiff_t pitch;
    int posts;
    int first_ray;  // that is looked at
    const float* tangents;
    float from_m, sunk_m, tilt;  // how far off the posts are, and the plane there
    bool both;                   // what holds the next steeper ray up is looked over, too
};

/// Of heights, holes aside: infinity and minus infinity where there are no others.
struct HeightRange {
    float lowest_m = std::numeric_limits<float>::infinity(), highest_m = kNothing_m;
};

/// All of them by vectors of some width.
struct SweepKernel {
    void (*add_to_range)(const float* height_m, int count, HeightRange& range);
    void (*raise)(const Lift& lift);
    void (*tilt)(const Tilted& row);
    void (*look_for_edges)(const EdgeSight& sight);
    void (*look)(const Sight& sight);
    void (*raise_fans)(const FanLift& lift, int points);  // 1 to kFanPoints
    /// The tangent over what holds the steepest ray up that passes over a post, or minus infinity.
    void (*look_over_fans)(const FanSight& sight);
};

/// With the widest vectors that this processor has.
/// @param lanes  and that have so many numbers at most, 4 to Sweep::kMostLanes
const SweepKernel& widest_sweep_kernel(int lanes);

}  // namespace relevo::light::kernel
