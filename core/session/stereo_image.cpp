#include "session/stereo_image.h"

#include <algorithm>
#include <variant>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "session/srgb16.h"

namespace relevo::session {
namespace {

// Columns: what red, green and blue of an eye give to the picture, in linear light.
const glm::mat3 kLeft(0.437F, -0.062F, -0.048F,  //
                      0.449F, -0.062F, -0.050F,  //
                      0.164F, -0.024F, -0.017F);
const glm::mat3 kRight(-0.011F, 0.377F, -0.026F,  //
                       -0.032F, 0.761F, -0.093F,  //
                       -0.007F, 0.009F, 1.234F);

float linear(std::uint16_t value) {
    return decoded(value);
}
float linear(float value) {
    return value;
}
void store(float light, std::uint16_t& to) {
    to = encoded(light);
}
void store(float light, float& to) {
    to = std::max(light, 0.0F);
}

template <typename Pixels>
Pixels mixed(const Pixels& left, const Pixels& right) {
    Pixels result(left.width, left.height, 3);
    for (std::size_t i = 0; i < result.values.size(); i += 3) {
        const auto light = [i](const Pixels& of) {
            return glm::vec3(linear(of.values[i]), linear(of.values[i + 1]),
                             linear(of.values[i + 2]));
        };
        const glm::vec3 both = kLeft * light(left) + kRight * light(right);
        for (std::size_t c = 0; c < 3; ++c)
            store(both[static_cast<glm::length_t>(c)], result.values[i + c]);
    }
    return result;
}

}  // namespace

image::Picture side_by_side(const image::Picture& left, const image::Picture& right) {
    return std::visit(
        [&](const auto& first) {
            using Pixels = std::decay_t<decltype(first)>;
            const Pixels& second = std::get<Pixels>(right.pixels);
            Pixels both(first.width + second.width, first.height, first.channels);
            const auto put = [&](const Pixels& from, int x, int y) {
                std::copy_n(from.row(y), from.width * from.channels,
                            both.row(y) + x * both.channels);
            };
            for (int y = 0; y < both.height; ++y) {
                put(first, 0, y);
                put(second, first.width, y);
            }
            return image::Picture{both};
        },
        left.pixels);
}

image::Picture anaglyph(const image::Picture& left, const image::Picture& right) {
    if (const auto* const deep = std::get_if<image::Image16>(&left.pixels))
        return {mixed(*deep, std::get<image::Image16>(right.pixels))};
    return {mixed(std::get<image::ImageF>(left.pixels), std::get<image::ImageF>(right.pixels))};
}

}  // namespace relevo::session
