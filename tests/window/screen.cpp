// What tests do with the screen, many times a second while they wait: this file alone is optimised.
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>

#include "image/image.h"
#include "window/display.h"

namespace relevo::test {
namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

}  // namespace

image::Image8 picture_of_dump(const std::string& dump) {
    // Sizes as big-endian words, a table of colours, then BGRX rows.
    const auto word = [&](std::size_t i) { return std::size_t{big_endian(dump, 4 * i)}; };
    const std::size_t width = word(4), height = word(5), stride = word(12), colours = word(19);
    constexpr std::size_t kBytesAColour = 12;
    image::Image8 picture(static_cast<int>(width), static_cast<int>(height), 3);
    for (std::size_t y = 0; y < height; ++y) {
        const char* from = dump.data() + word(0) + colours * kBytesAColour + y * stride;
        std::uint8_t* to = picture.row(static_cast<int>(y));
        for (std::size_t x = 0; x < width; ++x, from += 4, to += 3)
            for (int c = 0; c < 3; ++c)
                to[c] = static_cast<std::uint8_t>(from[2 - c]);
    }
    return picture;
}

double brightness(const image::Image8& picture) {
    const auto sum =
        std::accumulate(picture.values.begin(), picture.values.end(), std::uint64_t{0});
    return static_cast<double>(sum) / static_cast<double>(picture.values.size());
}

double difference(const image::Image8& a, const image::Image8& b, int by) {
    if (a.width != b.width || a.height != b.height) return 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        count += std::abs(int{a.values[i]} - int{b.values[i]}) > by ? 1U : 0U;
    return static_cast<double>(count) / static_cast<double>(a.values.size());
}

}  // namespace relevo::test
