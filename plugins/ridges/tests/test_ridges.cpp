#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "base/units.h"
#include "light/fields.h"
#include "render/height_means.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_ridges {
namespace {

/// How far posts along a row are ridges, every 4th, from post 32 on. Posts are 30 m apart.
std::vector<double> along_a_row(const std::function<double(int)>& height_m, float level = 1) {
    test::GpuSnippet gpu("ridges");
    const dem::Heightfield field =
        test::field_of(129, 129, {500000, 30, 0, 640, 0, -30}, "EPSG:32631",
                       [&](int column, int) { return height_m(column); });
    render::HeightMeans means(field);
    means.update(gpu.frame());
    gpu.frame().normal_texels_per_m = 1.0F / 30;
    gpu.bind(render::kHeightMeansTexture, *means.texture());
    std::vector<double> found;
    for (const glm::vec4& each :
         gpu.run("result = vec4(ridges_at(vec2(32.0 + 4.0 * float(x), 64.0), " +
                     std::to_string(level) + "));",
                 17, 1))
        found.push_back(each.x);
    return found;
}

TEST(Ridges, EvenSlopesAreNeither) {
    EXPECT_NEAR(along_a_row([](int) { return 500.0; })[8], 0, 1e-4);
    // In the middle of the DEM: the broadest forms know that its edge ends the slope.
    EXPECT_NEAR(along_a_row([](int column) { return 20.0 * column; }, 0)[8], 0, 0.1);
}

TEST(Ridges, ARidgeIsLightAndAHollowDark) {
    // Ridges 16 posts apart.
    const auto ridges = [](int column) { return 20 * std::cos(column * kPi / 8); };
    const std::vector<double> light = along_a_row(ridges);
    for (std::size_t k = 0; k < light.size(); ++k) {
        if (k % 4 == 0) {
            EXPECT_GT(light[k], 0.3) << k;
        } else if (k % 4 == 2) {
            EXPECT_LT(light[k], -0.3) << k;
        }
    }
    const std::vector<double> dark = along_a_row([&](int column) { return -ridges(column); });
    for (std::size_t k = 0; k < light.size(); ++k)
        EXPECT_NEAR(dark[k], -light[k], 1e-4) << k;
}

TEST(Ridges, SinglePostsFadeWherePixelsAreFinerThanPosts) {
    const auto comb = [](int column) { return column % 2 ? 0.0 : 30.0; };
    const auto most = [](const std::vector<double>& all) {
        double found = 0;
        for (const double each : all)
            found = std::max(found, std::abs(each));
        return found;
    };
    EXPECT_LT(most(along_a_row(comb, -3)), 0.5 * most(along_a_row(comb, 0)));
}

}  // namespace
}  // namespace relevo::test_ridges
