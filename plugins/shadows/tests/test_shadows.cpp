#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "light/fields.h"
#include "support/gpu_snippet.h"
#include "support/shadow_truth.h"

namespace relevo::shadow::test_shadows {
namespace {

dem::Heightfield bundled() {
    return dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
}

/// Heights at the posts of a UTM grid, 30 m apart.
dem::Heightfield ground(int columns, int rows, const std::function<double(int, int)>& height_m) {
    Array2d<float> heights(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            heights.at(x, y) = static_cast<float>(height_m(x, y));
    dem::Description about;
    about.statistics = dem::statistics(heights);
    return {std::move(heights),
            dem::Grid(columns, rows, {400000, 30, 0, 5000000, 0, -30},
                      geo::Crs::parse("EPSG:32631", "test")),
            about};
}

Drawn drawn_of(const dem::Heightfield& dem, const std::string& scratch,
               glm::ivec2 size = glm::ivec2(0)) {
    return Drawn(dem, test::scratch_dir(scratch), {}, 2, size, "shadows");
}

TEST(Shadows, AtThePostsTheyAreThoseOfRays) {
    const dem::Heightfield dem = bundled();
    Drawn drawn = drawn_of(dem, "shadows_posts");
    const Truth truth(dem, drawn.ground().frame);
    for (const glm::dvec2 sun : {glm::dvec2(2, 200), {5, 315}, {20, 90}}) {
        const glm::dvec3 to_sun = direction(sun.y, sun.x);
        const Truth::Mask mask = truth.cast(to_sun);
        const AtPosts at = at_posts_themselves(drawn, truth, to_sun);
        const Score s =
            score(truth, mask, at.lit, drawn.texel_m(), to_sun, drawn.spacing_m(), &at.shown);
        fmt::print(
            "[ shadow ] sun at {} degrees from {}: {:.1f} % shaded, balanced accuracy {:.2f} %\n",
            sun.x, sun.y, 100 * s.shaded_share, 100 * s.balanced);
        EXPECT_GT(s.shaded_share, 0.01);
        EXPECT_GE(s.balanced, 0.99);
    }
}

TEST(Shadows, OfAWholePictureTheyAreThoseOfRaysOverTheSamePosts) {
    const dem::Heightfield dem = bundled();
    Drawn drawn = drawn_of(dem, "shadows_whole");
    const Truth truth(dem, drawn.ground().frame);
    for (const glm::dvec2 sun : {glm::dvec2(2, 0), {10, 225}, {60, 45}}) {
        const glm::dvec3 to_sun = direction(sun.y, sun.x);
        const Array2d<float> lit = drawn.at_posts(to_sun, truth.posts());
        const Score s =
            score(truth, truth.cast(to_sun), lit, drawn.texel_m(), to_sun, drawn.spacing_m());
        EXPECT_GE(s.lit_right, 0.99) << sun.x;
        if (s.shaded_share > 0.01) {
            EXPECT_GE(s.balanced, 0.99) << sun.x;
        }
        EXPECT_GE(s.beyond, 0.999) << sun.x;
    }
}

TEST(Shadows, InThePenumbraTheyAreThePartOfTheDiscThatIsSeen) {
    const dem::Heightfield dem = bundled();
    Drawn drawn = drawn_of(dem, "shadows_penumbra");
    drawn.semidiameter_rad() = kSunRadius_rad;
    const Truth truth(dem, drawn.ground().frame);
    for (const auto& [elevation_deg, limit] : {std::pair(2.0, 0.05), {10.0, 0.05}}) {
        const glm::dvec3 to_sun = direction(200, elevation_deg);
        const AtPosts at = at_posts_themselves(drawn, truth, to_sun);
        const Penumbra p = penumbra(truth, at.lit, at.shown, to_sun);
        fmt::print(
            "[ shadow ] {} posts in the penumbra: off by {:+.3f} in the mean, by {:.3f} in size\n",
            p.posts, p.mean, p.mean_size);
        EXPECT_GT(p.posts, 100);
        EXPECT_LT(std::abs(p.mean), limit);
        EXPECT_LT(p.mean_size, limit + 0.04);
    }
}

TEST(Shadows, APictureOfFewPixelsHasTheLightOfAFineOne) {
    const dem::Heightfield dem = bundled();
    std::vector<double> means;
    for (const glm::ivec2 size : {glm::ivec2(100, 86), {1600, 1376}}) {
        Drawn drawn = drawn_of(dem, "shadows_far", size);
        double sum = 0, pixels = 0;
        for (const float share : drawn.picture(direction(225, 10)))
            if (!std::isnan(share)) {
                sum += double{share};
                ++pixels;
            }
        means.push_back(sum / pixels);
    }
    EXPECT_NEAR(means[0], means[1], 0.01);
    EXPECT_LT(means[1], 0.9);
}

TEST(Shadows, LevelGroundBesideHolesIsLit) {
    const dem::Heightfield dem = ground(
        60, 60, [](int x, int y) { return (x / 7 + y / 5) % 5 == 0 ? std::nan("") : 100.0; });
    Drawn drawn = drawn_of(dem, "shadows_holes", {480, 480});
    for (const double elevation : {3.0, 30.0})
        for (const float lit : drawn.picture(direction(130, elevation)))
            if (!std::isnan(lit)) {
                ASSERT_GT(lit, 0.999f);
            }
}

TEST(Shadows, AWallShadesAsFarAsItsTangent) {
    // 60 m high, to the east of posts that are level: 60 / tan(10) = 340 m.
    const dem::Heightfield dem = ground(60, 9, [](int x, int) { return x == 40 ? 160.0 : 100.0; });
    Drawn drawn = drawn_of(dem, "shadows_wall", {1200, 180});
    const Truth truth(dem, drawn.ground().frame);
    const Array2d<float> lit = drawn.at_posts(direction(90, 10), truth.posts());
    for (int x = 3; x < 57; ++x) {
        if (x >= 39 && x <= 41) continue;  // the wall's own sides
        const double away_m = (40 - x) * 30;
        if (std::abs(away_m - 340) < 35) continue;
        EXPECT_NEAR(lit.at(x, 4), away_m > 0 && away_m < 340 ? 0 : 1, 0.02) << x;
    }
}

TEST(Shadows, AreTheSameWhicheverWayTheGroundIsTurned) {
    // Hills with edges, and the same turned clockwise by quarters with their sun: between posts the
    // light is mixed along the rays, whether the sweep goes by rows or by columns.
    constexpr int kSide = 97, kPixels = 776;
    const auto hill_m = [](int x, int y) {
        return 100 + 40 * std::sin(0.31 * x + 0.1 * y) * std::cos(0.23 * y) +
               ((x / 11 + y / 17) % 5 == 0 ? 25.0 : 0.0);
    };
    std::vector<Array2d<float>> pictures;
    for (int turns = 0; turns < 4; ++turns) {
        const dem::Heightfield dem = test::field_of(kSide, kSide, {498560, 30, 0, 1440, 0, -30},
                                                    "EPSG:32631", [&](int x, int y) {
                                                        glm::ivec2 at(x, y);
                                                        for (int k = 0; k < turns; ++k)
                                                            at = {at.y, kSide - 1 - at.x};
                                                        return hill_m(at.x, at.y);
                                                    });
        Drawn drawn = drawn_of(dem, "shadows_turned", {kPixels, kPixels});
        drawn.semidiameter_rad() = kSunRadius_rad;
        pictures.push_back(drawn.picture(direction(70 + 90 * turns, 9)));
    }
    for (int turns = 1; turns < 4; ++turns) {
        int compared = 0, partly = 0;
        double off = 0;
        for (int y = 0; y < kPixels; ++y)
            for (int x = 0; x < kPixels; ++x) {
                glm::ivec2 at(x, y);
                for (int k = 0; k < turns; ++k)
                    at = {kPixels - 1 - at.y, at.x};
                const float first = pictures[0].at(x, y), turned = pictures[turns].at(at.x, at.y);
                if (std::isnan(first) || std::isnan(turned)) continue;
                ++compared;
                partly += first > 0.02f && first < 0.98f;
                off += std::abs(first - turned);
            }
        fmt::print("[ shadow ] turned by {} degrees: off by {:.5f} in the mean of {} pixels\n",
                   90 * turns, off / compared, compared);
        EXPECT_GT(compared, 300000);
        EXPECT_GT(partly, 10000);
        EXPECT_LT(off / compared, 0.0005);
    }
}

TEST(Shadows, TheShareOfADiscIsThatOfItsSegment) {
    test::GpuSnippet gpu("", "lib/sun_share.glsl");
    const auto results = gpu.run("result = vec4(sun_disc_share(float(x) / 400.0));", 401, 1);
    double worst = 0;
    for (int x = 0; x <= 400; ++x) {
        const double below = 1 - x / 200.0;
        const double share = (std::acos(below) - below * std::sqrt(1 - below * below)) / kPi;
        worst = std::max(worst, std::abs(double{results[static_cast<std::size_t>(x)].x} - share));
    }
    EXPECT_LT(worst, 0.002);
}

}  // namespace
}  // namespace relevo::shadow::test_shadows
