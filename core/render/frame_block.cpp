#include "render/frame_block.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "base/units.h"
#include "geo/ellipsoid.h"
#include "render/height_light.h"
#include "scene/map_view.h"
#include "sun/daylight.h"

namespace relevo::render {
namespace {

using geo::kEquatorialRadius_m;
using geo::kFlattening;
constexpr double kBennett45_rad = radians(59.7 / 3600);  // as in frame.glsl: eye_sun_light.a

/// Refraction by `lift` raises a unit vector at an elevation to normalize(vector + a up). There is
/// none at the zenith.
double raised(double elevation_rad, double lift_rad) {
    const double cosine = std::cos(elevation_rad + lift_rad);
    return cosine > 1e-6 ? std::sin(lift_rad) / cosine : 0.0;
}

/// rgb: irradiance at a place where the sine of the sun's geometric elevation is `sine`. a:
/// displacement of the unit vector to the sun along the vertical by refraction.
glm::dvec4 light_at(const SunLight& sun, const HeightLight& at, double sine) {
    const double elevation = elevation_of(sine);
    return {at.direct(sun, sine), raised(elevation, sun.lift_rad(elevation))};
}

/// Half of the width and of the height of the picture, at view depth 1.
glm::dvec2 half_picture(const scene::Camera& camera, int width_px, int height_px) {
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    const double aspect =
        camera.map ? camera.map_aspect : static_cast<double>(width_px) / height_px;
    return {tan_y * aspect, tan_y};
}

/// The part that a frame shows: without `part`, all of its picture.
PicturePart part_of(const FrameInputs& inputs, int width_px, int height_px) {
    return inputs.part.value_or(PicturePart{.picture_px = {width_px, height_px}});
}

/// From clip space of a whole picture to that of a frame that shows a part of it.
glm::dmat4 part_matrix(const PicturePart& part, const glm::dvec2& frame_px) {
    const glm::dvec2 picture(part.picture_px);
    glm::dmat4 matrix(1.0);
    for (int i = 0; i < 2; ++i) {
        matrix[i][i] = picture[i] / frame_px[i];
        matrix[3][i] = (picture[i] - 2 * part.corner_px[i]) / frame_px[i] - 1;
    }
    return matrix;
}

/// Where posts are in clip space, of a map.
void write_map(const scene::MapView& map, const glm::dmat4& part, PictureBlock& block) {
    const auto clip = [&](const glm::dvec2& post) {
        const glm::dvec2 at = 2.0 * map.pixel(post) / map.size_px() - 1.0;
        return glm::dvec2(part * glm::dvec4(at.x, -at.y, 0, 1));
    };
    const glm::dvec2 first = clip({0, 0});
    const glm::dvec2 column = clip({1, 0}) - first, row = clip({0, 1}) - first;
    block.map_x = {column.x, row.x, first.x, 0};
    block.map_y = {column.y, row.y, first.y, 0};
}

}  // namespace

glm::dmat4 view_matrix(const scene::Camera& camera) {
    const glm::dvec3 right = cross(camera.forward, camera.up);
    glm::dmat4 view(1.0);
    for (int i = 0; i < 3; ++i) {
        view[i][0] = right[i];
        view[i][1] = camera.up[i];
        view[i][2] = camera.forward[i];
    }
    return view;
}

glm::dmat4 projection_matrix(const scene::Camera& camera, int width_px, int height_px) {
    const glm::dvec2 half = half_picture(camera, width_px, height_px);
    glm::dmat4 p(0.0);
    p[0][0] = 1 / half.x;
    p[1][1] = 1 / half.y;
    p[2][3] = 1;
    p[3][2] = kNear_m;
    return p;
}

glm::ivec2 picture_px(const FrameInputs& inputs, int width_px, int height_px) {
    return part_of(inputs, width_px, height_px).picture_px;
}

glm::dvec2 eye_anchor(const glm::dvec2& eye_m) {
    const double away_m = std::max(std::abs(eye_m.x), std::abs(eye_m.y));
    return away_m < kEyeAnchorFrom_m ? glm::dvec2(0) : glm::round(eye_m / kEyeAnchor_m);
}

double elevation_of(double sine) {
    return std::asin(std::clamp(sine, -1.0, 1.0));
}

glm::dvec4 seen_from(const glm::dvec3& up, const glm::dvec3& direction, const SunLight& air,
                     double bent) {
    const double elevation = elevation_of(dot(direction, up)),
                 lift = bent * air.lift_rad(elevation);
    return {normalize(direction + raised(elevation, lift) * up), elevation + lift};
}

double sun_light_scale(double sine) {
    return sine / (std::abs(sine) + 0.1);
}

double sun_light_sine(double scaled) {
    return 0.1 * scaled / (1 - std::abs(scaled));
}

SunLightTable sun_light_table(const SunLight& sun, const HeightLight& at) {
    // Widened for single precision.
    const double begin = sun_light_scale(sun.lowest_sine) - 1e-5,
                 step = (sun_light_scale(sun.highest_sine) + 1e-5 - begin) /
                        (SunLightTable::kEntries - 1);
    SunLightTable table;
    table.domain = {static_cast<float>(begin), static_cast<float>(1 / step)};
    for (std::size_t i = 0; i < SunLightTable::kEntries; ++i)
        table.light[i] =
            glm::vec4(light_at(sun, at, sun_light_sine(begin + static_cast<double>(i) * step)));
    return table;
}

double time_of_year(double unix_s) {
    const sun::Instant now = sun::Instant() + unix_s;
    const int year = now.utc().date.year;
    const int days = sun::days_between({year, 1, 1}, {year, 12, 31}) + 1;
    const double since_s = unix_s - sun::kDay_s * sun::days_between({1970, 1, 1}, {year, 1, 1});
    return std::clamp(since_s / (sun::kDay_s * days), 0.0, 1.0);
}

namespace {

/// The air before the ground in views from outside, where true air over a DEM of 100 km washes out
/// its far half. Towards the ground it becomes the true one.
/// @returns x: scale of distances; y: where it begins, so that the foreground is clear [m]
glm::dvec2 aerial_air(const Ground& ground, const FrameInputs& inputs, double eye_height_m) {
    if (!inputs.in_the_air) return {1, 0};
    constexpr double kClear_m = 6e3, kHigh = 0.1;  // of the DEM's width
    const glm::dvec2 extent_m = ground.north_east_m - ground.south_west_m;
    const double width_m = std::sqrt(extent_m.x * extent_m.y);
    const double above_m = eye_height_m - inputs.exaggeration * inputs.sun.ground_height_m;
    const double high = glm::smoothstep(0.0, 1.0, above_m / (kHigh * width_m));
    const glm::dvec2 eye(inputs.camera.eye_m);
    const glm::dvec2 away = eye - glm::clamp(eye, ground.south_west_m, ground.north_east_m);
    constexpr double kLeftOut = 0.9;  // of the way to the DEM's edge
    return {std::sqrt(std::min(kClear_m / std::max(width_m, 1.0), 1.0)) * high + 1 - high,
            kLeftOut * high * glm::length(glm::dvec3(away, above_m))};
}

EyeBlock eye_block(const FrameInputs& inputs, const Ground& ground, const geo::Geodetic& eye,
                   const PicturePart& part, const glm::dvec2& frame_px) {
    const scene::Camera& camera = inputs.camera;
    const glm::ivec2 picture = part.picture_px;
    const glm::dvec2 corner = part.corner_px, half = half_picture(camera, picture.x, picture.y);
    EyeBlock block;
    block.view_projection =
        glm::mat4(part_matrix(part, frame_px) * projection_matrix(camera, picture.x, picture.y) *
                  view_matrix(camera));
    const glm::dvec3 dx = cross(camera.forward, camera.up) * (2 * half.x / picture.x);
    const glm::dvec3 dy = camera.up * (2 * half.y / picture.y);
    block.pixel_ray = glm::vec4(
        camera.forward - (0.5 * picture.x - corner.x) * dx - (0.5 * picture.y - corner.y) * dy, 0);
    block.pixel_ray_dx = glm::vec4(dx, 0);
    block.pixel_ray_dy = glm::vec4(dy, 0);
    block.eye_m = glm::vec4(camera.eye_m, eye.height_m);
    const glm::dvec2 over_ground(camera.eye_m), anchor = eye_anchor(over_ground);
    block.eye_anchor = glm::vec4(anchor, over_ground - kEyeAnchor_m * anchor);

    // The normal of an ellipsoid at p is along D p, with p relative to the Earth's centre and D =
    // diag(1, 1, a^2/b^2). In the local frame D is still a matrix, and the centre is a constant.
    const geo::Geodetic& origin = ground.frame.origin();
    const double e2 = kFlattening * (2 - kFlattening);
    const glm::dvec3 axis = ground.frame.axes(kPi / 2, 0).up;
    const double stretch = 1 / ((1 - kFlattening) * (1 - kFlattening)) - 1;
    const auto along_normal = [&](const glm::dvec3& from_centre) {
        return (from_centre + stretch * dot(from_centre, axis) * axis) / kEquatorialRadius_m;
    };
    const double curvature_m =
        kEquatorialRadius_m / std::sqrt(1 - e2 * std::pow(std::sin(origin.lat_rad), 2));
    // The Earth's centre: down the normal to the axis, then along the axis.
    const glm::dvec3 centre = -(curvature_m + origin.height_m) * glm::dvec3(0, 0, 1) +
                              curvature_m * e2 * std::sin(origin.lat_rad) * axis;
    block.up_at_eye = glm::vec4(along_normal(camera.eye_m - centre), 0);
    const glm::dmat3 unit(1.0);
    for (int i = 0; i < 3; ++i)
        block.up_matrix[i] = glm::vec4(along_normal(unit[i]), 0);
    block.up_matrix[3].w = 1;
    block.polar_axis = glm::vec4(axis, 0);
    const double above_sea_m = std::max(eye.height_m, 0.0);
    block.eye_up =
        glm::vec4(ground.frame.up(eye.lat_rad, eye.lon_rad),
                  -std::sqrt(1 - std::pow(curvature_m / (curvature_m + above_sea_m), 2)));
    return block;
}

SunBlock sun_block(const FrameInputs& inputs) {
    const SunLight& light = inputs.direct_light();
    const double elevation = elevation_of(light.direction.z),
                 apparent = elevation + light.lift_rad(elevation);
    const glm::dvec3 level{light.direction.x, light.direction.y, 0};
    const glm::dvec3 heading = length(level) > 0 ? normalize(level) : glm::dvec3(0, 1, 0);
    const HeightLight middle(inputs, light.ground_height_m);
    const SunLightTable table = sun_light_table(light, middle);
    return {
        .sun_direction = glm::vec4(light.direction, elevation),
        .sun_apparent = glm::vec4(
            std::cos(apparent) * heading + glm::dvec3(0, 0, std::sin(apparent)), apparent),
        .sun_light = {glm::vec4(
            light_at(light, middle, 0.5 * (light.lowest_sine + light.highest_sine)))},
        .sky_irradiance = glm::vec4(middle.sky(light.direction.z), 0),
        .sun_light_domain = {table.domain.x, table.domain.y, 0, 0},
        .sun_light_table = table.light,
    };
}

SkyBlock sky_block(const FrameInputs& inputs, const Ground& ground, const geo::Geodetic& eye,
                   const EyeBlock& from) {
    const SunLight& sun = inputs.sun;
    const glm::dvec3 up = ground.frame.up(eye.lat_rad, eye.lon_rad);
    const double above_sea_m = std::max(eye.height_m, 0.0);
    // Refraction is proportional to the density of air at the eye, with a scale height of 10 km.
    const double thinned =
        std::exp(std::clamp((sun.ground_height_m - above_sea_m) / 10000, -10.0, 1.0));
    const HeightLight at_eye(inputs, above_sea_m);
    const glm::vec2 air(aerial_air(ground, inputs, from.eye_m.w));
    SkyBlock block{
        .eye_sun = glm::vec4(seen_from(up, sun.direction, sun, thinned)),
        .eye_sun_light = glm::vec4(at_eye.direct(sun, dot(sun.direction, up), thinned),
                                   thinned * sun.lift_rad(kPi / 4) / kBennett45_rad),
        .air_scale = air.x,
        .air_near_m = air.y,
    };
    const glm::dmat3 rows = glm::transpose(inputs.stars.axes);
    for (int i = 0; i < 3; ++i)
        block.celestial[static_cast<std::size_t>(i)] = glm::vec4(rows[i], inputs.stars.velocity[i]);
    write_moon(inputs, at_eye, up, thinned, from.eye_up.w, block);
    return block;
}

GroundBlock ground_block(const FrameInputs& inputs, const Ground& ground) {
    const double base_m = ground.base_m(inputs.exaggeration);
    // On the curved Earth the lowest point of the rim has its own vertical, which shortens the
    // depth along z.
    const double floor_m = ground.floor_m + base_m * (1 + ground.floor_m / kEquatorialRadius_m);
    const Footprint& footprint = ground.footprint;
    const glm::dvec2 sides_m =
        footprint.square_m * glm::dvec2(footprint.share.width(), footprint.share.height());
    return {
        .height_range = {ground.lowest_m, 1 / std::max(ground.highest_m - ground.lowest_m, 1e-3),
                         inputs.exaggeration,
                         inputs.displacement.range_m(ground.lowest_m, ground.highest_m).first},
        .ground_extent = glm::vec4(ground.south_west_m,
                                   1.0 / glm::max(ground.north_east_m - ground.south_west_m, 1.0)),
        .block = {base_m / inputs.exaggeration, floor_m, ground.block_m, 0},
        .footprint_area = glm::vec4(footprint.south_west_m, 1.0 / glm::max(sides_m, 1.0)),
        .sea_floor_share = static_cast<float>(ground.sea_floor_share),
        .sea_rim_share = static_cast<float>(ground.sea_rim_share),
        .beyond = inputs.in_the_air ? 1.0F : 0.0F,
        .beyond_m = static_cast<float>(ground.country_m()),
    };
}

PictureBlock picture_block(const FrameInputs& inputs, const PicturePart& part,
                           const glm::dvec2& frame_px, double footprint_limit) {
    const glm::dvec2 picture(part.picture_px);
    const double exposure = inputs.ev100
                                ? sun::exposure_of_ev100(*inputs.ev100)
                                : sun::natural_exposure(elevation_of(inputs.sun.direction.z),
                                                        inputs.sun_visible, moonlight_lux(inputs));
    PictureBlock block{
        .viewport = glm::vec4(frame_px, 1.0 / frame_px),
        .picture = glm::vec4(picture, 1.0 / picture),
        // Samples within a pixel belong to the same pixel.
        .part_left = static_cast<float>(std::round(part.corner_px.x)),
        .part_below = static_cast<float>(std::round(part.corner_px.y)),
        .exposure = static_cast<float>(exposure * std::exp2(inputs.exposure_ev)),
        .footprint_limit = static_cast<float>(footprint_limit),
        .seconds = static_cast<float>(inputs.seconds),
        .still_seconds = static_cast<float>(inputs.seconds),
        .time_of_year = static_cast<float>(time_of_year(inputs.unix_s)),
    };
    if (part.of_panorama) {
        // In the middle of a picture so large that no pixel is off its middle.
        constexpr float kLarge_px = 1 << 30;
        block.part_left = block.part_below = kLarge_px / 2;
        block.picture = glm::vec4(kLarge_px, kLarge_px, 1 / kLarge_px, 1 / kLarge_px);
    }
    if (inputs.camera.map) write_map(*inputs.camera.map, part_matrix(part, frame_px), block);
    return block;
}

}  // namespace

double Ground::country_m() const {
    constexpr double kSomeSea = 0.02;
    if (sea_floor_share > 0) return std::max(lowest_m, 0.0);
    return sea_rim_share > kSomeSea ? lowest_m : rim_m;
}

FrameBlock make_frame_block(const FrameInputs& inputs, const Ground& ground, int width_px,
                            int height_px, double footprint_limit) {
    const geo::Geodetic at = ground.frame.to_geodetic(inputs.camera.eye_m);
    const PicturePart part = part_of(inputs, width_px, height_px);
    const glm::dvec2 frame_px(width_px, height_px);
    const EyeBlock eye = eye_block(inputs, ground, at, part, frame_px);
    return {eye, sun_block(inputs), sky_block(inputs, ground, at, eye),
            ground_block(inputs, ground), picture_block(inputs, part, frame_px, footprint_limit)};
}

}  // namespace relevo::render
