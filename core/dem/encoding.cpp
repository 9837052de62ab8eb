#include "dem/encoding.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::dem {

std::string_view name_of(Encoding encoding) {
    return encoding == Encoding::TerrainRgb  ? "terrain-rgb"
           : encoding == Encoding::Terrarium ? "terrarium"
                                             : "none";
}

float decoded_m(Encoding encoding, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    const double r = red, g = green, b = blue;
    return static_cast<float>(encoding == Encoding::TerrainRgb
                                  ? -10000 + (65536 * r + 256 * g + b) / 10
                                  : 256 * r + g + b / 256 - 32768);
}

double black_m(Encoding encoding) {
    return decoded_m(encoding, 0, 0, 0);
}

std::optional<Encoding> plausible_encoding(std::span<const std::uint8_t> red,
                                           std::span<const std::uint8_t> green,
                                           std::span<const std::uint8_t> blue, int width) {
    assert(red.size() == green.size() && red.size() == blue.size());
    // The finest tiles are smooth and the coarsest (zoom 0, 156 km a post) are rough; a step of red
    // is 6553.6 m or 256 m, one of green 25.6 m or 1 m.
    constexpr double kStep_m = 100;
    for (const Encoding encoding : {Encoding::TerrainRgb, Encoding::Terrarium}) {
        std::vector<double> steps_m;
        bool of_the_earth = true;
        bool level = true;
        double before_m = 0;
        for (std::size_t i = 0; i < red.size() && of_the_earth; ++i) {
            const double height_m = decoded_m(encoding, red[i], green[i], blue[i]);
            const bool black = red[i] == 0 && green[i] == 0 && blue[i] == 0;
            of_the_earth = black || (height_m > -11500 && height_m < 9000);
            if (i % static_cast<std::size_t>(width) > 0 && !black)
                steps_m.push_back(std::abs(height_m - before_m));
            level = level && (steps_m.empty() || steps_m.back() == 0);
            before_m = height_m;
        }
        // A picture of one colour says nothing.
        if (!of_the_earth || level || steps_m.size() < 16) continue;
        const auto most = steps_m.begin() + static_cast<std::ptrdiff_t>(steps_m.size() * 9 / 10);
        std::nth_element(steps_m.begin(), most, steps_m.end());
        if (*most < kStep_m) return encoding;
    }
    return std::nullopt;
}

}  // namespace relevo::dem
