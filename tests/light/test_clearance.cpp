#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "dem/load.h"
#include "light/fields.h"
#include "light/raster/clearance.h"
#include "sun/position.h"
#include "support/support.h"

namespace relevo::light::test_clearance {
namespace {

const dem::Posts& posts() {
    static const dem::Heightfield field =
        dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    static const dem::Posts posts(field);
    return posts;
}

struct Found {
    Array2d<float> upper_m, lower_m;
    Clearances::Found what;
};

Found clearances(const SunOverDem& sun) {
    const dem::Grid& grid = posts().grid();
    Found found{Array2d<float>(grid.columns(), grid.rows(), -1e9F),
                Array2d<float>(grid.columns(), grid.rows(), -1e9F),
                {}};
    found.what = Clearances(posts(), {}).each(grid.center(), sun, [&](const ClearanceRun& run) {
        std::copy_n(run.upper_m, run.count, &found.upper_m.at(run.column, run.row));
        std::copy_n(run.lower_m, run.count, &found.lower_m.at(run.column, run.row));
    });
    return found;
}

TEST(Clearances, OfAPointAreThoseOfShadows) {
    for (const double azimuth_deg : {30.0, 100.0, 200.0, 290.0}) {
        const SunOverDem sun{radians(azimuth_deg), radians(6), 0};
        const Found found = clearances(sun);
        const Shadows expected = shadows(posts(), sun);
        std::int64_t wrong = 0;
        for (std::size_t i = 0; i < found.upper_m.size(); ++i) {
            wrong += (found.upper_m.data()[i] >= 0) != (expected.lit.data()[i] > 0);
            wrong += found.upper_m.data()[i] != found.lower_m.data()[i];
        }
        EXPECT_EQ(wrong, 0) << azimuth_deg;
        EXPECT_GT(expected.shaded_posts, 1000);
    }
}

TEST(Clearances, SomeOfTheDiscIsSeenWhereTheUpperLimbIsAndAllWhereTheLowerOneIs) {
    const SunOverDem sun{radians(200), radians(4), sun::semidiameter_rad(1)};
    const Found found = clearances(sun);
    const Shadows expected = shadows(posts(), sun, {.soft = true});
    std::int64_t wrong = 0, part = 0;
    for (std::size_t i = 0; i < found.upper_m.size(); ++i) {
        const float upper_m = found.upper_m.data()[i], lower_m = found.lower_m.data()[i];
        const float share = expected.lit.data()[i];
        wrong += (upper_m > 0) != (share > 0);
        wrong += (lower_m >= 0) != (share == 1);
        wrong += lower_m > upper_m;
        part += share > 0 && share < 1;
    }
    EXPECT_LE(wrong, part / 100);  // shares that are rounded to none or all
    EXPECT_GT(part, 1000);
}

TEST(Clearances, AtNightThereAreNone) {
    const Found found = clearances({1, radians(-10), 0.0046});
    EXPECT_TRUE(found.what.night);
    EXPECT_EQ(found.upper_m.at(5, 5), -1e9F);
}

TEST(Clearances, SayHowFarTheSunIsOffWhereOneHoldsForFewPosts) {
    const auto error_deg = [](double step_deg, int columns, int rows) {
        const dem::Heightfield field = test::field_of(
            columns, rows,
            {-0.5 * columns * step_deg, step_deg, 0, 0.5 * rows * step_deg, 0, -step_deg},
            "EPSG:4326", [](int, int) { return 100.0; });
        const dem::Posts of(field);
        return degrees(Clearances(of, {})
                           .each(field.grid.center(), {radians(140), radians(30), 0},
                                 [](const ClearanceRun&) {})
                           .error_rad);
    };
    EXPECT_EQ(error_deg(1.0 / 3600, 200, 160), 0);
    // A continent: one sun holds for few of its posts.
    const double wide_deg = error_deg(0.2, 400, 400);
    std::printf("[ accuracy ] a sun of a part of the DEM is off by up to %.2f degrees\n", wide_deg);
    EXPECT_GT(wide_deg, 0.1);
    EXPECT_LT(wide_deg, 12);
}

TEST(Clearances, TheQuickShareOfADiscIsWithinTwoThousandths) {
    for (int i = 0; i <= 1000; ++i) {
        const double height = i / 1000.0;
        EXPECT_NEAR(double{quick_share_of_disc(static_cast<float>(height))}, share_of_disc(height),
                    0.002);
    }
}

}  // namespace
}  // namespace relevo::light::test_clearance
