// Figures of pixels on a DEM of many posts.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "drawn.h"
#include "light/fields.h"

namespace relevo::render::test_large_dem {
namespace {

using test::Drawn;
using test::TestEffect;

const TestEffect kPost{"probe",
                       "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 r) {\n"
                       "    r = vec3(fract(s.post) + 1.0, 1.0) / frame.exposure;\n"
                       "}\n"};

/// Where a ray meets the ellipsoid, in columns and rows.
glm::dvec2 post_met(const Drawn& drawn, const glm::dvec3& ray) {
    const geo::LocalFrame& frame = drawn.ground().frame;
    const glm::dvec3 eye = drawn.frame().camera.eye_m;
    double above = 0, below = 1000;  // distances [m]
    for (int i = 0; i < 60; ++i) {
        const double middle = (above + below) / 2;
        (frame.to_geodetic(eye + middle * ray).height_m > 0 ? above : below) = middle;
    }
    return drawn.dem().grid.post(frame.to_geodetic(eye + above * ray));
}

/// Between fractions of posts, of which 0 and 1 are the same.
double apart(double a, double b) {
    return std::abs(a - b - std::round(a - b));
}

TEST(LargeDem, PixelsKnowTheirPostToAHundredth) {
    constexpr int kColumns = 100'000, kRows = 120;
    Drawn drawn(test::field_of(kColumns, kRows, {450'000, 1, 0, 5'200'000, 0, -1}, "EPSG:32632",
                               [](int, int) { return 0; }),
                {kPost}, 160, 120);
    for (const double column : {0.0005, 0.5, 0.9995}) {
        drawn.stand(column, 0.95, 12, 10, -25);
        const image::ImageF image = drawn.radiance();
        double worst = 0;
        for (int y = 60; y < drawn.height_px(); ++y)
            for (int x = 0; x < drawn.width_px(); ++x) {
                const glm::dvec2 expected = post_met(drawn, drawn.ray(x + 0.5, y + 0.5));
                const glm::dvec2 got = Drawn::values(image, x, y);
                worst = std::max({worst, apart(got.x, expected.x), apart(got.y, expected.y)});
            }
        fmt::print("[ accuracy ] post of a pixel at column {:.0f}: worst {:.4f} of a post\n",
                   column * (kColumns - 1), worst);
        EXPECT_LT(worst, 0.01);
    }
}

}  // namespace
}  // namespace relevo::render::test_large_dem
