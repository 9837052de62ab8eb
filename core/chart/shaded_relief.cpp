#include "chart/shaded_relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace relevo::chart {
namespace {

/// Lowland green, hills, rock, snow; sRGB. For any DEM from its lowest to its highest ground.
constexpr std::array<glm::vec3, 5> kLand = {
    glm::vec3(96, 140, 92), {170, 178, 118}, {196, 164, 120}, {160, 140, 130}, {244, 244, 246}};
constexpr std::array<glm::vec3, 2> kSea = {glm::vec3(24, 60, 110), {140, 190, 214}};

template <std::size_t N>
glm::vec3 between(const std::array<glm::vec3, N>& colours, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * (N - 1);
    const auto first = std::min(static_cast<std::size_t>(at), N - 2);
    return glm::mix(colours[first], colours[first + 1],
                    static_cast<float>(at - static_cast<double>(first)));
}

/// The lowest and the highest but for one post in a hundred each.
std::pair<double, double> range_of(const Array2d<float>& heights_m) {
    std::vector<float> known;
    for (const float height : heights_m)
        if (std::isfinite(height)) known.push_back(height);
    if (known.empty()) return {0, 1};
    std::ranges::sort(known);
    const std::size_t skipped = known.size() / 100;
    return {known[skipped], known[known.size() - 1 - skipped]};
}

class Shader {
  public:
    explicit Shader(const dem::QuickLook& look) : look_(look) {
        std::tie(lowest_m_, highest_m_) = range_of(look.heights_m);
        // Flat ground is exaggerated, so that it has a shape, and steep ground is not.
        const double span_m =
            std::max(look.heights_m.width() * look.column_m, look.heights_m.height() * look.row_m);
        exaggeration_ =
            std::clamp(0.12 * span_m / std::max(highest_m_ - lowest_m_, 1e-6), 1.0, 40.0);
    }

    /// Red, green, blue, alpha of a place between posts.
    std::array<float, 4> at(double column, double row) const {
        const double height_m = sample(column, row);
        if (std::isnan(height_m)) return {0, 0, 0, 0};
        const glm::vec3 colour = of_height(height_m) * light(column, row);
        return {std::min(colour.r, 255.0F), std::min(colour.g, 255.0F), std::min(colour.b, 255.0F),
                255};
    }

  private:
    glm::vec3 of_height(double height_m) const {
        if (height_m < 0 && lowest_m_ < -20) return between(kSea, 1 - height_m / lowest_m_);
        const double from_m = lowest_m_ < -20 ? 0 : lowest_m_;
        return between(kLand, (height_m - from_m) / std::max(highest_m_ - from_m, 1e-6));
    }

    /// Lambert's law for a sun 45 degrees high in the north-west; 1 on level ground.
    float light(double column, double row) const {
        const auto slope = [&](double c, double r, double step_m) {
            const double before = sample(column - c, row - r), after = sample(column + c, row + r);
            if (std::isnan(before) || std::isnan(after)) return 0.0;
            return exaggeration_ * (after - before) / (2 * step_m);
        };
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3(-slope(1, 0, look_.column_m), slope(0, 1, look_.row_m), 1.0));
        const glm::dvec3 sun = glm::normalize(glm::dvec3(-1, 1, std::sqrt(2.0)));
        return static_cast<float>(0.25 + 0.75 * std::max(0.0, glm::dot(normal, sun)) / sun.z);
    }

    double sample(double column, double row) const {
        const Array2d<float>& heights = look_.heights_m;
        const double c = std::clamp(column, 0.0, heights.width() - 1.0);
        const double r = std::clamp(row, 0.0, heights.height() - 1.0);
        const int c0 = static_cast<int>(c), r0 = static_cast<int>(r);
        const int c1 = std::min(c0 + 1, heights.width() - 1),
                  r1 = std::min(r0 + 1, heights.height() - 1);
        const double x = c - c0, y = r - r0;
        return (1 - y) * ((1 - x) * heights.at(c0, r0) + x * heights.at(c1, r0)) +
               y * ((1 - x) * heights.at(c0, r1) + x * heights.at(c1, r1));
    }

    const dem::QuickLook& look_;
    double lowest_m_ = 0, highest_m_ = 1, exaggeration_ = 1;
};

}  // namespace

image::Image8 shaded_relief(const dem::QuickLook& look, int longest_px) {
    const double width_m = look.heights_m.width() * look.column_m;
    const double height_m = look.heights_m.height() * look.row_m;
    const double scale = longest_px / std::max(width_m, height_m);
    image::Image8 image(std::max(1, static_cast<int>(std::lround(width_m * scale))),
                        std::max(1, static_cast<int>(std::lround(height_m * scale))), 4);
    const Shader shader(look);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double column = (x + 0.5) * look.heights_m.width() / image.width - 0.5;
            const double row = (y + 0.5) * look.heights_m.height() / image.height - 0.5;
            const auto colour = shader.at(column, row);
            for (std::size_t k = 0; k < 4; ++k)
                image.row(y)[4 * x + static_cast<int>(k)] =
                    static_cast<std::uint8_t>(std::lround(colour[k]));
        }
    return image;
}

}  // namespace relevo::chart
