#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/texture.h"
#include "image/image.h"

/// What frames leave on the device, read by the host. Each function waits for the device.
namespace relevo::render {

/// How much of the sun a pixel of the ground was drawn with, by the pass that drew the frame.
struct SunSeen {
    glm::dvec2 post{0};      ///< column and row of the DEM, the first post at 0
    double share = 0;        ///< of the sun, by all effects that answer the hook `visibility`
    double pixel_posts = 0;  ///< posts along the pixel's side on the ground
    bool faces = false;      ///< the ground is turned to the sun
    bool moved = false;      ///< an effect has moved the ground from where the DEM has it
};

/// The number of RGBA8 pixels whose light or colour was NaN or infinite before it was clamped. The
/// shaders mark them by an alpha below 1.
int count_not_numbers(std::span<const std::uint8_t> rgba);

/// RGB, rows from the top.
/// @param not_numbers  filled, if not null, with count_not_numbers()
image::Image8 read_picture(const gl::Texture& picture, int* not_numbers);
/// Linear radiance, RGB, rows from the top. @param exposure  that it is stored with
image::ImageF read_radiance(const gl::Texture& radiance, double exposure, int* not_numbers);
/// The view depth [m] of a stored one.
float distance_m(float depth);
/// View depths [m], rows from below, infinity where there is sky.
std::vector<float> read_depths(const gl::Texture& depth);
/// Of the pixels that show ground.
std::vector<SunSeen> read_sun_seen(const gl::Texture& sun_seen, const gl::Texture& gbuffer,
                                   const gl::Texture& depth);

}  // namespace relevo::render
