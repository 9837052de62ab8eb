#include "output/heightmap.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "geo/geodetic.h"

namespace relevo::output {

HeightScale height_scale(double lowest_m, double highest_m) {
    if (!(highest_m > lowest_m)) return {lowest_m, 1};
    return {lowest_m, (highest_m - lowest_m) / kMostValue};
}

image::Image16 heightmap(const Array2d<float>& height_m, const HeightScale& scale) {
    image::Image16 image(height_m.width(), height_m.height(), 1);
    std::transform(height_m.begin(), height_m.end(), image.values.begin(), [&](float height) {
        if (std::isnan(height)) return std::uint16_t{0};
        const double value = std::round((height - scale.offset_m) / scale.step_m);
        return static_cast<std::uint16_t>(std::clamp(value, 0.0, double{kMostValue}));
    });
    return image;
}

void write_raw(OutputFile& file, const image::Image16& values) {
    static_assert(std::endian::native == std::endian::little, "raw heightmaps are little-endian");
    file.write(std::as_bytes(std::span(values.values)));
}

namespace {

/// Ground metres from post to post, along a row and along the columns, in the middle of that row.
glm::dvec2 spacing_m(const dem::Grid& grid, int row, const glm::dvec2& otherwise) {
    const double middle = 0.5 * (grid.columns() - 1);
    const auto between = [&](const glm::dvec2& a, const glm::dvec2& b) {
        return geo::geodesic(grid.place(a.x, a.y), grid.place(b.x, b.y)).distance_m;
    };
    const double above = std::max(0.0, row - 0.5), below = std::min(grid.rows() - 1.0, row + 0.5);
    glm::dvec2 spacing(between({middle - 0.5, row}, {middle + 0.5, row}),
                       between({middle, above}, {middle, below}) / (below - above));
    constexpr double kLeast = 1e-3;  // rows at a pole are points
    if (!(spacing.x > kLeast * otherwise.x)) spacing.x = otherwise.x;
    if (!(spacing.y > kLeast * otherwise.y)) spacing.y = otherwise.y;
    return spacing;
}

/// The rise from the one side of a post to the other, by post; 0 where neither has a height.
double rise(float before, float here, float after) {
    if (std::isnan(before))
        before = here;
    else if (!std::isnan(after))
        return (after - before) / 2.0;
    if (std::isnan(after)) after = here;
    return after - before;
}

std::uint16_t encoded(double component) {
    return static_cast<std::uint16_t>(std::lround((component + 1) / 2 * kMostValue));
}

}  // namespace

image::Image16 normal_map(const dem::Heightfield& field, Green green) {
    const Array2d<float>& height_m = field.height_m;
    const glm::dvec2 middle_m = field.grid.post_spacing_m();
    image::Image16 image(height_m.width(), height_m.height(), 3);
    const auto at = [&](int column, int row) {
        const bool inside =
            column >= 0 && row >= 0 && column < height_m.width() && row < height_m.height();
        return inside ? height_m.at(column, row) : std::nanf("");
    };
    for (int row = 0; row < height_m.height(); ++row) {
        const glm::dvec2 spacing = spacing_m(field.grid, row, middle_m);
        std::uint16_t* pixel = image.row(row);
        for (int column = 0; column < height_m.width(); ++column, pixel += 3) {
            glm::dvec3 normal(0, 0, 1);
            if (const float here = at(column, row); !std::isnan(here))
                normal = glm::normalize(glm::dvec3(
                    -rise(at(column - 1, row), here, at(column + 1, row)) / spacing.x,
                    rise(at(column, row - 1), here, at(column, row + 1)) / spacing.y, 1));
            if (green == Green::Down) normal.y = -normal.y;
            for (int i = 0; i < 3; ++i)
                pixel[i] = encoded(normal[i]);
        }
    }
    return image;
}

image::Image8 to_8_bits(const image::Image16& normals) {
    image::Image8 image(normals.width, normals.height, normals.channels);
    std::ranges::transform(normals.values, image.values.begin(), [](std::uint16_t value) {
        return static_cast<std::uint8_t>(std::lround(value / 257.0));
    });
    return image;
}

}  // namespace relevo::output
