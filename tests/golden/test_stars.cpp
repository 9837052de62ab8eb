#include <cmath>

#include <erfa.h>
#include <fmt/format.h>

#include "base/units.h"
#include "cli/program.h"
#include "golden/pinhole.h"
#include "golden/plain_sky.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_stars {
namespace {

constexpr double kLat_deg = 36.44, kLon_deg = -84.41, kHeight_m = 3000;

/// A star of the Hipparcos Catalogue (ESA 1997): J2000, yearly motion, V.
struct Star {
    const char* name;
    double ra_deg, dec_deg, pm_ra_arcsec, pm_dec_arcsec, magnitude;
};
constexpr Star kSirius{"Sirius", 101.28716, -16.71612, -0.54601, -1.22308, -1.44};
constexpr Star kVega{"Vega", 279.23473, 38.78369, 0.20102, 0.28746, 0.03};
constexpr Star kPolaris{"Polaris", 37.95456, 89.26411, 0.04422, -0.01174, 1.97};
constexpr Star kArcturus{"Arcturus", 213.91530, 19.18241, -1.09345, -1.99940, -0.05};

/// As ERFA sees it, through the air of the standard atmosphere 3000 m up.
Direction seen(const Star& star, const Moment& when) {
    double day1 = 0, day2 = 0;
    EXPECT_GE(
        eraDtf2d("UTC", when.year, when.month, when.day, when.hour, when.minute, 0, &day1, &day2),
        0);
    double azimuth = 0, zenith = 0, hour_angle, dec, ra, origins;
    EXPECT_GE(eraAtco13(radians(star.ra_deg), radians(star.dec_deg),
                        radians(star.pm_ra_arcsec / 3600) / std::cos(radians(star.dec_deg)),
                        radians(star.pm_dec_arcsec / 3600), 0, 0, day1, day2, 0, radians(kLon_deg),
                        radians(kLat_deg), kHeight_m, 0, 0, 701.1, -4.5, 0.5, 0.574, &azimuth,
                        &zenith, &hour_angle, &dec, &ra, &origins),
              0);
    return {degrees(azimuth), 90 - degrees(zenith)};
}

/// The same by the formulas of a textbook, within 0.02 degrees.
Direction seen_plainly(const Star& star, const Moment& when) {
    const double days = when.days(), years = days / 365.25;
    const Equatorial moved{
        star.ra_deg + years * star.pm_ra_arcsec / 3600 / std::cos(radians(star.dec_deg)),
        star.dec_deg + years * star.pm_dec_arcsec / 3600};
    return through_air(above_horizon(precessed(moved, days), days, {kLat_deg, kLon_deg}), 701.1,
                       -4.5);
}

bool there() {
    return std::filesystem::exists(source_dir() / "plugins/sky");
}

/// In linear light. High above the edge of the DEM, far from its centre, where the vertical is
/// another.
image::ImageF night(const std::filesystem::path& file, const std::string& time, double heading_deg,
                    double pitch_deg, double stars = 1) {
    const Result run = relevo({"-q",
                               "capture",
                               bundled_dem(),
                               "-o",
                               file.string(),
                               "--overwrite",
                               "--allow-blank",
                               "--only",
                               "sky",
                               "--size",
                               fmt::format("{}x{}", kWidth, kHeight),
                               "--time",
                               time,
                               "--eye",
                               fmt::format("{},{},{}", kLat_deg, kLon_deg, kHeight_m),
                               fmt::format("--heading={:.6f}", heading_deg),
                               fmt::format("--pitch={:.6f}", pitch_deg),
                               "--fov",
                               fmt::format("{}", kFov_deg),
                               "--set",
                               fmt::format("sky.stars={}", stars)});
    EXPECT_EQ(run.status, 0) << run.err;
    return image::read_float(file);
}

TEST(Stars, AreWithinAPixelOfWhereErfaSeesThem) {
    if (!there()) GTEST_SKIP() << "the plugin sky is not there";
    struct Case {
        Star star;
        Moment when;
        double right_deg, up_deg;  // of the camera's axis from the star
    };
    const std::filesystem::path file = scratch_dir("stars") / "sky.exr";
    for (const Case& c :
         {Case{kSirius, {2026, 1, 15, 4, 30}, 0, 0}, Case{kSirius, {2026, 1, 15, 7, 30}, 3, -2},
          Case{kSirius, {2026, 3, 1, 0, 30}, -4, 3}, Case{kVega, {2026, 7, 1, 3, 0}, -3, 2},
          Case{kVega, {2030, 10, 1, 5, 30}, 4, -3}, Case{kArcturus, {2026, 4, 20, 6, 0}, 2, 4},
          Case{kPolaris, {2026, 7, 1, 3, 0}, 0, 4}, Case{kPolaris, {2026, 1, 15, 4, 30}, -3, -3}}) {
        const Direction star = seen(c.star, c.when);
        const double heading = star.azimuth_deg + c.right_deg,
                     pitch = star.elevation_deg + c.up_deg;
        const image::ImageF picture = night(file, c.when.iso(), heading, pitch);
        int bright_x = 0, bright_y = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                if (picture.at(x, y, 1) > picture.at(bright_x, bright_y, 1)) {
                    bright_x = x;
                    bright_y = y;
                }
        // The middle of what is brighter than the sky around the brightest pixel.
        const double sky = picture.at(bright_x, std::max(bright_y - 20, 0), 1);
        double x_sum = 0, y_sum = 0, sum = 0;
        for (int y = std::max(bright_y - 3, 0); y <= std::min(bright_y + 3, kHeight - 1); ++y) {
            for (int x = std::max(bright_x - 3, 0); x <= std::min(bright_x + 3, kWidth - 1); ++x) {
                const double light = picture.at(x, y, 1) - sky;
                x_sum += light * (x + 0.5);
                y_sum += light * (y + 0.5);
                sum += light;
            }
        }
        const auto [x, y] = project(star, heading, pitch);
        fmt::print(
            "[ stars ] {} {}: azimuth {:.2f}, elevation {:.2f}: expected ({:.2f}, {:.2f}), found "
            "({:.2f}, {:.2f}) px\n",
            c.star.name, c.when.iso(), star.azimuth_deg, star.elevation_deg, x, y, x_sum / sum,
            y_sum / sum);
        EXPECT_NEAR(x_sum / sum, x, 0.5) << c.star.name;
        EXPECT_NEAR(y_sum / sum, y, 0.5) << c.star.name;
        const auto [plain_x, plain_y] = project(seen_plainly(c.star, c.when), heading, pitch);
        const double apart_deg =
            std::hypot(x_sum / sum - plain_x, y_sum / sum - plain_y) * kFov_deg / kHeight;
        EXPECT_LT(apart_deg, 0.05) << c.star.name << ", precessed by hand";
    }
}

TEST(Stars, ShedAsMuchLightAsTheirMagnitudeSays) {
    if (!there()) GTEST_SKIP() << "the plugin sky is not there";
    const std::filesystem::path file = scratch_dir("starlight") / "sky.exr";
    for (const auto& [star, when] : {std::pair{kSirius, Moment{2026, 1, 15, 4, 30}},
                                     std::pair{kVega, Moment{2026, 7, 1, 3, 0}}}) {
        const Direction at = seen(star, when);
        const image::ImageF with = night(file, when.iso(), at.azimuth_deg, at.elevation_deg),
                            without = night(file, when.iso(), at.azimuth_deg, at.elevation_deg, 0);
        const double px_rad = 2 * std::tan(radians(kFov_deg / 2)) / kHeight;
        double found = 0;  // radiance 1 is an irradiance of 1, shared out over pi
        for (int y = kHeight / 2 - 16; y < kHeight / 2 + 16; ++y)
            for (int x = kWidth / 2 - 16; x < kWidth / 2 + 16; ++x)
                found += (with.at(x, y, 1) - without.at(x, y, 1)) * px_rad * px_rad / kPi;
        // Both stars are of a B-V of 0: 1.006 of their light is what green shows. The air is the
        // daylight's (sun/daylight.h) at 550 nm.
        const double mass = std::exp(-kHeight_m / 8430) / std::sin(radians(at.elevation_deg));
        const double expected =
            1.006 * std::pow(10, -0.4 * (star.magnitude + 26.76)) * std::exp(-0.210 * mass);
        fmt::print("[ stars ] {}: {:.4g} of the sun's light, expected {:.4g}\n", star.name, found,
                   expected);
        EXPECT_NEAR(found / expected, 1, 0.05);
    }
}

}  // namespace
}  // namespace relevo::test::test_stars
