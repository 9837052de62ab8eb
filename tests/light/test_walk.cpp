#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "light/point/light_along.h"
#include "sun/position.h"

namespace relevo::light::test_walk {
namespace {

using sun::Instant;
using test::error_of;

Instant at(const char* text) {
    return sun::parse_time(text).utc;
}

WalkOptions options() {
    WalkOptions options;
    options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    return options;
}

/// Bundled posts, on which most walks here go.
struct Jacksboro {
    dem::Heightfield field = test::bundled("jacksboro.tif");
    dem::Posts posts{field};
};

/// The begins and ends of stretches in the sun.
std::vector<Instant> edges_of(const LightAlong& found) {
    std::vector<Instant> edges;
    for (std::size_t i = 1; i < found.stretches.size(); ++i)
        if ((found.stretches[i].light == WalkLight::Sun) !=
            (found.stretches[i - 1].light == WalkLight::Sun))
            edges.push_back(found.stretches[i].from.utc);
    return edges;
}

/// That somebody who stands at a place for a day has the edges of DirectLight.
void expect_edges_of_the_place(const dem::Posts& posts, const geo::Geodetic& place, sun::Date date,
                               std::vector<double>& errors) {
    const TerrainHorizon horizon(posts, place);
    const LightDay day = DirectLight(horizon).day(date, sun::Zone());
    const Walk walk = Walk::timed({place, place}, {day.span.begin, day.span.end});
    const LightAlong found = light_along(posts, walk, options());
    std::vector<Instant> expected;
    for (const LitInterval& lit : day.lit) {
        if (!lit.begin.midnight) expected.push_back(lit.begin.utc);
        if (!lit.end.midnight) expected.push_back(lit.end.utc);
    }
    const std::vector<Instant> edges = edges_of(found);
    ASSERT_EQ(edges.size(), expected.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
        errors.push_back(std::abs(edges[i] - expected[i]));
    EXPECT_NEAR(found.sums[0].time_s, day.lit_s, 0.2 * double(edges.size()) + 1e-3);
    EXPECT_EQ(found.length_m, 0);
}

TEST(Walk, WhoStandsHasTheDirectLightOfThePlace) {
    const Jacksboro dem;
    std::vector<double> errors;
    for (const auto& [lat_deg, lon_deg] :
         {std::pair(36.30, -84.24), {36.33, -84.30}, {36.25, -84.20}, {36.40, -84.12}})
        for (const sun::Date date : {sun::Date{2026, 2, 10}, sun::Date{2026, 12, 21}})
            expect_edges_of_the_place(dem.posts, geo::geodetic_deg(lat_deg, lon_deg), date, errors);
    ASSERT_GE(errors.size(), 16U);
    test::print_accuracy("edges of one who stands", errors, "s", 0.2);
    EXPECT_LE(*std::max_element(errors.begin(), errors.end()), 0.2);
}

TEST(Walk, OfRealGroundToo) {
    SKIP_WITHOUT_TEST_DATA(dir);
    std::vector<double> errors;
    struct Case {
        const char* file;
        double lat_deg, lon_deg;
    };
    for (const Case& c : {Case{"tyrol_aw3d30_n47e011_1s_cog.tif", 47.2692, 11.4041},
                          {"hawaii_rotated20.tif", 19.80, -155.45},
                          {"dem_RGI50-05.08389.tif", 80.62, -64.16},
                          {"swellendam/srtm_41_19_4326.tif", -34.01, 20.45}}) {
        SCOPED_TRACE(c.file);
        const std::string path = (dir / "dem" / c.file).string();
        const dem::Posts posts = dem::Posts::load({{path}});
        expect_edges_of_the_place(posts, geo::geodetic_deg(c.lat_deg, c.lon_deg), {2026, 4, 5},
                                  errors);
    }
    test::print_accuracy("edges of one who stands, four real DEMs", errors, "s", 0.2);
    EXPECT_LE(*std::max_element(errors.begin(), errors.end()), 0.2);
}

TEST(Walk, HolesOfRealGroundAreNotKnownAsLongAsForThePlace) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const std::string path = (dir / "dem" / "n00_e006_3arc_v2.dt1").string();
    const dem::Posts posts = dem::Posts::load({{path}});
    const geo::Geodetic place = geo::geodetic_deg(0.3365, 6.7273);
    const TerrainHorizon horizon(posts, place);
    const LightDay day = DirectLight(horizon).day({2026, 4, 5}, sun::Zone());
    ASSERT_GT(day.not_known_s, 900);
    const Walk walk = Walk::timed({place, place}, {day.span.begin, day.span.end});
    const LightAlong found = light_along(posts, walk, options());
    EXPECT_NEAR(found.sums[0].time_s + found.sums[3].time_s, day.lit_s, 0.5);
    EXPECT_NEAR(found.sums[3].time_s, day.not_known_s, 10);  // which is known to 5 s an end
}

/// What stands on the way, its light by one look of the exact single-site code.
WalkLight light_of(const dem::Posts& posts, const WalkMoment& moment) {
    const TerrainHorizon horizon(posts, moment.place);
    const sun::Position position = sun::position(moment.utc, horizon.place());
    const double apparent_rad =
        sun::Refraction::standard(horizon.place()).apparent_rad(position.elevation_rad);
    if (apparent_rad > horizon.elevation_rad(position.azimuth_rad)) return WalkLight::Sun;
    return apparent_rad > 0 ? WalkLight::Terrain : WalkLight::Night;
}

TEST(Walk, EveryStretchHasItsLightToASecondFromItsEnds) {
    const Jacksboro dem;
    const std::vector<geo::Geodetic> places{
        geo::geodetic_deg(36.30, -84.24), geo::geodetic_deg(36.32, -84.25),
        geo::geodetic_deg(36.34, -84.27), geo::geodetic_deg(36.36, -84.26)};
    const Walk walk = Walk::at_speed(places, at("2026-02-10T12:00Z"), 2 / 3.6);
    const LightAlong found = light_along(dem.posts, walk, options());
    ASSERT_GE(found.stretches.size(), 5U);
    double time_s = 0, length_m = 0;
    for (const WalkSum& sum : found.sums) {
        time_s += sum.time_s;
        length_m += sum.length_m;
    }
    EXPECT_NEAR(time_s, walk.duration_s(), 1e-3);
    EXPECT_NEAR(length_m, walk.length_m(), 1e-6);
    EXPECT_EQ(found.stretches.front().light, WalkLight::Night);
    EXPECT_EQ(found.stretches.back().to.utc, walk.times().back());
    for (std::size_t i = 0; i < found.stretches.size(); ++i) {
        const WalkStretch& s = found.stretches[i];
        SCOPED_TRACE(fmt::format("stretch {}: {}", i, name_of(s.light)));
        if (i > 0) {
            EXPECT_EQ(s.from.utc, found.stretches[i - 1].to.utc);
            EXPECT_NE(s.light, found.stretches[i - 1].light);
        }
        // A second from each end, and in the middle.
        for (const double t_s : {1.0, (s.to.utc - s.from.utc) / 2, (s.to.utc - s.from.utc) - 1}) {
            const double share = ((s.from.utc - walk.times().front()) + t_s) / walk.duration_s();
            double way_m = share * walk.length_m();
            std::size_t k = 1;
            while (k + 1 < places.size() && walk.distances_m()[k] < way_m)
                ++k;
            way_m -= walk.distances_m()[k - 1];
            const WalkMoment moment{
                way_m, s.from.utc + t_s,
                geo::destination(places[k - 1], geo::geodesic(places[k - 1], places[k]).azimuth_rad,
                                 way_m)};
            EXPECT_EQ(light_of(dem.posts, moment), s.light) << t_s;
        }
    }
}

TEST(Walk, AWallOverAPlainShadesAsFarAsItsHeightSays) {
    // Due north along a plain on the equator, a wall of 100 m due east of it, in the afternoon no
    // shadow; in the morning the shadow's end passes when the sun is as high as the wall from
    // there.
    const dem::Affine affine{.x0 = 500000, .x_column = 10, .y0 = 1000, .y_row = -10};
    const dem::Heightfield field =
        test::field_of(301, 201, affine, "EPSG:32632",
                       [](int column, int) { return column == 200 ? 100.0 : 0.0; });
    const dem::Posts posts(field);
    const geo::Geodetic from = field.grid.place(150, 150), to = field.grid.place(150, 50);
    const Walk walk = Walk::at_speed({from, to}, at("2026-03-20T05:00Z"), 1000.0 / 7200);
    WalkOptions plain = options();
    plain.air = {};
    const LightAlong found = light_along(posts, walk, plain);
    std::string order;
    for (const WalkStretch& s : found.stretches)
        order += std::string(name_of(s.light)) + " ";
    EXPECT_EQ(order, "night terrain sun ");
    const WalkMoment& edge = found.stretches.back().from;
    const sun::Position position = sun::position(edge.utc, edge.place);
    // The wall is 500 m away by the azimuth's cosine; its ridge is that of posts 10 m apart.
    const double away_m = 500 / std::sin(position.azimuth_rad);
    EXPECT_NEAR(degrees(position.elevation_rad), degrees(std::atan2(100, away_m)), 0.01);
}

TEST(Walk, AHoleUnderTheFeetAndBeforeTheSunIsNotKnown) {
    const dem::Affine affine{.x0 = 500000, .x_column = 10, .y0 = 1000, .y_row = -10};
    const dem::Heightfield field =
        test::field_of(301, 201, affine, "EPSG:32632", [](int column, int row) {
            if (column == 299 && row == 1) return 2000.0;  // what might stand in the holes
            const bool under = column >= 140 && column <= 160 && row >= 90 && row <= 110;
            return under ? std::nan("") : 0.0;
        });
    const dem::Posts posts(field);
    // At noon on the equator the sun is overhead: only the ground under the feet matters.
    const Walk noon = Walk::at_speed({field.grid.place(150, 150), field.grid.place(150, 50)},
                                     at("2026-03-20T11:00Z"), 1.0);
    const LightAlong found = light_along(posts, noon, options());
    std::string order;
    for (const WalkStretch& s : found.stretches)
        order += std::string(name_of(s.light)) + " ";
    EXPECT_EQ(order, "sun not_known sun ");
    EXPECT_NEAR(found.sums[3].length_m, 220, 25);  // of 21 posts and the cells to their neighbours
    // In the morning, to the west of it, the sun is seen through it.
    const geo::Geodetic west = field.grid.place(50, 100);
    const Walk rest = Walk::timed({west, west}, {at("2026-03-20T06:00Z"), at("2026-03-20T06:30Z")});
    EXPECT_EQ(light_along(posts, rest, options()).stretches.back().light, WalkLight::NotKnown);
}

TEST(Walk, TheDemIsOpenFromWhereItsEdgeIsNearest) {
    // A plain of 30 km. Who looks at the sun in the south-west from its middle and then from 1 km
    // before its western edge could lose it behind mountains right beyond that.
    const dem::Heightfield field = test::field_of(301, 301, {600000, 100, 0, 30000, 0, -100},
                                                  "EPSG:32631", [](int, int) { return 0.0; });
    const dem::Posts posts(field);
    const geo::Geodetic far = field.grid.place(150, 150), near = field.grid.place(10, 150);
    const Instant evening = at("2026-03-20T17:10Z");
    WalkOptions wanted = options();
    wanted.highest_m = 3000;
    const auto reach_from = [&](std::vector<geo::Geodetic> places, std::vector<Instant> times) {
        const LightAlong found =
            light_along(posts, Walk::timed(std::move(places), std::move(times)), wanted);
        EXPECT_EQ(found.sums[0].time_s, found.duration_s);
        EXPECT_FALSE(found.doubt.open.empty());
        double least_m = 1e9;
        for (const OpenSector& sector : found.doubt.open)
            least_m = std::min(least_m, sector.reach_m);
        return least_m;
    };
    EXPECT_NEAR(reach_from({far, far}, {evening, evening + 20}), 15000, 150);
    // In either order, and within the same quarter of a degree of the sun's way.
    EXPECT_NEAR(reach_from({near, near, far, far}, {evening, evening, evening, evening + 20}), 1000,
                100);
    EXPECT_NEAR(reach_from({far, far, near, near}, {evening, evening, evening, evening + 20}), 1000,
                100);
}

TEST(Walk, ARestAndAJumpAreLookedAtByTimeAndByDistance) {
    const Jacksboro dem;
    const geo::Geodetic a = geo::geodetic_deg(36.30, -84.24), b = geo::geodetic_deg(36.36, -84.26);
    // Rests at a through the sunrise, is at b at once, and rests there.
    const Walk walk = Walk::timed({a, a, b, b}, {at("2026-02-10T12:00Z"), at("2026-02-10T13:00Z"),
                                                 at("2026-02-10T13:00Z"), at("2026-02-10T14:00Z")});
    const LightAlong found = light_along(dem.posts, walk, options());
    EXPECT_NEAR(found.length_m, geo::geodesic(a, b).distance_m, 1e-6);
    const TerrainHorizon horizon(dem.posts, a);
    const LightDay day = DirectLight(horizon).day({2026, 2, 10}, sun::Zone());
    const std::vector<Instant> edges = edges_of(found);
    ASSERT_FALSE(edges.empty());
    EXPECT_NEAR(edges.front() - day.lit.front().begin.utc, 0, 0.2);
    EXPECT_EQ(found.stretches.front().from.place.lat_rad, a.lat_rad);
    EXPECT_EQ(found.stretches.back().to.place.lat_rad, b.lat_rad);
    // The same walk a day later is an hour-for-hour copy.
    const Walk later = walk.starting_at(at("2026-02-11T12:00Z"));
    EXPECT_EQ(later.times().back(), at("2026-02-11T14:00Z"));
}

TEST(Walk, WhatIsNoWalkIsSaid) {
    const geo::Geodetic a = geo::geodetic_deg(36.30, -84.24), b = geo::geodetic_deg(36.36, -84.26);
    const Instant t = at("2026-02-10T12:00Z");
    EXPECT_EQ(error_of([&] { Walk::at_speed({a}, t, 1); }),
              "exit 3: walk: 1 point: too few, expected two or more");
    EXPECT_EQ(error_of([&] {
                  Walk::at_speed({a, a}, t, 1);
              }),
              "exit 3: walk: all points are at the same place, expected a track with a length");
    for (const double speed : {0.0, -1.0, std::nan("")})
        EXPECT_EQ(error_of([&] {
                      Walk::at_speed({a, b}, t, speed);
                  }),
                  fmt::format("exit 3: walk: a speed of {} m/s, expected one above 0", speed));
    EXPECT_EQ(error_of([&] {
                  Walk::at_speed({a, b}, t, 0.0001);
              }),
              "exit 3: walk: 6.9 km take 798.1 days, expected at most 31; walk faster, or "
              "cut the track up");
    EXPECT_EQ(error_of([&] {
                  Walk::timed({a, b, a}, {t, t + 10, t + 5});
              }),
              "exit 3: walk: point 3: its time, 2026-02-10T12:00:05Z, is before that of the "
              "point before, 2026-02-10T12:00:10Z; expected times in order");
    EXPECT_EQ(error_of([&] {
                  Walk::timed({a, b}, {t, t});
              }),
              "exit 3: walk: all points have the same time, 2026-02-10T12:00:00Z, expected times "
              "that increase");
}

TEST(Walk, OutsideOfTheDemIsSaidWithWhereAndHowFar) {
    const Jacksboro dem;
    const Walk walk =
        Walk::at_speed({geo::geodetic_deg(36.30, -84.24), geo::geodetic_deg(36.30, -84.00),
                        geo::geodetic_deg(36.34, -84.27)},
                       at("2026-02-10T12:00Z"), 2);
    const std::string message = error_of([&] { light_along(dem.posts, walk, options()); });
    // The DEM ends at 84.0783 W, which is 14.53 km from 84.24 W and 7.04 km from 84.00 W.
    EXPECT_EQ(message,
              "exit 3: walk: km 14.535 to 28.691 of 46.205 km: outside of the DEM, up to 7.04 "
              "km beyond its edge; take a DEM that has all of the way, or cut the track");
    // A single corner that stands out between two looks is found too.
    const double edge_deg = degrees(dem.field.grid.place(402, 100).lon_rad);
    const double lat_deg = degrees(dem.field.grid.place(402, 100).lat_rad);
    const Walk corner = Walk::at_speed(
        {geo::geodetic_deg(lat_deg, edge_deg - 0.01), geo::geodetic_deg(lat_deg, edge_deg + 0.0001),
         geo::geodetic_deg(lat_deg, edge_deg - 0.01)},
        at("2026-02-10T12:00Z"), 2);
    EXPECT_NE(
        error_of([&] { light_along(dem.posts, corner, options()); }).find("outside of the DEM"),
        std::string::npos);
}

TEST(Walk, MoreLooksThanAMillionAreRefused) {
    const Jacksboro dem;
    std::vector<geo::Geodetic> places;
    for (int i = 0; i < 8000; ++i)
        places.push_back(geo::geodetic_deg(36.30, i % 2 == 0 ? -84.24 : -84.10));
    EXPECT_EQ(error_of([&] {
                  light_along(dem.posts, Walk::at_speed(places, at("2026-02-10T12:00Z"), 300),
                              options());
              }),
              "exit 3: walk: 100586.9 km in 93.1 h need 1.34e+06 samples, expected at most "
              "1000000; thin or split the track");
}

}  // namespace
}  // namespace relevo::light::test_walk
