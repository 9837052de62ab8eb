#include <cmath>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "light/point/event_time.h"

namespace relevo::light::test_event_time {
namespace {

using test::error_of;

TerrainAccess access(const dem::Posts& posts) {
    return {.middle = [&] { return posts.grid().center(); },
            .posts = [&]() -> const dem::Posts& { return posts; }};
}

TEST(EventTime, FirstAndLastLightAreThoseOfTheTerrain) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const TerrainAccess dem = access(posts);
    const sun::Zone zone = sun::Zone::named("America/New_York");
    const geo::Geodetic place = geo::geodetic_deg(36.42, -84.25);
    HorizonOptions standing;
    standing.eye_height_m = 2;
    const TerrainHorizon ground(field, place), eye(field, place, standing);
    const LightDay on_ground = DirectLight(ground).day({2026, 1, 6}, zone);
    const LightDay at_eye = DirectLight(eye).day({2026, 1, 6}, zone);
    ASSERT_FALSE(on_ground.lit.empty());
    const auto time = [&](const char* text) {
        const sun::ParsedTime parsed = parse_time(text, sun::Date{2026, 1, 6}, zone, dem);
        EXPECT_EQ(parsed.zone.name(), zone.name());
        return parsed.utc;
    };
    constexpr double kSearch_s = 0.002;  // both are searched for, from other times on
    EXPECT_NEAR(time("first-light@36.42,-84.25") - on_ground.lit.front().begin.utc, 0, kSearch_s);
    EXPECT_NEAR(time("last-light-10min@36.42,-84.25") - (on_ground.lit.back().end.utc - 600), 0,
                kSearch_s);
    EXPECT_NEAR(time("first-light@36.42,-84.25,2agl") - at_eye.lit.front().begin.utc, 0, kSearch_s);
    // Without a place it is the one at hand, or the middle of the DEM.
    EXPECT_NEAR(
        parse_time("first-light", sun::Date{2026, 1, 6}, zone, dem, geo::PlaceText{place}).utc -
            on_ground.lit.front().begin.utc,
        0, kSearch_s);
    const TerrainHorizon middle(field, field.grid.center());
    EXPECT_NEAR(time("last-light") - DirectLight(middle).day({2026, 1, 6}, zone).lit.back().end.utc,
                0, kSearch_s);
    EXPECT_EQ(time("sunset"), sun::resolve({.event = sun::EventKind::Sunset,
                                            .place = geo::PlaceText{field.grid.center()}},
                                           sun::Date{2026, 1, 6}, zone)
                                  .utc);
    // What needs no terrain does not ask for it.
    EXPECT_NEAR(parse_time("sunrise@36.42,-84.25", sun::Date{2026, 1, 6}, zone).utc -
                    *on_ground.flat.first(sun::EventKind::Sunrise),
                0, 0.01);
    EXPECT_EQ(parse_time("2026-01-06T08:00", std::nullopt, zone).utc,
              sun::parse_time("2026-01-06T13:00Z").utc);
}

// Level ground in Alaska, where clocks are two hours ahead of the sun: light until after midnight.
TEST(EventTime, LastLightMayComeAfterMidnight) {
    const dem::Heightfield field = test::field_of(101, 101, {-143.1, 0.002, 0, 64.65, 0, -0.001},
                                                  "EPSG:4326", [](int, int) { return 10.0; });
    const dem::Posts posts(field);
    const sun::Zone zone = sun::Zone::named("America/Anchorage");
    const auto local = [&](const char* event) {
        return sun::to_iso(parse_time(event, sun::Date{2026, 6, 21}, zone, access(posts)).utc, zone)
            .substr(0, 13);
    };
    EXPECT_EQ(local("last-light"), "2026-06-22T00");
    EXPECT_EQ(local("sunset"), "2026-06-22T00");
    EXPECT_EQ(local("first-light"), "2026-06-21T02");
    EXPECT_EQ(local("sunrise"), "2026-06-21T02");
}

TEST(EventTime, LastLightIsThatOfTheLastSpell) {
    // A tower to the south takes the winter's noon.
    const dem::Heightfield field = test::field_of(
        201, 201, {500000, 10, 0, 5200000, 0, -10}, "EPSG:32632", [](int column, int row) {
            return std::abs(column - 100) <= 3 && row >= 108 && row <= 111 ? 60.0 : 0.0;
        });
    const dem::Posts posts(field);
    const sun::Zone zone = sun::Zone::named("Europe/Zurich");
    const sun::Date date{2026, 1, 6};
    const TerrainHorizon middle(field, field.grid.center());
    const LightDay day = DirectLight(middle).day(date, zone);
    ASSERT_EQ(day.lit.size(), 2u);
    const auto time = [&](const char* event) {
        return parse_time(event, date, zone, access(posts)).utc;
    };
    EXPECT_NEAR(time("first-light") - day.lit.front().begin.utc, 0, 0.002);
    EXPECT_NEAR(time("last-light") - day.lit.back().end.utc, 0, 0.002);
}

TEST(EventTime, AHighSunGoesBehindAWallByItsWidthInAzimuth) {
    // Azimuths are close together at 60 degrees: the disc, half a degree wide, spans a whole one.
    // The wall stands 40 m to the south and begins at the meridian.
    const dem::Heightfield field = test::field_of(
        1001, 1001, {500000, 0.1, 0, 5917000, 0, -0.1}, "EPSG:32632",
        [](int column, int row) { return column <= 500 && row >= 900 && row <= 905 ? 80.0 : 0.0; });
    const TerrainHorizon middle(field, field.grid.place(500, 500));
    const sun::Zone zone = sun::Zone::named("Europe/Zurich");
    const auto end_of = [&](sun::Limb limb) {
        LightOptions options;
        options.limb = limb;
        const LightDay day = DirectLight(middle, options).day({2026, 6, 21}, zone);
        return day.lit.front().end;
    };
    const LightEdge upper = end_of(sun::Limb::Upper), center = end_of(sun::Limb::Center),
                    lower = end_of(sun::Limb::Lower);
    EXPECT_NEAR(degrees(center.azimuth_rad), 180, 0.3);
    EXPECT_NEAR(degrees(center.elevation_rad), 60, 1);
    // 0.2625 degrees, the sun's semidiameter in June, over the cosine of its height.
    EXPECT_NEAR(degrees(upper.azimuth_rad - center.azimuth_rad), 0.525, 0.08);
    EXPECT_NEAR(degrees(center.azimuth_rad - lower.azimuth_rad), 0.525, 0.08);
}

TEST(EventTime, FirstLightErrorsSayWhatIsWrong) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const sun::Zone zone = sun::Zone::named("America/New_York");
    const sun::Date date{2026, 1, 6};
    const dem::Posts posts(field);
    const TerrainAccess dem = access(posts);
    EXPECT_EQ(error_of([&] { parse_time("first-light@36.42,-84.25", date, zone); }),
              "exit 3: time: first-light@36.42,-84.25: first and last light depend on the terrain; "
              "name a DEM");
    EXPECT_EQ(error_of([&] { parse_time("first-light@36.42,-84.25", std::nullopt, zone, dem); }),
              "exit 3: time: first-light@36.42,-84.25: no date; write 2026-06-21 "
              "first-light@36.42,-84.25 or pass --date");
    EXPECT_EQ(error_of([&] { parse_time("first-light@40,-84.25", date, zone, dem); }),
              "exit 3: horizon: 40,-84.25: outside of the DEM, expected a point within "
              "latitudes 36.1600 to 36.4458 and longitudes -84.4133 to -84.0783");
    const dem::Heightfield arctic = test::field_of(101, 101, {15, 0.002, 0, 78.3, 0, -0.0005},
                                                   "EPSG:4326", [](int, int) { return 10.0; });
    const dem::Posts arctic_posts(arctic);
    const TerrainAccess there = access(arctic_posts);
    const sun::Zone oslo = sun::Zone::named("Europe/Oslo");
    EXPECT_EQ(error_of([&] {
                  parse_time("2026-12-21 first-light@78.275,15.1", std::nullopt, oslo, there);
              }),
              "exit 3: time: 2026-12-21 first-light@78.275,15.1: the sun does not "
              "reach that point on 2026-12-21");
    EXPECT_EQ(error_of([&] {
                  parse_time("2026-06-21 last-light@78.275,15.1", std::nullopt, oslo, there);
              }),
              "exit 3: time: 2026-06-21 last-light@78.275,15.1: no last light on "
              "2026-06-21, the sun shines there at midnight");
}

}  // namespace
}  // namespace relevo::light::test_event_time
