// Parts of the picture that plain programs draw: the parts themselves, and that none is plain which
// shows what plain programs lack.

#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "drawn.h"
#include "light/fields.h"
#include "render/picture_parts.h"
#include "render/plain_parts.h"
#include "render/wet_posts.h"

namespace relevo::render::test_plain_parts {
namespace {

using dem::WaterKind;
using test::Drawn;
using test::TestEffect;

std::mt19937 random_engine(7);

int random_below(int end) {
    return std::uniform_int_distribution(0, end - 1)(random_engine);
}

TEST(PictureParts, AreThePictureAndEachPixelOnce) {
    for (int i = 0; i < 200; ++i) {
        const int width = 1 + random_below(300), height = 1 + random_below(300);
        PictureParts parts(width, height);
        for (int marks = random_below(4); marks > 0; --marks) {
            const glm::dvec2 low(random_below(400) - 50, random_below(400) - 50);
            parts.mark(low, low + glm::dvec2(random_below(90), random_below(90)));
        }
        Array2d<int> drawn(width, height, 0);
        for (const bool whole : {false, true})
            for (const PixelRectangle& r : parts.rectangles(whole))
                for (int y = r.bottom; y < r.bottom + r.height; ++y)
                    for (int x = r.left; x < r.left + r.width; ++x) {
                        ASSERT_TRUE(x < width && y < height);
                        ++drawn.at(x, y);
                        ASSERT_EQ(
                            parts.is_whole(x / PictureParts::kSide_px, y / PictureParts::kSide_px),
                            whole);
                    }
        for (const int times : drawn)
            ASSERT_EQ(times, 1);
    }
}

TEST(PictureParts, AreWholeWhereARectangleTouchesThem) {
    PictureParts parts(100, 70);
    EXPECT_EQ(parts.rectangles(true).size(), 0U);
    EXPECT_EQ(parts.rectangles(false), (std::vector<PixelRectangle>{{0, 0, 100, 70}}));
    parts.mark({-1e300, 40}, {10, 40});
    EXPECT_EQ(parts.rectangles(true), (std::vector<PixelRectangle>{{0, 32, 32, 32}}));
    parts.mark({200, 0}, {300, 50});  // beside the picture
    parts.mark({0, -9}, {50, -1});
    EXPECT_EQ(parts.rectangles(true).size(), 1U);
    parts.mark({97, 69}, {1e300, 1e300});
    EXPECT_EQ(parts.rectangles(true),
              (std::vector<PixelRectangle>{{0, 32, 32, 32}, {96, 64, 4, 6}}));
    parts.mark_all();
    EXPECT_EQ(parts.rectangles(true), (std::vector<PixelRectangle>{{0, 0, 100, 70}}));
}

TEST(WetPosts, AreFoundInEachRectangle) {
    Array2d<WaterKind> kind(61, 40, WaterKind::None);
    for (int i = 0; i < 3; ++i)
        kind.at(random_below(61), random_below(40)) =
            i == 0 ? WaterKind::Lake : WaterKind::SeaFloor;
    const WetPosts wet(kind);
    int missed = 0, found = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::ivec2 first(random_below(100) - 20, random_below(80) - 20);
        const glm::ivec2 last = first + glm::ivec2(random_below(30), random_below(30));
        bool any = false;
        for (int row = std::max(first.y, 0); row <= std::min(last.y, 39); ++row)
            for (int column = std::max(first.x, 0); column <= std::min(last.x, 60); ++column)
                any = any || kind.at(column, row) != WaterKind::None;
        missed += any && !wet.any(first, last);
        found += wet.any(first, last);
    }
    EXPECT_EQ(missed, 0);
    EXPECT_LT(found, 15000);
}

/// Hills down to a sea with bays, so that its shore is long.
dem::Heightfield coast() {
    return test::field_of(
        513, 449, {500000, 60, 0, 5200000, 0, -60}, "EPSG:32632", [](int column, int row) {
            const double hills = 500 * std::sin(column * 0.021) * std::cos(row * 0.027) +
                                 400 * std::sin(0.19 * column + 0.11 * row);
            return std::max(hills + 6.0 * (column - 90), 0.0);
        });
}

/// Green in the whole program, and cyan in the plain one; red where that lacks something.
const TestEffect kTell{
    "tell",
    "//@ include lib/water.glsl\n"
    "void tell_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "#if HAS_water && HAS_near\n"
    "    radiance = vec3(0.0, 1.0, 0.0) / frame.exposure;\n"
    "#else\n"
    "    float side_m = sqrt(length(s.ground_dx_m) * length(s.ground_dy_m));\n"
    "    bool lacks = water_of(s).x > 0.0 || side_m < 24.0;\n"
    "    radiance = (lacks ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 1.0)) / frame.exposure;\n"
    "#endif\n"
    "}\n"};

struct Counts {
    int whole = 0, plain = 0, lacking = 0;
};

Counts counts_of(const image::ImageF& image) {
    Counts counts;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool green = image.at(x, y, 1) > 0, blue = image.at(x, y, 2) > 0;
            counts.lacking += image.at(x, y, 0) > 0;
            counts.whole += green && !blue;
            counts.plain += green && blue;
        }
    return counts;
}

TEST(PlainParts, ShowNeitherWaterNorNearGround) {
    Drawn drawn(coast(), {test::kBrightSky, kTell}, 224, 192, 2);
    Counts all;
    for (int i = 0; i < 100; ++i) {
        drawn.frame().exaggeration = i % 3 == 0 ? 2 : 1;
        const double height_m = 2500 * std::pow(10.0, random_below(100) / 120.0);
        drawn.stand(random_below(100) / 99.0, random_below(100) / 99.0, height_m, random_below(360),
                    -5 - random_below(45));
        const Counts counts = counts_of(drawn.radiance());
        const bool is_first = i == 0;  // one picture needs one program
        EXPECT_FALSE(is_first && counts.plain > 0);
        EXPECT_EQ(counts.lacking, 0) << "view " << i;
        all.whole += counts.whole;
        all.plain += counts.plain;
    }
    fmt::print("[ parts ] plain: {:.0f} % of the ground\n",
               100.0 * all.plain / (all.plain + all.whole));
    EXPECT_GT(all.plain, all.whole / 20);
}

TEST(PlainParts, AreNoneWhereEffectsFloodTheGround) {
    TestEffect flood = kTell;
    flood.displaces = effect::DisplaceSpec{.to = effect::DisplaceSpec::Length{.metres = 150}};
    Drawn drawn(coast(), {test::kBrightSky, flood}, 160, 128, 2);
    drawn.stand(0.5, 0.5, 9000, 0, -60);
    drawn.radiance();
    const Counts counts = counts_of(drawn.radiance());
    EXPECT_GT(counts.whole, 1000);
    EXPECT_EQ(counts.plain, 0);
}

}  // namespace
}  // namespace relevo::render::test_plain_parts
