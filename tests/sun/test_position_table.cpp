#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/position.h"
#include "sun/position_table.h"
#include "sun/tables.h"

namespace relevo::sun::test_position_table {
namespace {

TEST(PositionTable, IsAsGoodAsTheRigorousWay) {
    // Years without UTC, with drifting UTC, with leap seconds in June and December, to come.
    std::vector<double> sky_arcsec, distance_au;
    for (const int year : {1900, 1935, 1961, 1966, 1972, 1985, 2016, 2026, 2060, 2100}) {
        const Instant from = Instant::from_utc({{year, 1, 1}});
        const PositionTable table(from, Instant::from_utc({{year + 1, 1, 1}}));
        const double length_s = table.to() - from;
        for (int i = 0; i < 400; ++i) {
            // Spread over the year and the globe by irrational steps; both ends of the table, too.
            const double share = i == 0 ? 0 : i == 1 ? 1 : std::fmod(i * 0.61803398875, 1.0);
            const Instant t = from + share * length_s;
            const geo::Geodetic place{std::asin(2 * std::fmod(i * 0.41421356, 1.0) - 1),
                                      2 * kPi * std::fmod(i * 0.7320508, 1.0), (i % 9) * 1000.0};
            const Position p = position(t, place);
            const glm::dvec3 v = table.vector_au(t, Observer(place));
            const double error = glm::length(glm::normalize(v) - p.direction) / kArcsecond_rad;
            sky_arcsec.push_back(error);
            distance_au.push_back(std::abs(glm::length(v) - p.distance_au));
            EXPECT_LE(error, 0.005) << to_iso(t, 3);
            EXPECT_LE(distance_au.back(), 1e-8) << to_iso(t, 3);
            EXPECT_NEAR(glm::length(table.direction(t, Observer(place)) - glm::normalize(v)), 0,
                        1e-15);
        }
    }
    test::print_accuracy("table against rigorous, ten years", sky_arcsec, "arcsec", 0.005);
    test::print_accuracy("table against rigorous, distance", distance_au, "au", 1e-8);
}

TEST(PositionTable, ServesASingleMomentAndTheWholeSpanOfYears) {
    const geo::Geodetic place{radians(46.5), radians(8.0), 2000};
    const Instant noon = instant_of("2026-06-21T12:00");
    const PositionTable moment(noon, noon);
    EXPECT_NEAR(
        glm::length(moment.direction(noon, Observer(place)) - position(noon, place).direction), 0,
        0.005 * kArcsecond_rad);
    for (const char* edge : {"1899-12-30T00:00:00", "2101-01-02T23:59:59"}) {
        const Instant t = instant_of(edge);
        EXPECT_NEAR(glm::length(PositionTable(t, t).direction(t, Observer(place)) -
                                position(t, place).direction),
                    0, 0.005 * kArcsecond_rad)
            << edge;
    }
}

TEST(PositionTable, OutsideItIsAnError) {
    const Observer observer({0, 0, 0});
    const PositionTable table(instant_of("2026-06-21T00:00"), instant_of("2026-06-22T00:00"));
    EXPECT_EQ(test::error_of([&] { table.direction(instant_of("2026-06-20T23:59"), observer); }),
              "exit 1: sun: 2026-06-20T23:59:00Z: outside the table, which is from "
              "2026-06-21T00:00:00Z to 2026-06-22T00:00:00Z");
    EXPECT_EQ(test::error_of([&] {
                  PositionTable(instant_of("2026-06-21T00:00"), instant_of("2026-06-20T00:00"));
              }),
              "exit 3: sun: from 2026-06-21T00:00:00Z to 2026-06-20T00:00:00Z: ends "
              "before it begins");
    EXPECT_EQ(test::error_of([&] {
                  PositionTable(instant_of("2090-01-01T00:00"), instant_of("2120-01-01T00:00"));
              }),
              "exit 3: time: 2120-01-01T00:00:00Z: sun and moon are computed for the years 1900 "
              "to 2100");
}

}  // namespace
}  // namespace relevo::sun::test_position_table
