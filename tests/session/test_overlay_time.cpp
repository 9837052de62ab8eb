#include <gtest/gtest.h>

#include "base/units.h"
#include "session/overlay.h"
#include "session/overlay_time.h"

namespace relevo::session::test_overlay_time {
namespace {

const geo::Geodetic kZurich{radians(47.4), radians(8.5), 0};

std::string clock_of(const std::map<std::string, std::string>& about) {
    const auto time = overlay_time(about);
    return time ? clock_text(*time, "Europe/Zurich", kZurich) : "none";
}

std::string period(const char* from, const char* to) {
    return clock_of({{"TIME_FROM", from}, {"TIME_TO", to}});
}

// What `relevo sun shadow` and `relevo sun hours` write.
TEST(OverlayTime, OfAShadowIsItsTimeByTheClocksOfThePlace) {
    const std::map<std::string, std::string> about{{"TIME_UTC", "2026-06-21T07:30:00.000Z"},
                                                   {"SUN_AZIMUTH_DEG", "94.08123"},
                                                   {"SUN_APPARENT_ELEVATION_DEG", "39.90188"},
                                                   {"SUN_ELEVATION_DEG", "39.88312"}};
    EXPECT_EQ(clock_of(about), "2026-06-21 09:30 UTC+02:00");
    EXPECT_EQ(sun_text(*overlay_time(about)),
              "azimuth 94.08, elevation 39.88 (39.90 with refraction)");
}

TEST(OverlayTime, OfASunThatWasGivenHasNoTime) {
    const std::map<std::string, std::string> about{{"SUN_AZIMUTH_DEG", "110.00000"},
                                                   {"SUN_APPARENT_ELEVATION_DEG", "20.00000"}};
    EXPECT_EQ(clock_of(about), "");
    EXPECT_EQ(sun_text(*overlay_time(about)), "azimuth 110.00, elevation 20.00");
}

TEST(OverlayTime, OfAPeriodIsItsDaysOrHours) {
    EXPECT_EQ(period("2026-06-21T00:00:00+02:00", "2026-06-22T00:00:00+02:00"), "2026-06-21");
    EXPECT_EQ(period("2026-06-01T00:00:00+02:00", "2026-07-01T00:00:00+02:00"),
              "2026-06-01 to 2026-06-30");
    // The clocks are put back on the last day.
    EXPECT_EQ(period("2026-10-01T00:00:00+02:00", "2026-11-01T00:00:00+01:00"),
              "2026-10-01 to 2026-10-31");
    EXPECT_EQ(period("2026-06-21T08:00:00+02:00", "2026-06-21T12:30:00+02:00"),
              "2026-06-21 08:00 to 12:30");
    EXPECT_EQ(sun_text(*overlay_time({{"TIME_FROM", "2026-06-21T00:00:00+02:00"},
                                      {"TIME_TO", "2026-06-22T00:00:00+02:00"}})),
              "");
}

TEST(OverlayTime, OfAPeriodNamesTheZoneOfItsDays) {
    std::map<std::string, std::string> about{{"TIME_FROM", "2026-06-21T00:00:00+09:00"},
                                             {"TIME_TO", "2026-06-22T00:00:00+09:00"},
                                             {"TIME_ZONE", "Asia/Tokyo"}};
    EXPECT_EQ(clock_of(about), "2026-06-21, Asia/Tokyo");
    EXPECT_TRUE(overlay_time(about)->is_day());
    about["TIME_TO"] = "2026-06-24T00:00:00+09:00";
    EXPECT_EQ(clock_of(about), "2026-06-21 to 2026-06-23, Asia/Tokyo");
    EXPECT_FALSE(overlay_time(about)->is_day());
    // A day of 25 hours, and one that does not begin at midnight.
    EXPECT_FALSE(overlay_time({{"TIME_FROM", "2026-10-25T00:00:00+02:00"},
                               {"TIME_TO", "2026-10-26T00:00:00+01:00"}})
                     ->is_day());
    EXPECT_FALSE(overlay_time({{"TIME_FROM", "2026-06-21T01:00:00+02:00"},
                               {"TIME_TO", "2026-06-22T01:00:00+02:00"}})
                     ->is_day());
}

// Minutes since midnight are times of day, on days without a change of the clocks.
TEST(OverlayTime, FirstLightIsATimeOfDay) {
    const OverlayTime day = *overlay_time(
        {{"TIME_FROM", "2026-06-21T00:00:00+02:00"}, {"TIME_TO", "2026-06-22T00:00:00+02:00"}});
    chart::Legend minutes{.title = "minutes to the first light", .unit = "min"};
    show_as_clock(day, minutes);
    EXPECT_TRUE(minutes.clock);
    EXPECT_EQ(minutes.title, "first light");
    EXPECT_EQ(minutes.unit, "");
    EXPECT_EQ(chart::value_text(minutes, 454, 1), "07:34");
    chart::Legend hours{.title = "sun hours", .unit = "h"};
    show_as_clock(day, hours);
    EXPECT_FALSE(hours.clock);
    const OverlayTime changed = *overlay_time(
        {{"TIME_FROM", "2026-10-25T00:00:00+02:00"}, {"TIME_TO", "2026-10-26T00:00:00+01:00"}});
    chart::Legend that_day{.title = "minutes to the first light", .unit = "min"};
    show_as_clock(changed, that_day);
    EXPECT_FALSE(that_day.clock);
    EXPECT_EQ(that_day.unit, "min");
}

TEST(OverlayTime, WhatIsOfNoSunHasNone) {
    EXPECT_EQ(clock_of({}), "none");
    EXPECT_EQ(clock_of({{"AREA_OR_POINT", "Area"}, {"DIRECTIONS", "36"}}), "none");
    EXPECT_EQ(period("yesterday", "today"), "none");
    EXPECT_EQ(clock_of({{"TIME_UTC", "2026-06-21T07:30Z"}}), "none");
    // Times that other programs may write, or nobody.
    EXPECT_EQ(period("now", "now"), "none");
    EXPECT_EQ(period("sunrise", "sunset"), "none");
    EXPECT_EQ(period("2026-06-21T08:00Z", "2026-06-21T12:30Z"), "2026-06-21 08:00 to 12:30");
}

}  // namespace
}  // namespace relevo::session::test_overlay_time
