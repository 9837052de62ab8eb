#include <cmath>

#include <fmt/format.h>

#include "dem/load.h"
#include "effect/effect.h"
#include "render/drawn.h"
#include "support/support.h"

namespace relevo {
namespace {

constexpr int kSide_px = 256;

/// Linear light of a picture of one disc, with bloom or without.
/// @param radius_px  0: light all over
std::vector<double> light(double radius_px, double amount) {
    const std::string disc =
        radius_px > 0 ? fmt::format("length(p.at_px - vec2(128.0)) < {:.1f} ? 0.8 : 0.1", radius_px)
                      : "0.3";
    std::vector<effect::Effect> shipped;
    shipped.push_back(
        effect::load_effect(test::source_dir() / "plugins/bloom", test::source_dir() / "data"));
    // The sky as a screen, in radiance that is stored.
    test::Drawn drawn(
        dem::load((test::source_dir() / "data/dem/jacksboro.tif").string()),
        {{"screen1",
          "vec3 screen1_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
          "    Pixel p = Pixel(gl_FragCoord.xy, vec2(0.0), direction, 0.0, vec2(0.0));\n"
          "    return vec3(" +
              disc +
              ") / frame.exposure;\n"
              "}\n"
              "void screen1_on_tonemap(inout vec3 colour) { colour = colour * 1.0; }\n"}},
        kSide_px, kSide_px, 0, shipped, {{"bloom.amount", std::to_string(amount)}});
    drawn.stand(0.5, 0.5, 3000, 0, 80);
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
    const image::Image8 picture = drawn.renderer().read_output();
    std::vector<double> result;
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x) {
            const double srgb = picture.at(x, y, 1) / 255.0;
            result.push_back(srgb <= 0.04045 ? srgb / 12.92
                                             : std::pow((srgb + 0.055) / 1.055, 2.4));
        }
    return result;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

TEST(Bloom, SpreadsLightAndMakesNone) {
    for (const double radius_px : {6.0, 20.0, 40.0}) {
        const double before = mean(light(radius_px, 0)), after = mean(light(radius_px, 1));
        fmt::print("[ bloom ] a disc of {} px: {:.5f} of the light after as before\n", radius_px,
                   after / before);
        EXPECT_NEAR(after / before, 1, 0.005) << radius_px;
    }
}

TEST(Bloom, LeavesEvenLightAsItIs) {
    for (const double value : light(0, 1))
        EXPECT_NEAR(value, 0.3, 0.006);
}

TEST(Bloom, IsRoundAndFallsOutwards) {
    const std::vector<double> scattered = light(6, 1);
    const auto at = [&](int right, int up) {
        return scattered[static_cast<std::size_t>((128 - up) * kSide_px + 128 + right)];
    };
    for (const int r : {10, 20, 40}) {
        EXPECT_NEAR(at(r, 0), at(0, r), 0.01 + 0.1 * at(r, 0)) << r;
        EXPECT_NEAR(at(r, 0), at(-r, 0), 0.01 + 0.1 * at(r, 0)) << r;
        EXPECT_GT(at(r, 0) + 0.004, at(2 * r, 0)) << r;
    }
    EXPECT_GT(at(12, 0), 0.11);
}

}  // namespace
}  // namespace relevo
