// DEMs that go round the Earth: their first column follows on the last one.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/ground_at.h"
#include "light/point/horizon.h"
#include "light/point/light_along.h"
#include "light/raster/clearance.h"
#include "light/raster/horizons.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light::test_round_earth {
namespace {

constexpr int kColumns = 4320, kRows = 48;  // five minutes from post to post
constexpr double kStep_deg = 360.0 / kColumns, kNorth_deg = 48;

/// Hills and a steep ridge at 180 degrees, on a grid that begins at some longitude.
dem::Heightfield ridge_from(double west_deg, int columns = kColumns) {
    return test::field_of(columns, kRows, {west_deg, kStep_deg, 0, kNorth_deg, 0, -kStep_deg},
                          "EPSG:4326", [&](int column, int row) {
                              const double lon = radians(west_deg + column * kStep_deg);
                              const double hills = 1500 + 900 * std::sin(180 * lon + row / 3.0);
                              const bool is_ridge = std::cos(lon) < std::cos(radians(179.95));
                              return is_ridge ? 6500 : hills;
                          });
}

TEST(RoundTheEarth, AHorizonGoesOnAcrossTheFirstColumn) {
    const dem::Heightfield split = ridge_from(-180), whole = ridge_from(0);
    for (const double lon_deg : {179.9, 179.99, -179.9, -178.3, 0.1, 12.0}) {
        const geo::Geodetic place = geo::geodetic_deg(46, lon_deg, 0);
        const TerrainHorizon a(split, place), b(whole, place);
        EXPECT_NEAR(a.place().lon_rad, b.place().lon_rad, 1e-9) << lon_deg;
        for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 15) {
            const HorizonPoint p = a.at(radians(azimuth_deg)), q = b.at(radians(azimuth_deg));
            EXPECT_NEAR(degrees(p.elevation_rad), degrees(q.elevation_rad), 1e-6)
                << lon_deg << " " << azimuth_deg;
            if (std::isnan(q.distance_m)) continue;
            EXPECT_NEAR(p.distance_m, q.distance_m, 0.01) << lon_deg << " " << azimuth_deg;
            EXPECT_GE(p.post.x, 0);
            EXPECT_LT(p.post.x, kColumns);
            EXPECT_NEAR(std::remainder(a.place_of(p).lon_rad - b.place_of(q).lon_rad, 2 * kPi), 0,
                        1e-9);
        }
    }
    // It was level, as if nothing stood there.
    const TerrainHorizon beside(split, geo::geodetic_deg(46, 179.9, 0));
    EXPECT_GT(degrees(beside.elevation_rad(radians(90))), 6);
}

TEST(RoundTheEarth, APlaceBetweenTheLastColumnAndTheFirstHasAHorizon) {
    const dem::Heightfield field = ridge_from(-180 + kStep_deg / 2);
    const TerrainHorizon at(field, geo::geodetic_deg(46.1, 180, 0));
    EXPECT_GT(at.eye_m(), 600);
}

/// Posts at 180 degrees, where the one grid begins and the other one has its middle.
constexpr int kBeside = 24;
constexpr Window kLast{kColumns - kBeside, 0, kBeside, kRows}, kFirst{0, 0, kBeside, kRows},
    kMiddle{kColumns / 2 - kBeside, 0, 2 * kBeside, kRows};

/// How many of the values before 180 degrees and after differ by more than that from those of the
/// grid that has it in its middle.
int differ(const Array2d<float>& before, const Array2d<float>& after, const Array2d<float>& whole,
           double by) {
    int count = 0;
    for (int row = 0; row < kRows; ++row)
        for (int i = 0; i < kBeside; ++i) {
            count += std::abs(before.at(i, row) - whole.at(i, row)) > by;
            count += std::abs(after.at(i, row) - whole.at(kBeside + i, row)) > by;
        }
    return count;
}
constexpr int kFew = 2 * kBeside * kRows / 50;  // tiles end elsewhere: suns are 0.05 degrees off

TEST(RoundTheEarth, ASummitIsFoundAcrossTheFirstColumn) {
    const dem::Heightfield field = ridge_from(-180);
    const geo::Geodetic summit =
        summit_near(dem::Posts(field), geo::geodetic_deg(46, 179.9, 0), 20'000);
    EXPECT_EQ(summit.height_m, 6500);
}

TEST(RoundTheEarth, AWalkGoesOnAcrossTheFirstColumn) {
    const dem::Heightfield field = ridge_from(-180);
    const sun::Instant noon = sun::parse_time("2026-03-20T00:00Z", {}).utc;
    const Walk walk =
        Walk::timed({geo::geodetic_deg(46, 179.95, 0), geo::geodetic_deg(46, -179.95, 0)},
                    {noon, noon + 3600.0});
    EXPECT_GT(light_along(dem::Posts(field), walk, {}).length_m, 7000);
}

TEST(RoundTheEarth, ShadowsGoOnAcrossTheFirstColumn) {
    const dem::Heightfield a = ridge_from(-180), b = ridge_from(0);
    const dem::Posts split(a), whole(b);
    // One sun, as it stands over the middles of the two.
    const sun::Instant noon = sun::parse_time("2026-03-20T00:00Z", {}).utc;
    for (const double hours : {-4.9, -4.0, 3.5, 5.0}) {
        const auto lit = [&](const dem::Posts& posts, const Window& part) {
            ShadowOptions options;
            options.part = part;
            const auto sun = sun::position(noon + hours * 3600, posts.grid().center());
            return shadows(posts, SunOverDem::of(sun), options).lit;
        };
        const Array2d<float> last = lit(split, kLast), first = lit(split, kFirst);
        EXPECT_LE(differ(last, first, lit(whole, kMiddle), 0.5), kFew) << hours;
        // In the shade of the ridge, on the side away from the sun.
        EXPECT_EQ(hours < 0 ? last.at(kBeside - 1, kRows / 2) : first.at(1, kRows / 2), 0) << hours;
    }
}

TEST(RoundTheEarth, HoursSkyAndHorizonsGoOnAcrossTheFirstColumn) {
    const dem::Heightfield a = ridge_from(-180), b = ridge_from(0);
    const dem::Posts split(a), whole(b);
    const sun::Instant begin = sun::parse_time("2026-03-20T04:00Z", {}).utc;
    for (const double hours : {2.0, 120.0}) {
        const auto lit_h = [&](const dem::Posts& posts, const Window& part) {
            SunHoursOptions options;
            options.part = part;
            options.step_s = 600;
            return sun_hours(posts, begin, begin + 3600 * hours, options).hours;
        };
        EXPECT_LE(
            differ(lit_h(split, kLast), lit_h(split, kFirst), lit_h(whole, kMiddle), 0.02 * hours),
            kFew)
            << hours;
    }
    const auto sky = [&](const dem::Posts& posts, const Window& part) {
        SkyViewOptions options;
        options.part = part;
        return sky_view(posts, options).share;
    };
    EXPECT_LE(differ(sky(split, kLast), sky(split, kFirst), sky(whole, kMiddle), 0.003), kFew);
    const auto horizon = [&](const dem::Posts& posts, const Window& part) {
        return horizons(posts, {radians(80)}, 0.13, part).elevation_rad.front();
    };
    EXPECT_LE(differ(horizon(split, kLast), horizon(split, kFirst), horizon(whole, kMiddle),
                     radians(0.05)),
              kFew);
}

TEST(RoundTheEarth, ALastColumnThatIsTheFirstOneAgainChangesNothing) {
    const dem::Heightfield a = ridge_from(-180), b = ridge_from(-180, kColumns + 1);
    const SunOverDem sun{radians(100), radians(4), 0};
    const Shadows once = shadows(dem::Posts(a), sun), again = shadows(dem::Posts(b), sun);
    int count = 0;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            count += once.lit.at(column, row) != again.lit.at(column, row);
    EXPECT_LE(count, kColumns * kRows / 500);
}

}  // namespace
}  // namespace relevo::light::test_round_earth
