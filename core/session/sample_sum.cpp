#include "session/sample_sum.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "session/srgb16.h"

// Rejected: a frame of several times the size, scaled down, because lines, levels of detail and
// full-screen effects are measured in pixels; and multisampling, because shading is deferred.
namespace relevo::session {
namespace {

/// Width of the dither in steps of 8 bits, as lib/shown.glsl has it.
constexpr float kDitherWidth = 0.8F;

/// source: J. Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH
/// 2014 course, slide 123: interleaved gradient noise
float noise(float x, float y) {
    const auto fract = [](float v) { return v - std::floor(v); };
    return fract(52.9829189F * fract(x * 0.06711056F + y * 0.00583715F));
}

}  // namespace

SampleSum::SampleSum(int width_px, int height_px, bool transparent)
    : width_px_(width_px), height_px_(height_px), transparent_(transparent) {
    const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    sums_.resize(3 * pixels);
    if (transparent) covered_.resize(pixels);
}

template <typename Pixels, typename Linear>
void SampleSum::add_pixels(const Pixels& pixels, std::span<const float> depths_m,
                           const Linear& linear) {
    assert(pixels.width == width_px_ && pixels.height == height_px_ && pixels.channels == 3);
    ++frames_;
    for (std::size_t i = 0; 3 * i < sums_.size(); ++i) {
        if (transparent_) {
            if (!std::isfinite(depths_m[i])) continue;
            ++covered_[i];
        }
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            sums_[c] += linear(pixels.values[c]);
    }
}

void SampleSum::add(const image::Image16& colours, std::span<const float> depths_m) {
    add_pixels(colours, depths_m, decoded);
}

void SampleSum::add(const image::ImageF& radiance, std::span<const float> depths_m) {
    add_pixels(radiance, depths_m, [](float value) { return value; });
}

image::Image16 SampleSum::colours() const {
    image::Image16 result(width_px_, height_px_, transparent_ ? 4 : 3);
    std::uint16_t* to = result.values.data();
    for (std::size_t i = 0; 3 * i < sums_.size(); ++i) {
        const float weight = transparent_ ? covered_[i] : static_cast<float>(frames_);
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            *to++ = weight > 0 ? encoded(sums_[c] / weight) : std::uint16_t{0};
        if (transparent_)
            *to++ = static_cast<std::uint16_t>(
                std::lround(kMost16 * weight / static_cast<float>(frames_)));
    }
    return result;
}

image::ImageF SampleSum::radiance() const {
    image::ImageF result(width_px_, height_px_, transparent_ ? 4 : 3);
    float* to = result.values.data();
    const auto frames = static_cast<float>(frames_);
    for (std::size_t i = 0; 3 * i < sums_.size(); ++i) {
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            *to++ = sums_[c] / frames;
        if (transparent_) *to++ = covered_[i] / frames;
    }
    return result;
}

image::Image8 dithered(const image::Image16& image, int left_px, int below_px) {
    image::Image8 result(image.width, image.height, image.channels);
    for (int y = 0; y < image.height; ++y) {
        const auto row = static_cast<float>(below_px + image.height - 1 - y) + 0.5F;
        for (int x = 0; x < image.width; ++x) {
            const float offset =
                kDitherWidth * (noise(static_cast<float>(left_px + x) + 0.5F, row) - 0.5F);
            for (int c = 0; c < image.channels; ++c) {
                const float value = 255 * static_cast<float>(image.at(x, y, c)) / kMost16;
                const float wanted = value + (c == 3 ? 0 : offset);
                result.row(y)[x * image.channels + c] =
                    static_cast<std::uint8_t>(std::lround(std::clamp(wanted, 0.0F, 255.0F)));
            }
        }
    }
    return result;
}

}  // namespace relevo::session
