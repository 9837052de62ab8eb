#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "scene/scene.h"

/// Pairs of pictures for two eyes, with parallel optical axes: the frames are moved sideways
/// instead of turned, so that nothing has vertical parallax.
namespace relevo::scene {

inline bool is_side_by_side(Stereo stereo) {
    return stereo == Stereo::Parallel || stereo == Stereo::CrossEyed;
}

/// Size of the picture of one eye [px]: side by side each has half of the width.
glm::ivec2 view_px(const Scene& scene);
/// Its width / height.
double view_aspect(const Scene& scene);

/// @throws Error (BadInput) for an odd width side by side, and for a panorama
void check_stereo(const Scene& scene);

/// Two eyes.
struct StereoPair {
    double eye_distance_m = 0;
    /// Depth without parallax: what is farther away lies behind the picture [m].
    double window_m = 0;

    /// How far to the right the left eye's frame is moved, and the right eye's to the left [px].
    double shift_px(double focal_px) const { return 0.5 * focal_px * eye_distance_m / window_m; }
    /// Position of a point in the left eye's picture less that in the right eye's, to the right
    /// [px]; negative behind the window. @param depth_m  along the optical axis
    double disparity_px(double depth_m, double focal_px) const {
        return focal_px * eye_distance_m * (1 / depth_m - 1 / window_m);
    }
};

/// Eyes for ground of these depths along the optical axis [m], infinite in the sky. The window is
/// where 2 % of the ground's pixels are nearer. Default distance: 1/30 of that.
/// Source of the 1/30: J. Ferwerda, The World of 3-D, 1987, chapter 18.
StereoPair stereo_pair(double eye_distance_m, std::span<const float> depths_m);

}  // namespace relevo::scene
