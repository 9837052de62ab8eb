#include <cmath>

#include <fmt/format.h>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_tracks {
namespace {

/// Sum of the coverage of 200 pixels across a line, in pixels.
double width_px(test::GpuSnippet& gpu, double metres_a_pixel, double edge_px) {
    double sum = 0;
    const std::string body = fmt::format(
        "float away = abs(float(x) - 100.3);\n"
        "LineHit hit = LineHit(away, 0.0, 0.0, 0, away * {0:.9f}, {0:.9f}, {0:.9f});\n"
        "result = vec4(tracks_cover(hit, {1:.9f}));",
        metres_a_pixel, edge_px);
    for (const glm::vec4& pixel : gpu.run(body, 200, 1))
        sum += pixel.x;
    return sum;
}

TEST(Tracks, HaveTheWidthOfPixelsOrOfMetresWhicheverIsMore) {
    test::GpuSnippet gpu("tracks");
    for (const double width : {0.5, 1.0, 2.5, 10.0}) {
        gpu.values().set("tracks.width_px", fmt::format("{}", width));
        EXPECT_NEAR(width_px(gpu, 3, 0), width, 0.02 * width + 0.02);
        EXPECT_NEAR(width_px(gpu, 3, 2), width + 4, 0.02 * width + 0.1);
    }
    gpu.values().set("tracks.width_px", "1");
    gpu.values().set("tracks.width_m", "30");
    EXPECT_NEAR(width_px(gpu, 2, 0), 15, 0.05);
    EXPECT_NEAR(width_px(gpu, 0.5, 0), 60, 0.1);
    EXPECT_NEAR(width_px(gpu, 100, 0), 1, 0.05);
}

TEST(Tracks, DashesAndGapsAreEquallyLong) {
    test::GpuSnippet gpu("tracks");
    gpu.values().set("tracks.dash_m", "50");
    for (const double step_m : {0.7, 3.0, 20.0, 49.0, 400.0}) {
        double sum = 0;
        const std::string body = fmt::format(
            "LineHit hit = LineHit(0.0, float(x) * {0:.9f}, 0.0, 0, 0.0, {0:.9f}, {0:.9f});\n"
            "result = vec4(tracks_dash(hit));",
            step_m);
        for (const glm::vec4& pixel : gpu.run(body, 1000, 1))
            sum += pixel.x;
        EXPECT_NEAR(sum / 1000, 0.5, 0.04) << step_m;
    }
}

TEST(Tracks, ColoursAreThoseOfTheRamp) {
    test::GpuSnippet gpu("tracks");
    gpu.values().set("tracks.from", "10");
    gpu.values().set("tracks.to", "50");
    const auto colours = gpu.run("result = vec4(tracks_by_value(float(x) * 10.0), 1.0);", 7, 1);
    EXPECT_NEAR(colours[1].x, 0.27, 1e-3);
    EXPECT_NEAR(colours[3].y, 0.57, 1e-3);
    EXPECT_NEAR(colours[5].x, 0.99, 1e-3);
    EXPECT_EQ(colours[0], colours[1]);
    EXPECT_EQ(colours[6], colours[5]);
}

}  // namespace
}  // namespace relevo::test_tracks
