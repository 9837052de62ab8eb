#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What a sweep does to many posts at once, by the widest vectors that the processor has (Google's
/// Highway). Every width finds the same bits: multiplications and additions are rounded one by one.
///
/// Arrays are filled up to whole vectors: kernels read and write up to kVectorFloats - 1 numbers
/// more than they are asked for.
namespace relevo::light {

/// Floats of the widest vector.
constexpr int kVectorFloats = 16;
constexpr int in_vectors(int count) {
    return (count + kVectorFloats - 1) / kVectorFloats * kVectorFloats;
}

/// The height of holes, and of what has met no ground yet: so low that it shades nothing, nor does
/// what lies between it and ground. A number, so that vectors need not look for others.
constexpr float kNothing_m = -1e30F;

/// Where a ray meets ground between two posts of a row or of a column. For the i-th of rays next to
/// each other, the ground is ground[p + i] + weight * (ground[q + i] - ground[p + i]) high.
struct Crossing {
    std::int32_t p, q;
    float weight;
};

/// Copies a row of ground. To each height is added what the rays have fallen by since the row of
/// the reference, so that rays are level among them; a hole becomes kNothing_m.
struct RowTilt {
    const float* from_m;
    std::ptrdiff_t stride;  ///< to the next row: it is fetched into the cache meanwhile
    float* to_m;
    int count;                      ///< any number: nothing beyond it is touched
    float fall_m, fall_per_line_m;  ///< fallen: fall_m + fall_per_line_m * (line + i + post_offset)
    int line;
    float post_offset;
    float height_offset_m;  ///< added, too
};
void tilt_row(const RowTilt& row);

/// Raises lines to the ground that they meet: height_m[i] = max(height_m[i], ground at crossings).
void raise_lines(float* height_m, int count, const float* ground_m, const Crossing* crossings,
                 int crossing_count);

/// Heights of shadows at posts next to each other. Far ground comes by the lines before and behind
/// each post, by its place between them; that near is met by its own ray. A line below the floor
/// counts as one that has met nothing, so that it does not matter how far off ground was swept.
struct ShadowLook {
    float* shadow_m;  ///< gets them: floor_m or more
    int count;
    const float *left_m,
        *right_m;  ///< heights of the lines on either side; null: there are none yet
    float weight;  ///< of the right one; the left one has the rest
    float fall_m, fall_per_line_m;  ///< as in RowTilt; taken away again
    int line;
    float post_offset;
    float height_offset_m;  ///< added to each shadow
    float floor_m;          ///< minus infinity for none
    const float* ground_m;  ///< at the first post's line
    const Crossing* crossings;
    int crossing_count;
};
void look_for_shadows(const ShadowLook& look);

/// Elevations of the rays of a fan, some degrees apart, that every line carries over its ground. Of
/// each the distance and the height of the ground that it grazes are known. A horizon between two
/// of them is taken to be that of the lower ray's ground, which is too low by the square of what
/// they are apart.
constexpr std::array kFanDegrees{-4.0, -2.5, -1.3, -0.3, 0.7,  1.7,  2.9,  4.2,  5.6,  7.1,
                                 8.7,  10.4, 12.2, 14.1, 16.1, 18.2, 20.5, 23.0, 25.7, 28.6,
                                 31.8, 35.2, 38.8, 42.6, 46.8, 51.4, 57.0, 64.0, 73.0};
constexpr int kFanRays = kFanDegrees.size();
constexpr int kFanPoints = 4;  ///< that a fan is raised over at once, at most

/// The fans of lines next to each other: arrays of the first ray's, the next ray's `pitch` on.
struct Fans {
    float *height_m, *distance_m;
    std::ptrdiff_t pitch;
    const float* tangents;  ///< kFanRays
};

/// Ground under each line.
struct FanPoint {
    Crossing crossing;
    float sunk_m;      ///< that it lies below the tangent plane of the reference
    float distance_m;  ///< from the reference, away from the sun
};
/// @param points  1 to kFanPoints
void raise_fans(const Fans& fans, int count, const float* ground_m, const FanPoint* points,
                int point_count);

/// Posts next to each other behind fans, one fan for each.
struct FanLook {
    float* tangent;  ///< gets that of the ground which the steepest ray over the post grazes
    int count;
    const float* ground_m;
    Fans fans;
    int first_ray;         ///< lower ones are ignored
    float from_m, sunk_m;  ///< how far off the posts are; what they lie below the tangent plane by
    float plane_slope;     ///< tangent of that plane against the level there
    bool also_next;        ///< the ground that the next steeper ray grazes counts, too
};
void look_over_fans(const FanLook& look);

/// Ground just before posts next to each other, by their own rays.
struct NearGround {
    Crossing crossing;
    float per_metre;  ///< 1 / its distance
    float sunk;       ///< tangent that the ground has sunk by there
};
/// tangent[i] = max(tangent[i], that of all ground as seen from height_m[i])
void look_near(float* tangent, int count, const float* height_m, const float* ground_m,
               const NearGround* near, int near_count);

/// Rows for columns.
/// @param rows, columns           of `from`
/// @param from_stride, to_stride  from row to row
void transpose(const float* from, std::ptrdiff_t from_stride, int rows, int columns, float* to,
               std::ptrdiff_t to_stride);

/// For tests: vectors of so many floats at most (1, 4, 8 or kVectorFloats) from now on.
void set_widest_vector(int floats);

}  // namespace relevo::light
