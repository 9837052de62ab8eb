#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "cli/program.h"
#include "dem/fixture.h"
#include "golden/pinhole.h"
#include "golden/plain_sky.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_moon_disc {
namespace {

constexpr Site kSite{29, -81};
constexpr double kPx_deg = kFov_deg / kHeight;  // in the middle, within 0.4 %

glm::dvec3 vector_of(const Direction& to) {
    const double a = radians(to.azimuth_deg), e = radians(to.elevation_deg);
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

/// From the moon on the way to the sun, so far that a camera at the moon sees it.
Direction towards(const Direction& moon, const Direction& sun) {
    const glm::dvec3 m = vector_of(moon), s = vector_of(sun);
    const glm::dvec3 at = m + 0.01 * normalize(s - dot(s, m) * m);
    return {degrees(std::atan2(at.x, at.y)), degrees(std::asin(normalize(at).z))};
}

/// Low hills whose middle is the place of the published rows.
std::string hills(const std::filesystem::path& folder) {
    return write_raster(
        folder / "hills.tif",
        {.columns = 20,
         .rows = 20,
         .geotransform = {{kSite.lon_deg - 0.01, 0.001, 0, kSite.lat_deg + 0.01, 0, -0.001}},
         .crs = "EPSG:4326",
         .value = [](int column, int row, int) { return (column + row) % 3; }});
}

/// The disc of a crescent in a picture: its dark side shines in the light of the Earth, brighter
/// than the sky.
struct Disc {
    glm::dvec2 middle{0}, light{0};  ///< of all of it, and of its radiance [px]
    double width_deg = 0;
};

Disc disc_in(const image::ImageF& picture) {
    glm::ivec2 brightest(0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            if (picture.at(x, y, 1) > picture.at(brightest.x, brightest.y, 1)) brightest = {x, y};
    const double sky = picture.at(brightest.x, std::clamp(brightest.y - 60, 0, kHeight - 1), 1);
    constexpr int kReach = 26;  // more than its width
    Disc disc;
    double count = 0, sum = 0;
    for (int y = brightest.y - kReach; y <= brightest.y + kReach; ++y)
        for (int x = brightest.x - kReach; x <= brightest.x + kReach; ++x) {
            if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
            const double light = picture.at(x, y, 1);
            if (light < 3 * sky) continue;
            disc.middle += glm::dvec2(x + 0.5, y + 0.5);
            disc.light += light * glm::dvec2(x + 0.5, y + 0.5);
            ++count;
            sum += light;
        }
    disc.middle /= count;
    disc.light /= sum;
    disc.width_deg = 2 * std::sqrt(count / kPi) * kPx_deg;
    return disc;
}

TEST(MoonDisc, StandsWhereHorizonsHasItAndIsLitFromTheSunsSide) {
    if (!std::filesystem::exists(source_dir() / "plugins/sky"))
        GTEST_SKIP() << "the plugin sky is not there";
    struct Case {
        Moment when;
        Direction moon;            // JPL Horizons (2019), 29 N 81 W, with its refraction
        double right_deg, up_deg;  // of the camera's axis from the moon
    };
    const std::filesystem::path folder = scratch_dir("moon_disc"), file = folder / "sky.exr";
    const std::string dem = hills(folder);
    for (const Case& c : {Case{{2036, 11, 23, 0, 0}, {223.5946, 27.3082}, 2, -3},
                          Case{{2018, 12, 2, 10, 0}, {110.7031, 32.0767}, -3, 2},
                          Case{{2024, 11, 6, 0, 0}, {223.8825, 14.6921}, 0, 0}}) {
        const double heading = c.moon.azimuth_deg + c.right_deg,
                     pitch = c.moon.elevation_deg + c.up_deg;
        const Result run =
            relevo({"-q", "capture", dem, "-o", file.string(), "--overwrite", "--allow-blank",
                    "--only", "sky", "--size", fmt::format("{}x{}", kWidth, kHeight), "--time",
                    c.when.iso(), "--eye", fmt::format("{},{},10", kSite.lat_deg, kSite.lon_deg),
                    fmt::format("--heading={:.6f}", heading), fmt::format("--pitch={:.6f}", pitch),
                    "--fov", fmt::format("{}", kFov_deg)});
        ASSERT_EQ(run.status, 0) << run.err;
        const Disc disc = disc_in(image::read_float(file));
        const auto at = [&](const Direction& to) {
            const auto [x, y] = project(to, heading, pitch);
            return glm::dvec2(x, y);
        };
        const double apart_deg = distance(disc.middle, at(c.moon)) * kPx_deg;
        const double days = c.when.days();
        const Direction sun = above_horizon(plain_sun(days), days, kSite);
        const glm::dvec2 lit = normalize(disc.light - disc.middle),
                         to_sun = normalize(at(towards(c.moon, sun)) - at(c.moon));
        const double turned_deg = degrees(std::acos(std::min(dot(lit, to_sun), 1.0)));
        fmt::print(
            "[ moon disc ] {}: {:.4f} degrees from its place, {:.3f} wide, lit {:.1f} degrees "
            "off the sun's side\n",
            c.when.iso(), apart_deg, disc.width_deg, turned_deg);
        EXPECT_LT(apart_deg, 0.02) << c.when.iso();
        EXPECT_NEAR(disc.width_deg, 0.52, 0.04) << c.when.iso();
        EXPECT_LT(turned_deg, 10) << c.when.iso();
    }
}

}  // namespace
}  // namespace relevo::test::test_moon_disc
