#include "session/annotations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relevo::session {
namespace {

template <typename T>
void lay_over_any(const image::Image8& over, image::Pixels<T>& picture) {
    constexpr float kMost = std::numeric_limits<T>::max();
    const auto channels = static_cast<std::size_t>(picture.channels);
    for (std::size_t i = 0; 4 * i < over.values.size(); ++i) {
        const std::uint8_t* const from = over.values.data() + 4 * i;
        if (from[3] == 0) continue;
        T* const to = picture.values.data() + channels * i;
        const float upper = static_cast<float>(from[3]) / 255;
        const float below = (channels == 4 ? static_cast<float>(to[3]) / kMost : 1) * (1 - upper);
        for (int c = 0; c < 3; ++c) {
            const float colour = kMost * static_cast<float>(from[c]) / 255;
            to[c] = static_cast<T>(std::lround(
                (upper * colour + below * static_cast<float>(to[c])) / (upper + below)));
        }
        if (channels == 4) to[3] = static_cast<T>(std::lround(kMost * (upper + below)));
    }
}

}  // namespace

image::Image8 drawn_alone(int width_px, int height_px,
                          const std::function<void(image::Image8&)>& draw) {
    image::Image8 on_black(width_px, height_px, 3), on_white(width_px, height_px, 3);
    std::ranges::fill(on_white.values, std::uint8_t{255});
    draw(on_black);
    draw(on_white);
    image::Image8 alone(width_px, height_px, 4);
    for (std::size_t i = 0; 4 * i < alone.values.size(); ++i) {
        const std::uint8_t* const black = on_black.values.data() + 3 * i;
        const std::uint8_t* const white = on_white.values.data() + 3 * i;
        int shows = 255;  // of the picture below
        for (int c = 0; c < 3; ++c)
            shows = std::min(shows, std::max(white[c] - black[c], 0));
        const int alpha = 255 - shows;
        for (int c = 0; c < 3; ++c)
            alone.values[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(
                alpha == 0 ? 0 : std::min(255, (255 * black[c] + alpha / 2) / alpha));
        alone.values[4 * i + 3] = static_cast<std::uint8_t>(alpha);
    }
    return alone;
}

void annotate(image::Picture& picture, const std::function<void(image::Image8&)>& draw) {
    auto* const plain = std::get_if<image::Image8>(&picture.pixels);
    if (plain && plain->channels == 3) return draw(*plain);
    if (plain) return lay_over(drawn_alone(plain->width, plain->height, draw), *plain);
    auto& deep = std::get<image::Image16>(picture.pixels);
    lay_over(drawn_alone(deep.width, deep.height, draw), deep);
}

void lay_over(const image::Image8& over, image::Image8& picture) {
    lay_over_any(over, picture);
}

void lay_over(const image::Image8& over, image::Image16& picture) {
    lay_over_any(over, picture);
}

}  // namespace relevo::session
