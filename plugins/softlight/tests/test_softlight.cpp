#include <cmath>
#include <functional>
#include <string>

#include "light/fields.h"
#include "render/height_means.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_softlight {
namespace {

/// Share of the vertical in the normal of ground seen from straight above, 30 m posts.
/// @param pixel_posts  posts along a side of the pixel
double upright(const std::function<double(int, int)>& height_m, double pixel_posts) {
    test::GpuSnippet gpu("softlight");
    const dem::Heightfield field =
        test::field_of(129, 129, {500000, 30, 0, 640, 0, -30}, "EPSG:32631", height_m);
    render::HeightMeans means(field);
    render::FrameBlock& frame = gpu.frame();
    means.update(frame);
    frame.height_range = {0, 1, 1, 0};
    frame.light_axes = {1.0F / 30, 0, 0, -1.0F / 30};
    frame.polar_axis = {0, 1, 0, 0};
    frame.normal_texels_per_m = 1.0F / 30;
    frame.pixel_ray_dx = {1, 0, 0, 0};
    gpu.bind(render::kHeightMeansTexture, *means.texture());
    return gpu
        .run(
            "Surface s;\n"
            "s.post = vec2(63.5, 64.0);\n"
            "s.up = vec3(0.0, 0.0, 1.0);\n"
            "s.distance_m = 30.0 * " +
                std::to_string(pixel_posts) +
                ";\n"
                "softlight_on_normal(s);\n"
                "result = vec4(s.normal, 0.0);",
            1, 1)[0]
        .z;
}

TEST(SoftLight, EvenSlopesAreAsTheyAre) {
    const auto slope = [](int column, int row) { return 15.0 * column + 9.0 * row; };
    EXPECT_NEAR(upright(slope, 1), 1 / std::hypot(1.0, 0.5, 0.3), 1e-3);
}

TEST(SoftLight, SinglePostsDoNotDotSlopes) {
    const auto rough = [](int column, int) { return column / 2 % 2 ? 25.0 : 0.0; };
    for (const double pixel_posts : {0.1, 1.0, 4.0})
        EXPECT_GT(upright(rough, pixel_posts), 0.97) << pixel_posts;
}

}  // namespace
}  // namespace relevo::test_softlight
