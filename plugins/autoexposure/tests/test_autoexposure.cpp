#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dem/load.h"
#include "effect/effect.h"
#include "render/drawn.h"
#include "support/support.h"

namespace relevo::test_autoexposure {
namespace {

// Four pixels make one that is counted: the last column and row of these have fewer.
constexpr int kWidth_px = 130, kHeight_px = 98;
constexpr double kGrey = 0.18;

using Settings = std::vector<std::pair<std::string, std::string>>;

/// The luminance of a grey pixel before exposure, right and up [px].
using Screen = double (*)(double x, double y);

/// Tiles of a few pixels, from black to bright; and the same in GLSL.
double tiles(double x, double y) {
    const double tile = std::floor(x / 20) + 7 * std::floor(y / 14);
    return std::exp2(-9 + 0.31 * std::fmod(tile * 5, 37));
}
constexpr const char* kTiles =
    "exp2(-9.0 + 0.31 * mod(5.0 * (floor(gl_FragCoord.x / 20.0) + 7.0 * floor(gl_FragCoord.y / "
    "14.0)), 37.0))";

/// Stops by which the effect brightens a screen, as the picture shows them.
/// @param pitch_deg  of the camera: -80 shows ground alone
double stops(const std::string& screen, Screen light, const Settings& settings,
             double pitch_deg = -80) {
    std::vector<effect::Effect> shipped;
    shipped.push_back(effect::load_effect(test::source_dir() / "plugins/autoexposure",
                                          test::source_dir() / "data"));
    // The ground as a screen, in radiance that is stored; the sky is bright. The picture has them
    // scaled to be in range.
    test::Drawn drawn(dem::load((test::source_dir() / "data/dem/jacksboro.tif").string()),
                      {{"screen1",
                        "vec3 screen1_on_background_radiance(in vec3 direction, in bool disc) {\n"
                        "    return vec3(50.0) / frame.exposure;\n"
                        "}\n"
                        "void screen1_on_lit(in Surface s, inout vec3 radiance) {\n"
                        "    radiance = vec3(" +
                            screen +
                            ") / frame.exposure;\n"
                            "}\n"
                            "void screen1_on_tonemap(inout vec3 colour) { colour *= 0.25; }\n"}},
                      kWidth_px, kHeight_px, 0, shipped, settings);
    drawn.stand(0.5, 0.5, 3000, 0, pitch_deg);
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
    const image::Image8 picture = drawn.renderer().read_output();
    double before = 0, after = 0;
    for (int y = 0; y < kHeight_px; ++y)
        for (int x = 0; x < kWidth_px; ++x) {
            const double srgb = picture.at(x, kHeight_px - 1 - y, 1) / 255.0;
            if (srgb > 0.99 || srgb < 0.08) continue;  // clipped, or too dark for 8 bits
            before += 0.25 * light(x + 0.5, y + 0.5);
            after += std::pow((srgb + 0.055) / 1.055, 2.4);
        }
    return std::log2(after / before);
}

/// The same without a histogram: the mean of sorted logarithms.
double expected(Screen light, double low, double high) {
    std::vector<double> values;
    for (int y = 0; y < kHeight_px; y += 4)
        for (int x = 0; x < kWidth_px; x += 4) {
            double sum = 0;
            for (int k = 0; k < 16; ++k)
                sum += light(std::min(x + k % 4, kWidth_px - 1) + 0.5,
                             std::min(y + k / 4, kHeight_px - 1) + 0.5);
            values.push_back(std::log2(sum / 16));
        }
    std::ranges::sort(values);
    const auto index = [&](double share) {
        return static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size())));
    };
    double sum = 0;
    for (std::size_t i = index(low); i < index(high); ++i)
        sum += values[i];
    return std::log2(kGrey) - sum / static_cast<double>(index(high) - index(low));
}

TEST(Autoexposure, IsTheLogAverageOfThePixelsThatCount) {
    for (const auto& [low, high] : {std::pair(0.0, 1.0), {0.1, 0.95}, {0.4, 0.6}}) {
        const double found = stops(kTiles, tiles,
                                   {{"autoexposure.low", fmt::format("{}", low)},
                                    {"autoexposure.high", fmt::format("{}", high)},
                                    {"autoexposure.limit", "12"}});
        fmt::print("[ autoexposure ] pixels from {} to {}: {:.3f} EV, by the processor {:.3f}\n",
                   low, high, found, expected(tiles, low, high));
        EXPECT_NEAR(found, expected(tiles, low, high), 0.03) << low << ' ' << high;
    }
}

TEST(Autoexposure, EvenLightBecomesMiddleGrey) {
    const auto dim = [](double, double) { return 0.02; };
    const auto bright = [](double, double) { return 1.3; };
    // Half a bin, an eighth of a stop, and 8 bits.
    EXPECT_NEAR(stops("0.02", dim, {}), std::log2(kGrey / 0.02), 0.07);
    EXPECT_NEAR(stops("1.3", bright, {}), std::log2(kGrey / 1.3), 0.07);
}

TEST(Autoexposure, TheSkyDoesNotCount) {
    const auto dim = [](double, double) { return 0.02; };
    EXPECT_NEAR(stops("0.02", dim, {}, -5), std::log2(kGrey / 0.02), 0.07);
}

TEST(Autoexposure, KeepsItsLimitAmountAndCompensation) {
    const auto dim = [](double, double) { return 0.02; };
    const double all = std::log2(kGrey / 0.02);
    EXPECT_NEAR(stops("0.02", dim, {{"autoexposure.limit", "2"}}), 2, 0.03);
    EXPECT_NEAR(stops("0.02", dim, {{"autoexposure.amount", "0.8"}}), 0.8 * all, 0.07);
    EXPECT_NEAR(
        stops("0.02", dim, {{"autoexposure.limit", "2"}, {"autoexposure.compensation", "1.5"}}),
        3.5, 0.03);
    EXPECT_NEAR(stops("0.1", [](double, double) { return 0.1; },
                      {{"autoexposure.low", "0.9"}, {"autoexposure.high", "0.2"}}),
                0, 0.03)
        << "no pixel counts";
}

}  // namespace
}  // namespace relevo::test_autoexposure
