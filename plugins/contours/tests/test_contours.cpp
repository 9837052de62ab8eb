#include <cmath>

#include <fmt/format.h>

#include "../levels.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_contours {
namespace {

/// Coverage of 400 pixels of a slope that climbs by a height a pixel, from a height.
std::vector<glm::vec4> slope(double from_m, double step_m, double interval_m, double width_px) {
    test::GpuSnippet gpu("contours");
    return gpu.run(fmt::format("float h = {:.9f} + float(x) * {:.9f};\n"
                               "result = vec4(contours_line(h, {:.9f}, {:.9f}, {:.9f}));",
                               from_m, step_m, step_m, interval_m, width_px),
                   400, 1);
}

TEST(Contours, AreAsWideAsAskedOnAnySlope) {
    for (const double step_m : {0.01, 0.1, 1.0, 7.0})
        for (const double width_px : {0.7, 1.0, 1.5, 4.0}) {
            const double interval_m = 50 * step_m;
            double sum = 0;
            for (const glm::vec4& pixel : slope(0.3 * interval_m, step_m, interval_m, width_px))
                sum += pixel.x;
            // Eight lines in 400 pixels.
            EXPECT_NEAR(sum / 8, width_px, 0.02 * width_px + 0.02) << step_m << ' ' << width_px;
        }
}

TEST(Contours, LevelGroundAtTheHeightOfALineIsNotFilled) {
    for (const glm::vec4& pixel : slope(500, 0, 50, 1.2))
        EXPECT_EQ(pixel.x, 0);
    // Floats of a height of 500 m cannot tell this slope from none.
    for (const glm::vec4& pixel : slope(500, 1e-5, 50, 1.2))
        EXPECT_EQ(pixel.x, 0);
}

TEST(Contours, FadeWhereTheyWouldCoverTheGround) {
    for (const glm::vec4& pixel : slope(3, 20, 50, 1.2))  // 2.5 pixels apart
        EXPECT_EQ(pixel.x, 0);
}

TEST(Contours, DivideTheReliefByARoundNumber) {
    test::GpuSnippet gpu("contours");
    for (const auto& [relief_m, interval_m] :
         {std::pair(840.0, 50.0), {4392.0, 200.0}, {120.0, 5.0}, {9.0, 0.5}, {20000.0, 1000.0}}) {
        gpu.frame().height_range = {0, 1 / relief_m, 1, 0};
        EXPECT_NEAR(gpu.run("result = vec4(contours_interval());", 1, 1)[0].x, interval_m,
                    1e-3 * interval_m)
            << relief_m;
        // The module has the same lines.
        EXPECT_NEAR(contours::interval(0, relief_m), interval_m, 1e-9 * interval_m) << relief_m;
    }
    EXPECT_EQ(contours::interval(30.48, 840), 30.48);
}

TEST(Contours, HeightsAreWrittenWithTheDecimalsThatTheyNeed) {
    EXPECT_EQ(contours::text_of(1200, 100), "1200 m");
    EXPECT_EQ(contours::text_of(2.5, 2.5), "2.5 m");
    EXPECT_EQ(contours::text_of(5, 2.5), "5.0 m");
    EXPECT_EQ(contours::text_of(152.4, 152.4), "152.4 m");
    EXPECT_EQ(contours::text_of(0.3, 0.1), "0.3 m");
    EXPECT_EQ(contours::text_of(100.0 / 3, 100.0 / 3), "33.333 m");
}

}  // namespace
}  // namespace relevo::test_contours
