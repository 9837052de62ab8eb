#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "light/fields.h"
#include "render/pages.h"

namespace relevo::render::test_pages {
namespace {

/// A bowl on the equator, where a UTM grid runs along the axes: of a height that is quadratic in
/// both coordinates central differences are exact, and one-sided ones are off by half a step.
constexpr double kSpacing_m = 10;
constexpr int kSide = 257;
constexpr double kPerMetre = 1.0 / 4000;

double height_m(int column, int row) {
    const double x = (column - kSide / 2) * kSpacing_m, y = (row - kSide / 2) * kSpacing_m;
    return kPerMetre * (x * x + 0.5 * y * y);
}

TEST(NormalPage, IsOfDifferencesToBothSides) {
    const dem::Heightfield dem = test::field_of(
        kSide, kSide, {500000, kSpacing_m, 0, 1300, 0, -kSpacing_m}, "EPSG:32631", height_m);
    const dem::Pyramid pyramid(dem.height_m);
    const geo::LocalFrame frame(dem.grid.center());
    const PatchNet net =
        fit_patch_net([&](double column, double row) { return dem.grid.place(column, row); }, frame,
                      {0, 0}, glm::dvec2(span_on_dem(pyramid, {0, 0}, kNormalNodes)));
    const std::vector<std::uint32_t> page =
        normal_page(pyramid, 0, {0, 0}, net, frame.up(kPi / 2, 0));
    std::vector<double> errors, at_the_rim;
    for (int row = 0; row < kNormalNodes; ++row) {
        for (int column = 0; column < kNormalNodes; ++column) {
            const std::uint32_t texel =
                page[static_cast<std::size_t>((row + 1) * kNormalPage_px + column + 1)];
            const glm::dvec2 found(static_cast<std::int16_t>(texel & 0xffffU) / 32767.0,
                                   static_cast<std::int16_t>(texel >> 16) / 32767.0);
            // The slope eastwards and northwards; rows run south.
            const double east = 2 * kPerMetre * (column - kSide / 2) * kSpacing_m;
            const double north = -kPerMetre * (row - kSide / 2) * kSpacing_m;
            const glm::dvec3 normal = normalize(glm::dvec3(-east, -north, 1));
            const bool rim = column == 0 || row == 0;
            (rim ? at_the_rim : errors).push_back(length(found - glm::dvec2(normal)));
        }
    }
    // A one-sided difference is 0.0025 off here, a half step of the curvature; UTM's scale 0.0004.
    test::print_accuracy("normals of a bowl", errors, "of 1", 5e-4);
    test::print_accuracy("normals at its rim, one-sided", at_the_rim, "of 1", 3e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 5e-4);
    EXPECT_LT(*std::max_element(at_the_rim.begin(), at_the_rim.end()), 3e-3);
}

}  // namespace
}  // namespace relevo::render::test_pages
