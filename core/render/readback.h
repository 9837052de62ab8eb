#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gl/texture.h"
#include "image/image.h"

/// Reads frames from the device. Each function waits for the device.
namespace relevo::render {

/// Sunlight that a pixel of ground was drawn with.
struct SunSeen {
    glm::dvec2 post{0};  ///< column and row in the DEM
    double share = 0;  ///< visibility of the sun by all effects with the hook `visibility`, 0 to 1
    double pixel_posts = 0;           ///< side of the pixel on the ground in posts
    bool faces = false;               ///< the ground faces the sun
    bool moved = false;               ///< an effect has displaced the ground
    bool shaded_by_instance = false;  ///< the shadow of a plugin's instance lies here
};

/// What pixels show, for layers of data: a value a pixel, rows from the top.
struct PixelData {
    std::vector<float> depths_m;  ///< along the optical axis; infinite in the sky
    /// Unit normals of the shaded ground, with what effects change in them, in the local frame; 0
    /// where there is no ground.
    std::vector<glm::vec3> normals;
    std::vector<float> sun;           ///< visible fraction of the sun, 0 to 1; 0 without ground
    std::vector<std::uint8_t> walls;  ///< 1 where a cut side of the DEM is seen
    /// Diffuse colour of the ground, linear; 0 on walls and without ground. Empty unless asked for.
    std::vector<glm::vec3> albedo;
};

/// Number of RGBA8 pixels that were NaN or infinite before clamping. Shaders mark them with an
/// alpha below 1.
int count_non_finite(std::span<const std::uint8_t> rgba);

/// Pixels of a frame that are NaN or infinite.
struct NonFinite {
    int count = 0;
    glm::ivec2 first{0};  ///< column and row, rows from the top
};
NonFinite find_non_finite(const gl::Texture& output);

/// Display-referred colours: RGB, rows from the top.
/// @param non_finite  if not null, receives count_non_finite()
image::Image8 read_output(const gl::Texture& output, int* non_finite);
/// The same of RGBA16.
image::Image16 read_output16(const gl::Texture& output, int* non_finite);
/// @param albedo  null: PixelData::albedo stays empty
PixelData read_data(const gl::Texture& surface, const gl::Texture& depth,
                    const gl::Texture* albedo);
/// Linear radiance, RGB, rows from the top. @param exposure  factor in the stored values
image::ImageF read_radiance(const gl::Texture& radiance, double exposure, int* non_finite);
/// Depth along the optical axis [m] of a stored depth.
float distance_m(float depth);
/// Depths along the optical axis [m], rows from the bottom; infinite in the sky.
std::vector<float> read_depths(const gl::Texture& depth);
/// Of pixels that show ground.
std::vector<SunSeen> read_sun_seen(const gl::Texture& sun_seen, const gl::Texture& gbuffer,
                                   const gl::Texture& depth);

}  // namespace relevo::render
