#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "cli/program.h"
#include "golden/pinhole.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_sun_disc {
namespace {

struct Sun {
    double azimuth_deg, apparent_elevation_deg, semidiameter_deg;
};

Sun sun_at(const std::string& place, const std::string& time) {
    const Result run = relevo({"sun", "position", "--at", place, "--time", time, "--json"});
    const auto json = nlohmann::json::parse(run.out);
    return {json["azimuth_deg"], json["apparent_elevation_deg"], json["semidiameter_deg"]};
}

TEST(SunDisc, IsWhereTheSunIsAndOfItsSize) {
    if (!std::filesystem::exists(source_dir() / "plugins/sky"))
        GTEST_SKIP() << "the plugin sky is not there";
    struct Case {
        const char* time;
        double right_deg, up_deg;  // of the camera's axis from the sun
    };
    const std::filesystem::path file = scratch_dir("sun_disc") / "sky.exr";
    for (const Case& c : {Case{"2026-06-21T17:00Z", 0, 0}, Case{"2026-06-21T23:30Z", 3, -2},
                          Case{"2026-06-22T00:20Z", -3, 2}, Case{"2026-12-21T15:00Z", 4, 3},
                          Case{"2026-03-20T12:30Z", -4, -3}}) {
        // High above the edge of the DEM, so that no mountain is before it, and far from the DEM's
        // centre, so that the vertical there is another.
        const Sun sun = sun_at("36.44,-84.41,3000", c.time);
        const double heading = sun.azimuth_deg + c.right_deg,
                     pitch = sun.apparent_elevation_deg + c.up_deg;
        const Result run = relevo(
            {"-q", "capture", bundled_dem(), "-o", file.string(), "--overwrite", "--allow-blank",
             "--only", "sky", "--size", fmt::format("{}x{}", kWidth, kHeight), "--time", c.time,
             "--eye", "36.44,-84.41,3000", fmt::format("--heading={:.6f}", heading),
             fmt::format("--pitch={:.6f}", pitch), "--fov", fmt::format("{}", kFov_deg)});
        ASSERT_EQ(run.status, 0) << run.err;
        const image::ImageF picture = image::read_float(file);
        float brightest = 0;
        for (const float value : picture.values)
            brightest = std::max(brightest, value);
        double x_sum = 0, y_sum = 0, n = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                if (picture.at(x, y, 0) < 0.5f * brightest) continue;
                x_sum += x + 0.5;
                y_sum += y + 0.5;
                ++n;
            }
        }
        const auto [x, y] = project({sun.azimuth_deg, sun.apparent_elevation_deg}, heading, pitch);
        const double px_deg = degrees(2 * std::tan(radians(kFov_deg / 2)) / kHeight);
        // As wide as a round disc of as many pixels; the picture stretches what is off its axis.
        const double width_deg = 2 * std::sqrt(n / kPi) * px_deg;
        fmt::print(
            "[ sun disc ] {}: expected ({:.2f}, {:.2f}), found ({:.2f}, {:.2f}) px, {:.3f} degrees "
            "wide, the sun {:.3f}\n",
            c.time, x, y, x_sum / n, y_sum / n, width_deg, 2 * sun.semidiameter_deg);
        EXPECT_NEAR(x_sum / n, x, 1) << c.time;
        EXPECT_NEAR(y_sum / n, y, 1) << c.time;
        EXPECT_NEAR(width_deg, 0.53, 0.02) << c.time;
    }
}

}  // namespace
}  // namespace relevo::test::test_sun_disc
