#include "session/panorama_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "session/srgb16.h"

namespace relevo::session {
namespace {

constexpr int kRows = 16;  // for a thread at once

/// A frame in linear light, with premultiplied alpha if it has any.
image::ImageF linear_of(const image::Image16& frame) {
    image::ImageF linear(frame.width, frame.height, frame.channels);
    const auto channels = static_cast<std::size_t>(frame.channels);
    parallel_for(0, frame.height, kRows, [&](int first, int last) {
        const std::uint16_t* from = frame.row(first);
        float* to = linear.row(first);
        for (; from != frame.row(last); from += channels, to += channels) {
            const float alpha = channels == 4 ? static_cast<float>(from[3]) / kMost16 : 1;
            for (std::size_t c = 0; c < 3; ++c)
                to[c] = alpha * decoded(from[c]);
            if (channels == 4) to[3] = alpha;
        }
    });
    return linear;
}

/// Weights of four pixels for a place between the two in the middle, 0 to 1.
std::array<float, 4> cubic(float t) {
    const float t2 = t * t, t3 = t2 * t;
    return {-0.5F * t3 + t2 - 0.5F * t, 1.5F * t3 - 2.5F * t2 + 1, -1.5F * t3 + 2 * t2 + 0.5F * t,
            0.5F * t3 - 0.5F * t2};
}

/// The value of a frame at an image position, with all its channels.
std::array<float, 4> read(const image::ImageF& frame, const glm::dvec2& at_px) {
    const glm::dvec2 at = at_px - 0.5, low = floor(at);
    const std::array<float, 4> across = cubic(static_cast<float>(at.x - low.x)),
                               down = cubic(static_cast<float>(at.y - low.y));
    std::array<float, 4> sum{}, least{}, most{};
    least.fill(std::numeric_limits<float>::infinity());
    most.fill(-std::numeric_limits<float>::infinity());
    const auto channels = static_cast<std::size_t>(frame.channels);
    for (int j = 0; j < 4; ++j) {
        const float* const row =
            frame.row(std::clamp(static_cast<int>(low.y) + j - 1, 0, frame.height - 1));
        for (int i = 0; i < 4; ++i) {
            const int x = std::clamp(static_cast<int>(low.x) + i - 1, 0, frame.width - 1);
            const float* const pixel = row + static_cast<std::size_t>(x) * channels;
            const float weight =
                across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)];
            const bool is_near = (i == 1 || i == 2) && (j == 1 || j == 2);
            for (std::size_t c = 0; c < channels; ++c) {
                sum[c] += weight * pixel[c];
                if (!is_near) continue;
                least[c] = std::min(least[c], pixel[c]);
                most[c] = std::max(most[c], pixel[c]);
            }
        }
    }
    for (std::size_t c = 0; c < channels; ++c)
        sum[c] = std::clamp(sum[c], least[c], most[c]);
    return sum;
}

void write(const std::array<float, 4>& value, std::size_t channels, float* to) {
    std::copy_n(value.data(), channels, to);
}

/// Encoded, with straight alpha.
void write(const std::array<float, 4>& value, std::size_t channels, std::uint16_t* to) {
    const float alpha = channels == 4 ? value[3] : 1;
    for (std::size_t c = 0; c < 3; ++c)
        to[c] = alpha > 0 ? encoded(value[c] / alpha) : std::uint16_t{0};
    if (channels == 4)
        to[3] = static_cast<std::uint16_t>(std::lround(kMost16 * std::clamp(alpha, 0.0F, 1.0F)));
}

/// Calls visit(x, y, image position in the frame, direction) for the pixels of a part.
template <typename Visit>
void each_pixel(const scene::PanoramaMap& map, const PanoramaPart& part, const Visit& visit) {
    const PictureRect& rect = part.rect;
    parallel_for(rect.corner.y, rect.corner.y + rect.size.y, kRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = rect.corner.x; x < rect.corner.x + rect.size.x; ++x) {
                const glm::dvec3 direction = map.direction({x + 0.5, y + 0.5});
                visit(x, y, part.project(direction, map.px_per_rad()), direction);
            }
    });
}

template <typename Pixels>
void resample(const scene::PanoramaMap& map, const PanoramaPart& part, const image::ImageF& frame,
              image::Picture& picture) {
    if (!std::holds_alternative<Pixels>(picture.pixels))
        picture.pixels = Pixels(map.picture_px().x, map.picture_px().y, frame.channels);
    Pixels& to = std::get<Pixels>(picture.pixels);
    const auto channels = static_cast<std::size_t>(frame.channels);
    each_pixel(map, part, [&](int x, int y, const glm::dvec2& at, const glm::dvec3&) {
        write(read(frame, at), channels, to.row(y) + static_cast<std::size_t>(x) * channels);
    });
}

}  // namespace

void PanoramaImage::add(const PanoramaPart& part, const image::Picture& frame) {
    if (const auto* const deep = std::get_if<image::Image16>(&frame.pixels))
        resample<image::Image16>(map_, part, linear_of(*deep), picture_);
    else
        resample<image::ImageF>(map_, part, std::get<image::ImageF>(frame.pixels), picture_);
}

void PanoramaImage::add_depths(const PanoramaPart& part, const std::vector<float>& depths_m) {
    const glm::ivec2 size = map_.picture_px(), frame = part.frame.size;
    distances_m_.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    const glm::dvec3 forward = part.axes[2];
    each_pixel(map_, part, [&](int x, int y, const glm::dvec2& at, const glm::dvec3& direction) {
        const glm::ivec2 nearest = clamp(glm::ivec2(floor(at)), glm::ivec2(0), frame - 1);
        const float depth_m =
            depths_m[static_cast<std::size_t>(nearest.y) * static_cast<std::size_t>(frame.x) +
                     static_cast<std::size_t>(nearest.x)];
        distances_m_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                     static_cast<std::size_t>(x)] =
            static_cast<float>(depth_m / dot(direction, forward));
    });
}

}  // namespace relevo::session
