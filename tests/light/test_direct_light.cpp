#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/text.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light::test_direct_light {
namespace {

using sun::Date;
using sun::Instant;
using sun::Zone;

/// A table of the outside test data, by the names of its columns.
struct Table {
    test::Csv csv;
    std::size_t row = 0;
    const std::string& text(std::string_view column) const {
        return csv.rows[row][csv.column(column)];
    }
    double number(std::string_view column) const { return *parse_number(text(column)); }
    std::string whole() const { return fmt::format("{}", fmt::join(csv.rows[row], ",")); }
};

constexpr double kSphere_m = 6'371'000, kPlane_m = 1e18;  // HorizonOptions::map_radius_m

/// The light of a day from a sun over the level horizon, which the tables have alone.
double lit_over_level_s(const LightDay& day) {
    double sum_s = 0;
    for (const LitInterval& lit : day.lit)
        for (const sun::TimeSpan& up : day.flat.sun_up)
            sum_s +=
                std::max(0.0, std::min(lit.end.utc, up.end) - std::max(lit.begin.utc, up.begin));
    return sum_s;
}

/// The sun that the tables were made with.
sun::EarthRotation rotation_of_the_tables() {
    sun::EarthOrientation earth;
    earth.tt_minus_utc_s = 69.2;
    return sun::EarthRotation::fixed(earth);
}

class Tables : public testing::Test {
  protected:
    void SetUp() override {
        SKIP_WITHOUT_TEST_DATA(dir);
        dir_ = dir;
        field_ = std::make_unique<dem::Heightfield>(
            dem::load((dir / "dem" / "srtm_bigtujunga30m_utm11.tif").string()));
    }

    /// With Saemundsson's refraction in the standard air of the height, over a map of a radius.
    DirectLight& light(int column, int row, double map_radius_m) {
        const auto key = std::tuple(column, row, map_radius_m);
        if (const auto found = lights_.find(key); found != lights_.end()) return *found->second;
        HorizonOptions options;
        options.map_radius_m = map_radius_m;
        horizons_.push_back(
            std::make_unique<TerrainHorizon>(*field_, field_->grid.place(column, row), options));
        LightOptions light;
        light.refraction =
            sun::Refraction::saemundsson(sun::standard_air(horizons_.back()->place().height_m));
        light.flat.rule = sun::RiseRule::seen(sun::Limb::Center, *light.refraction);
        return *(lights_[key] = std::make_unique<DirectLight>(*horizons_.back(), light));
    }

    std::filesystem::path dir_;
    std::unique_ptr<dem::Heightfield> field_;
    std::vector<std::unique_ptr<TerrainHorizon>> horizons_;
    std::map<std::tuple<int, int, double>, std::unique_ptr<DirectLight>> lights_;
};

Zone zone_of(const Table& t) {
    return Zone::fixed(static_cast<int>(t.number("zone_hours") * 3600));
}

TEST_F(Tables, SunHoursOfADay) {
    Table t{test::read_csv(dir_ / "sun" / "terrain_sunhours.csv")};
    ASSERT_EQ(t.csv.rows.size(), 400U);
    const sun::EarthRotation rotation = rotation_of_the_tables();
    constexpr double kLimit_s = 10;
    std::map<double, std::vector<double>> errors;
    std::vector<double> bearing;
    for (t.row = 0; t.row < t.csv.rows.size(); ++t.row) {
        const int column = static_cast<int>(t.number("col")),
                  row = static_cast<int>(t.number("row"));
        for (const auto& [ground, name] : {std::pair{kPlane_m, "sun_hours_crossings_flat_h"},
                                           std::pair{kSphere_m, "sun_hours_crossings_curved_h"}}) {
            const DirectLight& at = light(column, row, ground);
            const LightDay day =
                at.day(sun::parse_date(t.text("date_local")), zone_of(t), rotation);
            errors[ground].push_back(std::abs(lit_over_level_s(day) - t.number(name) * 3600));
            EXPECT_LE(errors[ground].back(), kLimit_s) << t.whole();
            bearing.push_back(std::abs(degrees(at.horizon().true_north_on_map_rad()) -
                                       t.number("grid_bearing_of_true_north_deg")));
            EXPECT_EQ(at.horizon().place().height_m, t.number("elev_m"));
        }
    }
    test::print_accuracy("sun hours of a day, flat", errors[kPlane_m], "s", kLimit_s);
    test::print_accuracy("sun hours of a day, curved", errors[kSphere_m], "s", kLimit_s);
    EXPECT_LE(*std::max_element(bearing.begin(), bearing.end()), 2e-5);
}

TEST_F(Tables, EveryIntervalOfADay) {
    Table t{test::read_csv(dir_ / "sun" / "terrain_riseset.csv")};
    ASSERT_EQ(t.csv.rows.size(), 121U);
    const sun::EarthRotation rotation = rotation_of_the_tables();
    constexpr double kLimit_s = 5;
    std::vector<double> errors;
    std::map<std::string, std::vector<std::size_t>> of_day;
    for (t.row = 0; t.row < t.csv.rows.size(); ++t.row)
        of_day[t.text("col") + "," + t.text("row") + "," + t.text("date_local")].push_back(t.row);
    for (const auto& [key, rows] : of_day) {
        t.row = rows.front();
        const LightDay day =
            light(static_cast<int>(t.number("col")), static_cast<int>(t.number("row")), kPlane_m)
                .day(sun::parse_date(t.text("date_local")), zone_of(t), rotation);
        ASSERT_EQ(day.lit.size(), rows.size()) << t.whole();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            t.row = rows[i];
            for (const auto& [edge, name] :
                 {std::pair{day.lit[i].begin, "start"}, std::pair{day.lit[i].end, "end"}}) {
                const Instant wanted =
                    sun::parse_time(t.text(fmt::format("{}_utc", name)) + "Z").utc;
                errors.push_back(std::abs(edge.utc - wanted));
                EXPECT_LE(errors.back(), kLimit_s) << t.whole();
                EXPECT_FALSE(edge.midnight);
                EXPECT_NEAR(degrees(edge.azimuth_rad), t.number(fmt::format("{}_az_deg", name)),
                            0.01);
                EXPECT_NEAR(degrees(edge.elevation_rad),
                            t.number(fmt::format("{}_el_apparent_deg", name)), 0.01);
            }
        }
    }
    test::print_accuracy("edges of direct light", errors, "s", kLimit_s);
}

TEST_F(Tables, SunHoursOfAYear) {
    Table t{test::read_csv(dir_ / "sun" / "terrain_year.csv")};
    ASSERT_EQ(t.csv.rows.size(), 40U);
    const sun::EarthRotation rotation = rotation_of_the_tables();
    constexpr double kLimit_percent = 0.01;
    std::vector<double> years, months_s;
    for (t.row = 0; t.row < t.csv.rows.size(); ++t.row) {
        const DirectLight& at =
            light(static_cast<int>(t.number("col")), static_cast<int>(t.number("row")), kPlane_m);
        std::map<int, double> of_month_s;
        double year_s = 0;
        for (const LightDay& day :
             at.days({2023, 1, 1}, {2023, 12, 31}, Zone::fixed(-8 * 3600), rotation)) {
            of_month_s[day.date.month] += day.lit_s;
            year_s += day.lit_s;
        }
        const double wanted_s = t.number("sun_hours_crossings_flat_h") * 3600;
        years.push_back(std::abs(year_s / wanted_s - 1) * 100);
        EXPECT_LE(years.back(), kLimit_percent) << t.whole();
        for (int month = 1; month <= 12; ++month)
            months_s.push_back(
                std::abs(of_month_s[month] - t.number(fmt::format("m{:02}", month)) * 3600));
    }
    test::print_accuracy("sun hours of a year", years, "%", kLimit_percent);
    // Sums of daily figures that were sampled every minute.
    constexpr double kMonth_s = 120;
    test::print_accuracy("sun hours of a month", months_s, "s", kMonth_s);
    EXPECT_LE(*std::max_element(months_s.begin(), months_s.end()), kMonth_s);
}

const Zone kZurich = Zone::named("Europe/Zurich");

/// Posts of 30 m near 47 N 9 E, 201 x 201, at 100 m where nothing else is said.
dem::Heightfield near_47_north(const std::function<double(int, int)>& height_m) {
    return test::field_of(201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632", height_m);
}

TEST(DirectLight, OverAPlainIsFromSunriseToSunset) {
    const dem::Heightfield field = near_47_north([](int, int) { return 100.0; });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    for (const sun::Limb limb : {sun::Limb::Upper, sun::Limb::Center, sun::Limb::Lower}) {
        LightOptions options;
        options.limb = limb;
        options.flat.rule = sun::RiseRule::seen(limb, sun::Refraction::standard(horizon.place()));
        const DirectLight light(horizon, options);
        for (const LightDay& day : light.days({2026, 1, 1}, {2026, 12, 31}, kZurich)) {
            ASSERT_EQ(day.lit.size(), 1U);
            // 0.2 s is 2 arcsec of elevation; a limb that is tried at every 0.01 degrees of azimuth
            // lies lower by as much as that.
            EXPECT_NEAR(day.lit[0].begin.utc - *day.flat.first(sun::EventKind::Sunrise), 0, 0.2);
            EXPECT_NEAR(day.lit[0].end.utc - *day.flat.first(sun::EventKind::Sunset), 0, 0.2);
            EXPECT_NEAR(day.lit_s, day.flat.day_length_s, 0.4);
        }
    }
}

TEST(DirectLight, ComesTwiceThroughANotch) {
    // A ridge of 400 m along a column, 80 posts to the west: ten degrees high. A notch of four
    // posts right to the west.
    const dem::Heightfield field = near_47_north([](int column, int row) {
        return column == 20 && !(row >= 98 && row <= 102) ? 520.0 : 100.0;
    });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    LightOptions options;
    const DirectLight light(horizon, options);
    // Half a month after the equinox the sun comes by there, seven degrees high.
    const LightDay day = light.day({2026, 4, 1}, kZurich);
    ASSERT_EQ(day.lit.size(), 2U);
    const LitInterval notch = day.lit[1];
    EXPECT_LT(day.lit[0].end.utc, notch.begin.utc);
    EXPECT_GT(notch.length_s(), 60);
    EXPECT_LT(notch.end.utc, *day.flat.first(sun::EventKind::Sunset));
    EXPECT_NEAR(day.lit_s, day.lit[0].length_s() + day.lit[1].length_s(), 1e-9);
    for (const LightEdge& edge : {day.lit[0].end, notch.begin, notch.end}) {
        const sun::Position p = sun::position(edge.utc, horizon.place());
        EXPECT_NEAR(degrees(edge.azimuth_rad), degrees(p.azimuth_rad), 1e-5);
        EXPECT_NEAR(degrees(edge.elevation_rad),
                    degrees(light.refraction().apparent_rad(p.elevation_rad)), 1e-5);
        EXPECT_NEAR(degrees(edge.elevation_rad), degrees(horizon.elevation_rad(edge.azimuth_rad)),
                    1e-4);
        EXPECT_FALSE(edge.midnight);
    }
    // The first ray comes earlier to such a window and the last one later; the whole disc stands in
    // it for a shorter time.
    options.limb = sun::Limb::Upper;
    const LightDay first_ray = DirectLight(horizon, options).day({2026, 4, 1}, kZurich);
    options.limb = sun::Limb::Lower;
    const LightDay whole = DirectLight(horizon, options).day({2026, 4, 1}, kZurich);
    ASSERT_EQ(first_ray.lit.size(), 2U);
    EXPECT_GT(first_ray.lit[1].length_s(), notch.length_s() + 60);
    EXPECT_GT(first_ray.lit[0].end.utc, day.lit[0].end.utc + 30);
    EXPECT_LT(whole.lit[0].end.utc, day.lit[0].end.utc - 30);
    EXPECT_LT(whole.lit_s, day.lit_s);
}

TEST(DirectLight, IsWhereTheSunStandsOverTheExactHorizonAtEveryMoment) {
    // A forest of needles, looked at every 20 s.
    std::uint32_t seed = 1;
    const dem::Heightfield field = near_47_north([&](int, int) {
        seed = seed * 1664525 + 1013904223;  // Numerical Recipes' generator
        const double share = seed / 4294967296.0;
        return 100 + 350 * share * share * share * share;
    });
    HorizonOptions eye;
    eye.eye_height_m = 60;
    int edges = 0, seconds_off = 0;
    for (const glm::ivec2 post : {glm::ivec2(60, 60), {100, 100}, {150, 90}, {140, 190}}) {
        const TerrainHorizon horizon(field, field.grid.place(post.x, post.y), eye);
        const DirectLight light(horizon);
        for (const Date date : {Date{2026, 12, 21}, {2026, 2, 2}, {2026, 5, 2}}) {
            const LightDay day = light.day(date, kZurich);
            const sun::PositionTable table(day.span.begin, day.span.end);
            edges += 2 * static_cast<int>(day.lit.size());
            for (double t = 10; t < day.span.length_s(); t += 20) {
                const Instant utc = day.span.begin + t;
                const glm::dvec3 sun = table.vector_au(utc, light.observer());
                const bool expected = light.refraction().apparent_rad(sun::elevation_of(sun)) >
                                      horizon.elevation_rad(sun::azimuth_of(sun));
                bool lit = false;
                for (const LitInterval& interval : day.lit)
                    lit |= interval.begin.utc <= utc && utc < interval.end.utc;
                if (lit != expected) seconds_off += 20;
            }
        }
    }
    EXPECT_GE(edges, 80);
    EXPECT_EQ(seconds_off, 0);
}

TEST(DirectLight, GoesOnOverMidnightInThePolarDay) {
    const dem::Heightfield field = test::field_of(101, 101, {15, 0.002, 0, 78.3, 0, -0.0005},
                                                  "EPSG:4326", [](int, int) { return 10.0; });
    const TerrainHorizon horizon(field, field.grid.place(50, 50));
    const DirectLight light(horizon);
    const Zone zone = Zone::named("Arctic/Longyearbyen");
    const LightDay summer = light.day({2026, 6, 21}, zone);
    ASSERT_EQ(summer.lit.size(), 1U);
    EXPECT_TRUE(summer.lit[0].begin.midnight);
    EXPECT_TRUE(summer.lit[0].end.midnight);
    EXPECT_EQ(summer.lit_s, 86400);
    EXPECT_EQ(summer.flat.sun, sun::Crossing::AboveAllDay);
    const LightDay winter = light.day({2026, 12, 21}, zone);
    EXPECT_TRUE(winter.lit.empty());
    EXPECT_EQ(winter.lit_s, 0);
}

TEST(DirectLight, OfTheFirstAndTheLastHourOfADayIsFound) {
    // 14 July 2026 beside the polar circle, on a plain: the sun is down for some minutes to some
    // hours around its lowest point, up to 50 minutes before or after midnight.
    const Date date{2026, 7, 14};
    const Zone zone = Zone::fixed(3600);
    int first_hour = 0, last_hour = 0;
    for (const double minutes : {-50.0, -30.0, -12.0, 12.0, 30.0, 50.0})
        for (const double lat_deg : {67.2, 67.4, 67.5, 67.55, 67.6}) {
            const double lon_deg = 15 + 1.5 - minutes / 4;
            const dem::Heightfield field =
                test::field_of(101, 101, {lon_deg - 0.1, 0.002, 0, lat_deg + 0.05, 0, -0.001},
                               "EPSG:4326", [](int, int) { return 10.0; });
            const TerrainHorizon horizon(field, field.grid.place(50, 50));
            const DirectLight light(horizon);
            const LightDay day = light.day(date, zone);
            const sun::PositionTable table(day.span.begin, day.span.end);
            std::vector<double> changes_s;
            bool before = false;
            for (double t_s = 0; t_s <= day.span.length_s(); t_s += 20) {
                const glm::dvec3 sun = table.vector_au(day.span.begin + t_s, light.observer());
                const bool lit = light.refraction().apparent_rad(sun::elevation_of(sun)) >
                                 horizon.elevation_rad(sun::azimuth_of(sun));
                if (t_s > 0 && lit != before) changes_s.push_back(t_s - 10);
                before = lit;
            }
            std::vector<double> edges_s;
            for (const LitInterval& lit : day.lit)
                for (const LightEdge& edge : {lit.begin, lit.end})
                    if (!edge.midnight) edges_s.push_back(edge.utc - day.span.begin);
            ASSERT_EQ(edges_s.size(), changes_s.size()) << lat_deg << " " << minutes;
            for (std::size_t i = 0; i < edges_s.size(); ++i) {
                EXPECT_NEAR(edges_s[i], changes_s[i], 10.1) << lat_deg << " " << minutes;
                first_hour += edges_s[i] < 3600;
                last_hour += edges_s[i] > 23 * 3600;
            }
        }
    EXPECT_GE(first_hour, 8);
    EXPECT_GE(last_hour, 8);
}

/// The elevation of the sun's upper (1) or lower (-1) limb, as seen [rad]: the disc's radius is of
/// the day's distance, and the air lifts the limb by its own elevation, not the centre's.
double limb_rad(Instant utc, const DirectLight& light, int sign) {
    const sun::Position p = sun::position(utc, light.horizon().place());
    return light.refraction().apparent_rad(
        p.elevation_rad + sign * std::asin(696'000e3 / 149'597'870.7e3 / p.distance_au));
}

TEST(DirectLight, LimbsAreThoseOfTheFlattenedDiscOfTheDay) {
    // From 300 m over a plain: a horizon half a degree below the level one, where the air shortens
    // the disc by a fifth; then walls all round of 30 to 60 degrees.
    constexpr double kLimit_s = 1.0;
    for (const double up_deg : {-0.5, 30.0, 45.0, 60.0}) {
        HorizonOptions options;
        if (up_deg < 0) options.eye_height_m = 300;
        // Crossings of a cone with rows and columns are as high as the cone, far from its tip.
        const dem::Heightfield field = near_47_north([&](int column, int row) {
            const double posts = std::hypot(column - 100, row - 100);
            const bool wall = up_deg > 0 && posts > 90;
            return wall ? 100 + posts * 30 * std::tan(radians(up_deg)) : 100.0;
        });
        const TerrainHorizon horizon(field, field.grid.place(100, 100), options);
        // Near the Earth's farthest and nearest to the sun, discs differ by 3 %.
        for (const Date date : {Date{2026, 1, 3}, {2026, 4, 20}, {2026, 7, 6}}) {
            std::map<sun::Limb, LightDay> days;
            for (const sun::Limb limb : {sun::Limb::Upper, sun::Limb::Center, sun::Limb::Lower}) {
                LightOptions of;
                of.limb = limb;
                const DirectLight light(horizon, of);
                const LightDay day = light.day(date, kZurich);
                const int sign = limb == sun::Limb::Upper ? 1 : limb == sun::Limb::Lower ? -1 : 0;
                for (const LitInterval& lit : day.lit)
                    for (const LightEdge& edge : {lit.begin, lit.end}) {
                        const bool begins = edge.utc == lit.begin.utc;
                        const double horizon_rad = horizon.elevation_rad(edge.azimuth_rad);
                        EXPECT_NEAR(degrees(horizon_rad), up_deg, 0.05);
                        // A limit of time, at the sun's own speed there.
                        const double before = limb_rad(edge.utc - kLimit_s, light, sign);
                        const double after = limb_rad(edge.utc + kLimit_s, light, sign);
                        EXPECT_LT(begins ? before : after, horizon_rad)
                            << up_deg << " " << sun::to_string(date) << " " << sign;
                        EXPECT_GT(begins ? after : before, horizon_rad)
                            << up_deg << " " << sun::to_string(date) << " " << sign;
                    }
                days[limb] = day;
            }
            if (days[sun::Limb::Lower].lit.empty()) continue;
            EXPECT_GT(days[sun::Limb::Upper].lit_s, days[sun::Limb::Center].lit_s + 60);
            EXPECT_GT(days[sun::Limb::Center].lit_s, days[sun::Limb::Lower].lit_s + 60);
        }
    }
}

TEST(DirectLight, InADepressionIsThatOfItsOwnHorizon) {
    // The Dead Sea's shore: all heights are below zero, a scarp of 300 m in the east.
    const dem::Heightfield field =
        test::field_of(201, 201, {35.4, 0.0005, 0, 31.6, 0, -0.0005}, "EPSG:4326",
                       [](int column, int) { return column >= 150 ? -130.0 : -430.0; });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    EXPECT_EQ(horizon.place().height_m, -430);
    const double scarp_m =
        geo::geodesic(field.grid.place(100, 100), field.grid.place(150, 100)).distance_m;
    EXPECT_NEAR(std::tan(horizon.elevation_rad(radians(90))), 300 / scarp_m, 5e-4);
    // Nothing but the plain at its own height in the west.
    EXPECT_NEAR(degrees(horizon.elevation_rad(radians(270))), 0, 1e-3);
    const DirectLight light(horizon);
    const LightDay day = light.day({2026, 3, 20}, Zone::fixed(7200));
    ASSERT_EQ(day.lit.size(), 1U);
    EXPECT_NEAR(degrees(day.lit[0].begin.elevation_rad), degrees(std::atan(300 / scarp_m)), 0.05);
    EXPECT_NEAR(degrees(day.lit[0].end.elevation_rad), 0, 1e-3);
    // The same landscape at 1000 m: the air is thinner, the horizon the same.
    const dem::Heightfield raised =
        test::field_of(201, 201, {35.4, 0.0005, 0, 31.6, 0, -0.0005}, "EPSG:4326",
                       [](int column, int) { return column >= 150 ? 1300.0 : 1000.0; });
    const TerrainHorizon above(raised, raised.grid.place(100, 100));
    for (int i = 0; i < 360; ++i)
        EXPECT_NEAR(degrees(above.elevation_rad(radians(i))),
                    degrees(horizon.elevation_rad(radians(i))), 2e-3)
            << i;
}

TEST(DirectLight, DoesNotReachTheBottomOfAWell) {
    const dem::Heightfield field = near_47_north([](int column, int row) {
        return std::hypot(column - 100, row - 100) < 2 ? 100.0 : 400.0;
    });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    const LightDay day = DirectLight(horizon).day({2026, 6, 21}, kZurich);
    EXPECT_TRUE(day.lit.empty());
    EXPECT_EQ(day.flat.sun, sun::Crossing::Crosses);
}

TEST(DirectLight, SaysHowItWasMadeAndWhatIsWrong) {
    const dem::Heightfield field = near_47_north([](int, int) { return 100.0; });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    LightOptions options;
    EXPECT_EQ(DirectLight(horizon, options).definition(),
              "direct light: centre of the sun over the terrain horizon, " +
                  sun::Refraction::standard(horizon.place()).description());
    options.limb = sun::Limb::Upper;
    options.refraction = sun::Refraction::none();
    const DirectLight light(horizon, options);
    EXPECT_EQ(light.definition(),
              "direct light: any part of the sun's disc over the terrain horizon, no refraction");
    EXPECT_EQ(test::error_of([&] {
                  light.days({2026, 6, 22}, {2026, 6, 21}, kZurich);
              }),
              "exit 3: sun: from 2026-06-22 to 2026-06-21: ends before it begins");
    EXPECT_EQ(test::error_of([&] {
                  light.day({1899, 6, 22}, kZurich);
              }),
              "exit 3: time: 1899-06-21T23:00:00Z: sun and moon are computed for the years 1900 "
              "to 2100");
    EXPECT_EQ(test::error_of([&] {
                  light.day({2011, 12, 30}, Zone::named("Pacific/Apia"));
              }),
              "exit 3: time zone: 2011-12-30: there was no such day in Pacific/Apia, its clocks "
              "skipped it");
}

}  // namespace
}  // namespace relevo::light::test_direct_light
