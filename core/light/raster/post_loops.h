#pragma once

#include <glm/vec3.hpp>

/// What rasters do to posts next to each other, by the widest vectors that the processor has, as
/// light/sweep/kernels.h.
namespace relevo::light {

/// The time from one position of the sun to the next.
struct Step {
    float from_h, hours;
};

/// By how much the ground is higher than the shadow over it.
void find_clearances(const float* height_m, const float* shadow_m, int count, float* clearance_m);

/// Makes lower limbs' clearances such that the line between them and the upper limb's passes 0
/// where the horizon cuts the disc, by height_of_disc().
void straighten(const float* upper_m, const float* middle_m, int count, float* lower_m);

/// Adds what light comes or goes between two suns, clearances being linear from the one to the
/// other: where it comes the time of that is taken away from a post's hours, where it goes it is
/// added.
/// @param clearance_m  at the first sun; gets those at the second
void add_light(const Step& step, const float* height_m, const float* shadow_m, int count,
               float* clearance_m, float* lit_h);

/// The sun over a row of posts, and the Earth around the DEM.
struct SunOverRow {
    float base, a_post;  ///< tangent of its elevation at a place, and by how much more a post on
    int from;            ///< the first post, from that place on
    float curvature;     ///< of lines of sight [1/m]
    float lowest_m;      ///< of the DEM
};
/// Shadows, raised to that of ground beyond the DEM that is as high as its edge.
/// @param edge_m, edge_at_m  of the edge: how high, how far off
void raise_to_earth(const float* shadow_m, const float* edge_m, const float* edge_at_m, int count,
                    const SunOverRow& sun, float* raised_m);

/// Shadows between those in the air of the lowest post and in that of the highest one, by the
/// posts' own heights.
/// @param a_metre   1 / (highest - lowest)
/// @param low_m     in the air of the lowest
/// @param shadow_m  in the air of the highest; gets them
void mix_by_height(const float* height_m, float lowest_m, float a_metre, const float* low_m,
                   int count, float* shadow_m);

/// Horizons that are no lower than those of the ground beyond the DEM's edge, as tangent_beyond()
/// has them, nor than the dip of a smooth Earth as high as the lowest post.
/// @param tangent           of the DEM's ground
/// @param eye_m             heights of the posts
/// @param edge_m, edge_at_m  of the edge: how high, how far off
/// @param curvature         of lines of sight [1/m]
void raise_to_dip(const float* tangent, const float* eye_m, const float* edge_m,
                  const float* edge_at_m, int count, float curvature, float lowest_m,
                  float* raised);

/// Elevations [rad] of tangents; NaN where the ground has no height.
void find_elevations(const float* tangent, const float* height_m, int count, float* elevation_rad);

/// Adds what a direction gives to the sky view of the ground of posts.
/// @param x, y, z    the ground's gradient
/// @param direction  of the sky: a level unit vector in the same frame
/// Source: Dozier and Frew (1990), equation 7b.
void add_sky(const float* tangent, const float* x, const float* y, const float* z, int count,
             const glm::vec3& direction, float* sum);

/// Where horizons are in a table of elevations: in entries from its first one on, and no farther
/// than its last but one.
/// @param base_rad, a_post_rad  the elevation of the first entry at a place of the row, and by how
///     much it is more from post to post
/// @param from                  the first post, from that place on
/// @param entry_rad             from entry to entry
void find_entries(const float* tangent, int count, float base_rad, float a_post_rad, int from,
                  float entry_rad, int entries, float* at);

}  // namespace relevo::light
