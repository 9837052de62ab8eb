#include <cmath>

#include <fmt/format.h>

#include "dem/load.h"
#include "effect/effect.h"
#include "render/drawn.h"
#include "support/support.h"

namespace relevo::test_bloom {
namespace {

constexpr int kSide_px = 256;

struct Disc {
    double radius_px = 0;  // 0: light all over
    double radiance = 0.8;
    double around = 0.1;
};

/// Linear light of a picture of one disc, and the angle between its pixels.
struct Picture {
    std::vector<double> light;
    double pixel_deg = 0;
};

Picture draw(const Disc& drawn_disc, double amount) {
    const std::string disc =
        drawn_disc.radius_px > 0
            ? fmt::format("length(p.at_px - vec2(128.0)) < {:.1f} ? {:.4f} : {:.4f}",
                          drawn_disc.radius_px, drawn_disc.radiance, drawn_disc.around)
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
    Picture result;
    result.pixel_deg =
        glm::degrees(2 * std::tan(glm::radians(0.5 * test::Drawn::kFov_deg)) / kSide_px);
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x) {
            const double srgb = picture.at(x, y, 1) / 255.0;
            result.light.push_back(srgb <= 0.04045 ? srgb / 12.92
                                                   : std::pow((srgb + 0.055) / 1.055, 2.4));
        }
    return result;
}

std::vector<double> light(double radius_px, double amount) {
    return draw({radius_px}, amount).light;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

TEST(Bloom, SpreadsLightAndMakesNone) {
    for (const double radius_px : {6.0, 20.0, 40.0}) {
        const double before = mean(light(radius_px, 0)), after = mean(light(radius_px, 3));
        fmt::print("[ bloom ] a disc of {} px: {:.5f} of the light after as before\n", radius_px,
                   after / before);
        EXPECT_NEAR(after / before, 1, 0.005) << radius_px;
    }
}

TEST(Bloom, LeavesEvenLightAsItIs) {
    for (const double value : light(0, 3))
        EXPECT_NEAR(value, 0.3, 0.006);
}

TEST(Bloom, IsRoundAndFallsOutwards) {
    const std::vector<double> scattered = draw({6, 8, 0.1}, 3).light;
    const auto at = [&](int right, int up) {
        return scattered[static_cast<std::size_t>((128 - up) * kSide_px + 128 + right)];
    };
    for (const int r : {10, 20, 40}) {  // the disc's centre is the corner of four pixels
        EXPECT_NEAR(at(r, 0), at(0, r + 1), 0.03 * at(r, 0)) << r;
        EXPECT_NEAR(at(r, 0), at(-r - 1, 0), 0.03 * at(r, 0)) << r;
        EXPECT_GT(at(r, 0) + 0.004, at(2 * r, 0)) << r;
    }
    EXPECT_GT(at(12, 0), 0.11);
}

/// The veil of a source that gives the eye 1 lx [cd/m2], at an angle from it; age 30 years.
double stiles_holladay(double angle_deg) {
    return 10 / std::pow(angle_deg, 3) + 5 / std::pow(angle_deg, 2) * (1 + std::pow(30 / 62.5, 4));
}

TEST(Bloom, IsTheVeilOfTheEye) {
    const Disc sun{2, 60, 0};
    const Picture picture = draw(sun, 1);
    double disc_px = 0;
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x)
            disc_px += std::hypot(x + 0.5 - 128, y + 0.5 - 128) < sun.radius_px ? 1 : 0;
    const double pixel_sr = std::pow(glm::radians(picture.pixel_deg), 2);
    const double at_eye_lx = sun.radiance * disc_px * pixel_sr;
    for (const int away_px : {10, 15, 20, 30, 40}) {
        const double seen = picture.light[static_cast<std::size_t>(128 * kSide_px + 128 + away_px)];
        const double expected = at_eye_lx * stiles_holladay((away_px + 0.5) * picture.pixel_deg);
        fmt::print("[ bloom ] {:.2f} degrees from a disc: {:.4f}, by CIE {:.4f}\n",
                   (away_px + 0.5) * picture.pixel_deg, seen, expected);
        EXPECT_NEAR(seen / expected, 1, 0.15) << away_px;
    }
}

}  // namespace
}  // namespace relevo::test_bloom
