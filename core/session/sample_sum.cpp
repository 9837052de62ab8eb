#include "session/sample_sum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "base/srgb.h"

namespace relevo::session {
namespace {

constexpr float kMost = 65535;

/// Linear light, 0 to 1, of each value of sRGB with 16 bits.
const std::array<float, 65536>& decoded() {
    static const std::array<float, 65536> table = [] {
        std::array<float, 65536> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = static_cast<float>(linear_of_srgb(static_cast<double>(i) / kMost));
        }
        return values;
    }();
    return table;
}

std::uint16_t encoded(float linear) {
    const float v = std::clamp(linear, 0.0F, 1.0F);
    // srgb_of_linear() in single precision, for every pixel.
    const float srgb = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint16_t>(std::lround(kMost * srgb));
}

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
    const std::array<float, 65536>& table = decoded();
    add_pixels(colours, depths_m, [&](std::uint16_t value) { return table[value]; });
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
                std::lround(kMost * weight / static_cast<float>(frames_)));
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
            const float offset = noise(static_cast<float>(left_px + x) + 0.5F, row) - 0.5F;
            for (int c = 0; c < image.channels; ++c) {
                const float value = 255 * static_cast<float>(image.at(x, y, c)) / kMost;
                const float wanted = value + (c == 3 ? 0 : offset);
                result.row(y)[x * image.channels + c] =
                    static_cast<std::uint8_t>(std::lround(std::clamp(wanted, 0.0F, 255.0F)));
            }
        }
    }
    return result;
}

}  // namespace relevo::session
