#include <cmath>
#include <functional>

#include "effect/effect.h"
#include "light/fields.h"
#include "render/drawn.h"
#include "support/support.h"

namespace relevo::test_occlusion {
namespace {

/// Visible share of the sky along the middle row, on ground seen from straight above.
std::vector<double> seen_from_above(const std::function<double(int, int)>& height_m) {
    std::vector<effect::Effect> shipped;
    shipped.push_back(
        effect::load_effect(test::source_dir() / "plugins/occlusion", test::source_dir() / "data"));
    constexpr int kSide_px = 128;
    test::Drawn drawn(
        test::field_of(129, 129, {500000, 10, 0, 640, 0, -10}, "EPSG:32631", height_m),
        {{"probe",
          "uniform sampler2D probe_seen; //@ from(occlusion.smooth)\n"
          "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
          "    float seen = texture(probe_seen, gl_FragCoord.xy * frame.viewport.zw).r;\n"
          "    radiance = vec3(seen, 0.0, 1.0) / frame.exposure;\n"
          "}\n"}},
        kSide_px, kSide_px, 0, shipped, {{"occlusion.radius_m", "200"}});
    drawn.stand(0.5, 0.5, 1100, 0, -90);
    const image::ImageF image = drawn.radiance();
    std::vector<double> seen;
    for (int x = 0; x < kSide_px; ++x)
        seen.push_back(test::Drawn::values(image, x, kSide_px / 2).x);
    return seen;
}

TEST(Occlusion, OpenGroundSeesTheWholeSky) {
    for (const double seen : seen_from_above([](int, int) { return 100.0; }))
        EXPECT_GT(seen, 0.99);
    // An even slope hides nothing from itself.
    for (const double seen : seen_from_above([](int x, int) { return 100.0 + 3 * x; }))
        EXPECT_GT(seen, 0.97);
}

TEST(Occlusion, ATrenchSeesLessAndItsRimAllOfIt) {
    // 60 m deep and 100 m wide, in the middle of the picture.
    const std::vector<double> seen =
        seen_from_above([](int x, int) { return std::abs(x - 64) < 5 ? 40.0 : 100.0; });
    double least = 1;
    for (int x = 50; x < 78; ++x)
        least = std::min(least, seen[static_cast<std::size_t>(x)]);
    EXPECT_LT(least, 0.75);
    EXPECT_GT(seen[20], 0.98);
    EXPECT_GT(seen[108], 0.98);
}

}  // namespace
}  // namespace relevo::test_occlusion
