#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/array2d.h"
#include "geo/local_frame.h"
#include "render/displacement.h"
#include "render/frame_block.gen.h"
#include "render/loading.h"
#include "render/moon.h"
#include "scene/camera.h"
#include "sun/celestial.h"
#include "sun/refraction.h"

namespace relevo::sky {
class Atmosphere;
}

namespace relevo::render {

class HeightLight;

/// The sun over a DEM, for the shaders.
struct SunLight {
    glm::dvec3 direction{0, 0, 1};  ///< unit vector towards the geometric sun, in the local frame
    /// Refraction at a geometric elevation [rad]; empty without refraction.
    std::function<double(double elevation_rad)> refraction_rad;
    /// The same; 0 without refraction.
    double lift_rad(double elevation_rad) const {
        return refraction_rad ? refraction_rad(elevation_rad) : 0.0;
    }
    double ground_height_m = 0;  ///< of the lit ground, above sea level: its middle
    double highest_m = 0;        ///< height of the highest ground
    /// Range of the sine of the sun's geometric elevation over the DEM.
    double lowest_sine = 0, highest_sine = 1;
    double semidiameter_rad = 0;  ///< of the solar disc; 0: a point source
    /// Irradiance outside the atmosphere, linear sRGB: less in an eclipse, and of moonlight.
    glm::dvec3 strength{1};
    /// Refraction as seen from a place at its height; empty without refraction.
    std::function<sun::Refraction(const geo::Geodetic&)> air{};
    /// Curvature of rays over the ground, as a fraction of the Earth's: light::ShadowOptions.
    double terrestrial_refraction = 0.13;
};

/// Sunlight and refraction by the sine of the sun's local elevation, interpolated linearly. rgb:
/// irradiance on a surface that faces the sun. a: displacement of the unit vector to the sun along
/// the local vertical. Entry i is for the sine whose sun_light_scale() is domain.x + i / domain.y.
/// Errors: 0.1 arcsec of refraction and 0.1 % of irradiance for a DEM of 100 km; 14 arcsec (at the
/// horizon) and 0.3 % for the whole Earth (tests/render/test_frame_block.cpp).
struct SunLightTable {
    static constexpr std::size_t kEntries = 128;  // as in lib/ground.glsl

    std::array<glm::vec4, kEntries> light;
    glm::vec2 domain;
};
/// @param at  light at the ground's height
SunLightTable sun_light_table(const SunLight& sun, const HeightLight& at);
/// As in lib/ground.glsl.
double sun_light_scale(double sine);
/// Its inverse.
double sun_light_sine(double scaled);

/// The part of a picture that a frame shows: a tile of one that is larger than a frame, or the
/// whole moved by less than a pixel, for samples within pixels. Cameras are of the whole picture.
struct PicturePart {
    glm::ivec2 picture_px{0};  ///< size of the whole picture
    /// Lower left corner of the frame, from that of the picture [px].
    glm::dvec2 corner_px{0};
    /// The picture is itself a part of a panorama. What its pixels show must not depend on which
    /// part they are in: levels of detail and shadows are those of all directions, and Pixel::
    /// in_picture is the middle everywhere.
    bool of_panorama = false;
};

/// Inputs of a frame.
struct FrameInputs {
    scene::Camera camera;
    std::optional<PicturePart> part{};  ///< nullopt: the frame is the picture
    SunLight sun;
    double sun_visible = 1;      ///< fraction of the sun's disc that the moon does not cover
    std::optional<Moon> moon{};  ///< drawn in the sky if there is one
    /// Whose light falls on the ground; null: that of the formulas of sun/daylight.h. Set by the
    /// renderer.
    std::shared_ptr<const sky::Atmosphere> atmosphere{};
    /// The moon's light, if it is the direct light on the ground: set by choose_direct_light().
    std::optional<SunLight> moonlight{};
    /// The direct light on the ground, with its shadows.
    const SunLight& direct_light() const { return moonlight ? *moonlight : sun; }
    sun::CelestialFrame stars;  ///< at the DEM's centre
    /// The DEM has sky and air even if the eye is outside of it.
    bool in_the_air = false;
    double exposure_ev = 0;  ///< stops above the natural exposure of this sun, or above `ev100`
    std::optional<double> ev100;  ///< of a camera; without: the natural exposure of this sun
    double exaggeration = 1;      ///< vertical exaggeration, a factor
    Displacement displacement;    ///< by effects; set by the renderer
    Loading loading = Loading::Wait;
    /// Freezes cached passes of native effects, such as shadow maps.
    bool freeze_native = false;
    /// Native effects must not depend on earlier frames.
    bool deterministic = false;
    double unix_s = 0;   ///< time of the sun, seconds since 1970-01-01T00:00Z
    double seconds = 0;  ///< of effects that move
};

/// The part of its year that has passed, by UTC, from 0 to 1.
/// @param unix_s  as FrameInputs
double time_of_year(double unix_s);

/// Coverage of a DEM from above: ground per square of a grid in the horizontal plane of the local
/// frame, with a margin.
struct Footprint {
    Array2d<float> share;           ///< covered fraction, 0 to 1; row 0 is the southernmost
    glm::dvec2 south_west_m{0, 0};  ///< corner of the first square
    double square_m = 1;            ///< side of a square

    /// Covered fraction at a point; 0 outside of the grid.
    double at(const glm::dvec2& point_m) const;
};

/// The parts of a frame that stay the same: frame of reference, extent and block of a DEM.
struct Ground {
    geo::LocalFrame frame;
    double lowest_m = 0, highest_m = 1;  ///< of the DEM's posts

    /// Reference height of the air that sunlight passes: the middle of the height range, at least
    /// sea level [m].
    double air_height_m() const { return std::max(0.0, 0.5 * (lowest_m + highest_m)); }

    glm::dvec2 south_west_m{-1, -1};  ///< corner of the posts' bounding box in the local frame
    glm::dvec2 north_east_m{1, 1};    ///< opposite corner
    Footprint footprint;
    /// Depth of the block below the DEM's lowest post [m]; 0 for a globe, which has no block.
    double block_m = 0;
    double floor_m = 0;          ///< least z in the local frame of the rim at height 0
    double rim_m = 0;            ///< two fifths of the posts along the DEM's edge are lower
    double sea_floor_share = 0;  ///< dem::Water::sea_floor_share()
    double sea_rim_share = 0;    ///< dem::Water::sea_rim_share()

    /// Height of the level country that pictures have around the DEM [m]. Where the sea is along
    /// the DEM's edge, its height; elsewhere rim_m, so that the edge is nowhere far above it or
    /// below.
    double country_m() const;
    /// Height of the block's lower side as drawn [m].
    double base_m(double exaggeration) const { return lowest_m * exaggeration - block_m; }
};

/// True if the eye is outside of the DEM's footprint, or higher above it than about a third of its
/// width.
bool is_outside(const Ground& ground, const glm::dvec3& eye_m, double exaggeration);
/// As above, for a frame: never for one in the air.
bool is_outside(const Ground& ground, const FrameInputs& inputs);

/// Distance of the near plane [m]. With reversed depth, a small value costs no precision.
inline constexpr double kNear_m = 0.5;

/// Step of FrameBlock::eye_anchor [m]. The Earth's radius is less than 4096 steps, and half a step
/// is accurate to 0.06 mm in single precision (shaders/lib/repeats.glsl).
inline constexpr double kEyeAnchor_m = 2048;
/// Within this distance of the DEM's centre the anchor is the centre, since single precision is
/// accurate to 0.5 mm there [m].
inline constexpr double kEyeAnchorFrom_m = 8192;

/// Steps from the DEM's centre to the anchor of an eye, east and north.
glm::dvec2 eye_anchor(const glm::dvec2& eye_m);

/// Elevation by its sine, which rounding may have moved beyond 1 [rad].
double elevation_of(double sine);

/// xyz: a geometric direction as an eye sees it. w: its apparent elevation [rad].
/// @param bent  refraction at the eye, as a fraction of that in `air`
glm::dvec4 seen_from(const glm::dvec3& up, const glm::dvec3& direction, const SunLight& air,
                     double bent);

/// From positions relative to the eye to camera space: right, up, forward.
glm::dmat4 view_matrix(const scene::Camera& camera);

/// From camera space to clip space, with an infinite far plane: depth = near / distance.
glm::dmat4 projection_matrix(const scene::Camera& camera, int width_px, int height_px);

/// Size of the picture that a frame of some size belongs to [px].
glm::ivec2 picture_px(const FrameInputs& inputs, int width_px, int height_px);

/// The frame block except for the members that Terrain, GroundLight, AirTextures and others know.
/// @param footprint_limit  see frame.glsl
FrameBlock make_frame_block(const FrameInputs& inputs, const Ground& ground, int width_px,
                            int height_px, double footprint_limit);

}  // namespace relevo::render
