#pragma once

#include <algorithm>
#include <array>
#include <functional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/array2d.h"
#include "geo/local_frame.h"
#include "render/displacement.h"
#include "render/frame_block.gen.h"
#include "render/loading.h"
#include "scene/camera.h"
#include "sun/celestial.h"
#include "sun/refraction.h"

namespace relevo::render {

/// The sun over a DEM, as the shaders need it.
struct SunLight {
    glm::dvec3 direction{0, 0, 1};  ///< towards the sun, geometric, in the local frame, unit
    /// By how much the air lifts the sun at a geometric elevation [rad]; none where refraction is
    /// off.
    std::function<double(double elevation_rad)> refraction_rad;
    double ground_height_m = 0;  ///< of the ground that is lit, above sea level
    /// Least and greatest sine of the sun's geometric elevation over the DEM.
    double lowest_sine = 0, highest_sine = 1;
    double semidiameter_rad = 0;  ///< half the disc's width; 0: its centre is all there is
    /// The air over a place at its height, which lifts the sun as the ground there sees it; none
    /// where refraction is off.
    std::function<sun::Refraction(const geo::Geodetic&)> air{};
    /// Of rays over the ground, as a share of the Earth's curvature: light::ShadowOptions.
    double terrestrial_refraction = 0.13;
};

/// Light and refraction by the sine of the sun's local elevation, linear between entries: rgb
/// irradiance on a surface that faces the sun, and in `a` how far along the local vertical the
/// direction moves. Entry i stands for the sine whose sun_light_scale() is domain.x + i / domain.y.
/// Accuracy: 0.1 arcsec of refraction and 0.1 % of the light for a DEM of 100 km, 14 arcsec (at the
/// horizon) and 0.3 % for one of the whole Earth (tests/render/test_frame_block.cpp).
struct SunLightTable {
    static constexpr std::size_t kEntries = 128;  // lib/ground.glsl

    std::array<glm::vec4, kEntries> light;
    glm::vec2 domain;
};
SunLightTable sun_light_table(const SunLight& sun);
/// As lib/ground.glsl.
double sun_light_scale(double sine);

/// What a frame is drawn with.
struct FrameInputs {
    scene::Camera camera;
    SunLight sun;
    sun::CelestialFrame stars;  ///< of the DEM's centre
    double exposure_ev = 0;     ///< stops brighter than the natural exposure of this sun
    double exaggeration = 1;    ///< factor on heights
    Displacement displacement;  ///< by the effects; the renderer fills it
    Loading loading = Loading::Wait;
    /// Native effects leave what they have made as it is, such as shadows of the sun as it was.
    bool keep_native = false;
    /// Native effects keep nothing by which the picture would hang on frames before.
    bool afresh = false;
    double unix_s = 0;  ///< the sun's moment, since 1970-01-01T00:00Z, for native modules
};

/// Where a DEM has ground, as seen from above: shares of squares of the local frame's plane, with
/// room around.
struct Footprint {
    Array2d<float> share;           ///< 0 to 1, row 0 in the south
    glm::dvec2 south_west_m{0, 0};  ///< corner of the first square
    double square_m = 1;            ///< side of a square

    /// 0 beside it.
    double at(const glm::dvec2& point_m) const;
};

/// What does not change from frame to frame.
struct Ground {
    geo::LocalFrame frame;
    double lowest_m = 0, highest_m = 1;  ///< of the DEM's posts

    /// Where the air that the light passes through is taken: the middle of the range, no lower than
    /// the sea.
    double air_height_m() const { return std::max(0.0, 0.5 * (lowest_m + highest_m)); }

    glm::dvec2 south_west_m{-1, -1};  ///< corner of the DEM's posts in the local frame
    glm::dvec2 north_east_m{1, 1};    ///< likewise
    Footprint footprint;
    /// How far the block that a DEM is seen as from outside reaches below its lowest post [m]; 0
    /// where it goes round the Earth.
    double block_m = 0;
    double floor_m = 0;  ///< z of the lowest of the rim at height 0, in the local frame

    /// Height of the block's lower side as it is drawn, above the DEM's zero [m].
    double base_m(double exaggeration) const { return lowest_m * exaggeration - block_m; }
};

/// Whether the eye is outside of the DEM: beside its ground, or above it by more than a third of
/// its width.
bool is_outside(const Ground& ground, const glm::dvec3& eye_m, double exaggeration);

/// Nothing nearer is drawn; reversed depth, so that nothing is lost by a small one.
inline constexpr double kNear_m = 0.5;

/// Steps of FrameBlock::eye_anchor [m]: the Earth's radius has fewer than 4096 of them, and half a
/// step in floats is exact to 0.06 mm (shaders/lib/repeats.glsl).
inline constexpr double kEyeAnchor_m = 2048;
/// Nearer to the DEM's centre the anchor is the centre: floats are exact to 0.5 mm there [m].
inline constexpr double kEyeAnchorFrom_m = 8192;

/// Whole steps from the DEM's centre to the anchor of an eye, east and north.
glm::dvec2 eye_anchor(const glm::dvec2& eye_m);

/// From positions relative to the eye to the picture's axes: right, up, forward.
glm::dmat4 view_matrix(const scene::Camera& camera);

/// From there to clip space with the far end at infinity: depth = near / distance.
glm::dmat4 projection_matrix(const scene::Camera& camera, int width_px, int height_px);

/// All but what the terrain knows of its pages.
/// @param footprint_limit  see frame.glsl
FrameBlock make_frame_block(const FrameInputs& inputs, const Ground& ground, int width_px,
                            int height_px, double footprint_limit);

}  // namespace relevo::render
