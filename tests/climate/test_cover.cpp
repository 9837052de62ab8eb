#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/text.h"
#include "climate/cover.h"
#include "support/support.h"

// What ground the climate makes, against what people know of places. Of tests/data/climate/
// known_places.csv: round numbers from memory and from what is written about those places.
namespace relevo::climate {
namespace {

using geo::geodetic_deg;

const ClimateMap& map() {
    static const ClimateMap map = ClimateMap::shipped();
    return map;
}

CoverColumn column_at(double lat_deg, double lon_deg) {
    return CoverColumn(map().at(geodetic_deg(lat_deg, lon_deg)));
}

struct Known {
    std::string name, date, kind, expected;
    double lat_deg, height_m;
    CoverColumn column;

    double day() const {
        const std::string text = !date.empty() ? date : lat_deg >= 0 ? "07-15" : "01-15";
        return day_of_year(std::stoi(text.substr(0, 2)), std::stoi(text.substr(3)));
    }
};

std::vector<Known> known_places(const std::string& kind) {
    const test::Csv csv =
        test::read_csv(test::source_dir() / "tests/data/climate/known_places.csv");
    std::vector<Known> places;
    for (const std::vector<std::string>& row : csv.rows) {
        const auto text = [&](const char* column) { return row[csv.column(column)]; };
        const auto number = [&](const char* column) {
            return parse_number(text(column)).value_or(0);
        };
        if (text("kind") != kind) continue;
        places.push_back({text("name"), text("date"), kind, text("expected"), number("lat_deg"),
                          number("height_m"), column_at(number("lat_deg"), number("lon_deg"))});
    }
    return places;
}

TEST(Cover, KnownPlacesHaveTheirCover) {
    const std::vector<Known> places = known_places("cover");
    ASSERT_EQ(places.size(), 176U);
    int right = 0;
    for (const Known& place : places) {
        const Cover cover = place.column.cover(place.height_m, place.day());
        const std::vector<std::string> expected = split(place.expected, '|');
        const bool hit = std::count(expected.begin(), expected.end(), name_of(cover)) > 0;
        right += hit;
        if (!hit)
            fmt::print("  {} {:.0f} m {}: expected {} but got {}\n", place.name, place.height_m,
                       place.date, place.expected, name_of(cover));
    }
    const double share = right / static_cast<double>(places.size());
    fmt::print("[ accuracy ] cover: {} of {} places right, {:.1f} %\n", right, places.size(),
               100 * share);
    EXPECT_GE(share, 0.9);
}

/// Absolute errors of heights that lines of known places have [m].
std::vector<double> line_errors_m(const std::string& kind,
                                  std::optional<double> (CoverColumn::*line_of)() const) {
    std::vector<double> errors_m;
    for (const Known& place : known_places(kind)) {
        const std::optional<double> line_m = (place.column.*line_of)();
        EXPECT_TRUE(line_m.has_value()) << place.name;
        errors_m.push_back(
            std::abs(line_m.value_or(9000) - parse_number(place.expected).value_or(0)));
    }
    return errors_m;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

TEST(Cover, TreeLinesAreWhereTheyAreKnownToBe) {
    const std::vector<double> errors_m = line_errors_m("treeline", &CoverColumn::tree_line_m);
    ASSERT_EQ(errors_m.size(), 58U);
    fmt::print("[ accuracy ] tree lines: {} places, mean {:.0f} m\n", errors_m.size(),
               mean_of(errors_m));
    EXPECT_LE(mean_of(errors_m), 250);
}

TEST(Cover, PermanentIceBeginsWhereItIsKnownTo) {
    const std::vector<double> errors_m = line_errors_m("snowline", &CoverColumn::ice_line_m);
    ASSERT_EQ(errors_m.size(), 20U);
    fmt::print("[ accuracy ] lines of permanent ice: {} places, mean {:.0f} m\n", errors_m.size(),
               mean_of(errors_m));
    EXPECT_LE(mean_of(errors_m), 300);
}

TEST(Cover, SnowComesAndGoesWithTheSeasonOfTheHemisphere) {
    const double january = day_of_year(1, 20), july = day_of_year(7, 20);
    const CoverColumn tyrol = column_at(47.2, 11.4), andes = column_at(-33.4, -70.3);
    EXPECT_GT(tyrol.snow_share(1800, january), 0.9);
    EXPECT_LT(tyrol.snow_share(1800, july), 0.05);
    EXPECT_GT(andes.snow_share(3000, july), 0.9);
    EXPECT_LT(andes.snow_share(3000, january), 0.05);
    // None where it never falls.
    EXPECT_EQ(column_at(0, 10).snow_share(100, january), 0);
    EXPECT_LT(column_at(23, 25).snow_share(500, january), 0.01);
    EXPECT_LT(*tyrol.snow_line_m(january), 1000);
    EXPECT_GT(*tyrol.snow_line_m(july), 2600);
}

TEST(Cover, GreenGoesWithWarmthAndRain) {
    const double january = day_of_year(1, 20), july = day_of_year(7, 20);
    const CoverColumn scotland = column_at(55.9, -3.2), california = column_at(37.5, -121.5);
    const CoverColumn sahara = column_at(23, 25), amazon = column_at(-3, -60);
    EXPECT_GT(scotland.green(100, july), 0.8);
    EXPECT_LT(scotland.green(100, january), 0.3);
    EXPECT_LT(california.green(200, july), 0.1);  // golden hills
    EXPECT_GT(california.green(200, day_of_year(3, 20)), 0.5);
    EXPECT_LT(sahara.green(500, january), 0.05);
    EXPECT_GT(amazon.green(60, january), 0.95);
}

TEST(Cover, YearHasNoStepAtItsTurn) {
    const CoverColumn tyrol = column_at(47.2, 11.4);
    for (const double height_m : {800.0, 1500.0, 2500.0}) {
        EXPECT_NEAR(tyrol.snow_share(height_m, 0), tyrol.snow_share(height_m, 365), 1e-6);
        EXPECT_NEAR(tyrol.snow_share(height_m, 364.9), tyrol.snow_share(height_m, 0.1), 0.02);
    }
}

TEST(Cover, GrowthFallsWithHeightWithoutSteps) {
    for (const auto& [lat_deg, lon_deg] : {std::pair{47.2, 11.4}, {-3.0, 37.3}, {-80.0, 0.0}}) {
        const CoverColumn column = column_at(lat_deg, lon_deg);
        double last = column.growth(-500);
        for (double height_m = -480; height_m < 8000; height_m += 20) {
            const double now = column.growth(height_m);
            EXPECT_LE(now, last + 0.05) << lat_deg << " " << height_m;
            EXPECT_GT(now, last - 0.25) << lat_deg << " " << height_m;
            last = now;
        }
    }
}

TEST(Cover, RainOfSummerIsWorthLessInEitherHemisphere) {
    // Peel et al. 2007, table 1: the limit of dry climates is 20 mm for each degree of the year's
    // mean, and 280 more where 70 % of the rain falls in summer, none where in winter.
    const auto dryness = [](double lat_deg, int wet_month, double year_mm) {
        Normals normals{.lat_deg = lat_deg};
        normals.sea_level_c.fill(15);
        normals.rain_mm[static_cast<std::size_t>(wet_month)] = year_mm;
        return CoverColumn(normals).dryness(0);
    };
    constexpr int kJanuary = 0, kJuly = 6;
    EXPECT_NEAR(dryness(40, kJuly, 580), 1, 1e-6);
    EXPECT_NEAR(dryness(40, kJanuary, 300), 1, 1e-6);
    EXPECT_NEAR(dryness(-40, kJanuary, 580), 1, 1e-6);
    EXPECT_NEAR(dryness(-40, kJuly, 300), 1, 1e-6);
}

TEST(Cover, GreenIsByTheRainThatHasFallenNotByWhatIsToCome) {
    Normals normals{.lat_deg = 15};
    normals.sea_level_c.fill(20);
    normals.rain_mm[4] = 300;  // in May alone
    const CoverColumn column(normals);
    EXPECT_LT(column.green(0, day_of_year(4, 20)), 0.05);
    EXPECT_GT(column.green(0, day_of_year(6, 20)), 0.95);
    EXPECT_LT(column.green(0, day_of_year(9, 1)), 0.05);
}

TEST(Cover, SnowOfADayIsWhatLiesAtTheEndOfThatDaysStep) {
    // Steps of five days, each with the snow at its end.
    Year snow_mm{};
    for (std::size_t step = 0; step < snow_mm.size(); ++step)
        snow_mm[step] = static_cast<float>(10 * step);
    EXPECT_NEAR(snow_on(snow_mm, 5), 0, 1e-4);  // the first step ends with the 5th of January
    EXPECT_NEAR(snow_on(snow_mm, 10), 10, 1e-4);
    EXPECT_NEAR(snow_on(snow_mm, 12.5), 15, 1e-4);
    EXPECT_NEAR(snow_on(snow_mm, 365), 720, 1e-4);
    EXPECT_NEAR(snow_on(snow_mm, 2.5), 360, 1e-4);  // from the last step of the year before
}

TEST(Cover, DaysOfTheYearCountFromTheFirstOfJanuary) {
    EXPECT_EQ(day_of_year(1, 1), 0);
    EXPECT_EQ(day_of_year(3, 1), 59);
    EXPECT_EQ(day_of_year(2, 29), 59);
    EXPECT_EQ(day_of_year(12, 31), 364);
}

}  // namespace
}  // namespace relevo::climate
