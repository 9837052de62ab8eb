#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"
#include "scene/default_time.h"
#include "sun/position.h"

namespace relevo::scene {
namespace {

DefaultTime time_at(double lat_deg, double lon_deg, double camera_deg) {
    return DefaultDay({radians(lat_deg), radians(lon_deg), 0}).time(camera_deg);
}

TEST(DefaultTime, IsOnTheLongestDayOfThePlace) {
    // By the sun's own time: the date of the clocks of Greenwich is another one in the far east.
    EXPECT_EQ(sun::to_iso(time_at(46.5, 8, 200).utc).substr(0, 10), "2026-06-21");
    EXPECT_EQ(sun::to_iso(time_at(-34, 20.5, 200).utc).substr(0, 10), "2026-12-21");
}

TEST(DefaultTime, HasTheSunInItsBoundsFromSomeSidesAtAllLatitudes) {
    for (int lat_deg = -80; lat_deg <= 80; lat_deg += 5) {
        int sides = 0;
        for (int camera_deg = 0; camera_deg < 360; camera_deg += 15) {
            const DefaultTime time = time_at(lat_deg, 30, camera_deg);
            const sun::Position sun = sun::position(time.utc, {radians(lat_deg), radians(30), 0});
            EXPECT_NEAR(degrees(sun.elevation_rad), time.elevation_deg, 1e-9);
            const double aside = degrees(sun.azimuth_rad) - camera_deg;
            EXPECT_NEAR(std::remainder(aside - time.aside_deg, 360), 0, 1e-9);
            // The sun's elevation is right for any side; its azimuth depends on the side.
            EXPECT_GE(time.elevation_deg, kLowestSun_deg) << lat_deg << " " << camera_deg;
            EXPECT_LE(time.elevation_deg, kHighestSun_deg) << lat_deg << " " << camera_deg;
            const double away = std::abs(time.aside_deg);
            EXPECT_EQ(time.within_bounds, away >= kLeastAside_deg && away <= kMostAside_deg);
            sides += time.within_bounds;
        }
        EXPECT_GE(sides, 6) << lat_deg;
    }
}

TEST(DefaultTime, Prefers25To30DegreesHighAnd60To80Aside) {
    int both = 0;
    for (int lat_deg = -80; lat_deg <= 80; lat_deg += 10)
        for (int camera_deg = 0; camera_deg < 360; camera_deg += 15) {
            const geo::Geodetic place{radians(lat_deg), radians(30), 0};
            const DefaultTime time = DefaultDay(place).time(camera_deg);
            const sun::Instant day =
                sun::Instant::from_utc({.date = {2026, lat_deg < 0 ? 12 : 6, 21}});
            bool exists = false;
            for (int minute = -120; minute < 22 * 60 && !exists; minute += 10) {
                const sun::Position sun = sun::position(day + 60.0 * minute, place);
                const double aside = std::remainder(degrees(sun.azimuth_rad) - camera_deg, 360);
                const double high = degrees(sun.elevation_rad);
                exists = high >= 26 && high <= 29 && std::abs(aside) >= 62 && std::abs(aside) <= 78;
            }
            if (!exists) continue;
            ++both;
            const double away = std::abs(time.aside_deg);
            EXPECT_TRUE(time.elevation_deg >= 24.5 && time.elevation_deg <= 30.5 && away >= 59.5 &&
                        away <= 80.5)
                << lat_deg << " " << camera_deg << ": " << time.elevation_deg << " " << away;
        }
    EXPECT_GT(both, 20);
}

TEST(DefaultTime, HasTheSunAsHighAsItComesAtThePoles) {
    for (const double lat_deg : {-90.0, 90.0}) {
        const DefaultTime time = time_at(lat_deg, 0, 200);
        EXPECT_NEAR(time.elevation_deg, 23.43, 0.1);  // the obliquity of the ecliptic
        EXPECT_TRUE(time.within_bounds);
        EXPECT_NEAR(time.aside_deg, 70, 2);
    }
}

TEST(DefaultTime, IsRatherLitFromTheLeft) {
    EXPECT_GT(time_at(46, 8, 190).aside_deg, 0);
    EXPECT_GT(time_at(-40, 8, 10).aside_deg, 0);
}

TEST(DefaultTime, SaysWhatItIs) {
    const auto text = [](const DefaultTime& time, const std::string& after) {
        return "time: " + sun::to_iso(time.utc) + ", chosen " + after;
    };
    const DefaultTime alps = time_at(46, 8, 200), equator = time_at(0, 0, 90);
    EXPECT_EQ(alps.reason(),
              text(alps, "for relief: sun 29 degrees high, 75 degrees left of the camera"));
    EXPECT_EQ(equator.reason(),
              text(equator,
                   "for relief: sun 34 degrees high, 29 degrees right of the camera (wanted: 20 to "
                   "35 and 50 to 100)"));
    const DefaultTime globe = DefaultDay({0, 0, 0}, true).time(0);
    EXPECT_EQ(globe.reason(), text(globe, "because most of the visible side of the globe is lit"));
}

TEST(SideOf, IsWhereTheLowerEdgeOfThePictureLies) {
    const auto side_of = [](double azimuth_deg, double elevation_deg) {
        return side_of_deg(orbit_camera({azimuth_deg, elevation_deg, 1},
                                        std::vector<glm::dvec3>{{-1e3, -1e3, 0}, {1e3, 1e3, 0}}, 1,
                                        1));
    };
    for (const double azimuth_deg : {0.5, 90.0, 200.0, 359.0})
        for (const double elevation_deg : {-20.0, 0.0, 30.0, 89.0, 90.0})
            EXPECT_NEAR(side_of(azimuth_deg, elevation_deg), azimuth_deg, 1e-6) << elevation_deg;
}

}  // namespace
}  // namespace relevo::scene
