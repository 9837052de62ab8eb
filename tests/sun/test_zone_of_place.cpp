#include <chrono>
#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "sun/events.h"
#include "sun/position.h"
#include "sun/zone_of_place.h"
#include "tables.h"

// Which time zone a place is in, by the map that comes along (data/README.md).
namespace relevo::sun::test_zone_of_place {
namespace {

using geo::geodetic_deg;
using test::error_of;

const ZoneMap& map() {
    static const ZoneMap map = ZoneMap::shipped();
    return map;
}

std::string name_at(double lat_deg, double lon_deg) {
    return map().name_at(geodetic_deg(lat_deg, lon_deg));
}

double offset_h(const Zone& zone, int month) {
    return zone.local(Instant::from_utc({{2026, month, 15}, 12})).utc_offset_s / 3600.0;
}

TEST(ZoneOfPlace, ClocksOfFortyCitiesAreRight) {
    const test::Csv csv = test::read_csv(test::source_dir() / "tests/data/sun/zone_cities.csv");
    std::vector<double> errors_h;
    int same_name = 0;
    for (const Row& row : rows_of(csv)) {
        const ChosenZone found = zone_at(row.place(), map());
        EXPECT_FALSE(found.missing) << row.whole();
        for (const auto& [month, column] :
             {std::pair{1, "offset_h_2026_01_15"}, std::pair{7, "offset_h_2026_07_15"}}) {
            errors_h.push_back(std::abs(offset_h(found.zone, month) - row.number(column)));
            EXPECT_EQ(errors_h.back(), 0) << row.whole() << ": " << found.zone.name();
        }
        const std::vector<std::string> names = split(row.text("zone"), '|');
        same_name += std::count(names.begin(), names.end(), found.zone.name()) > 0;
    }
    EXPECT_EQ(errors_h.size(), 80U);
    EXPECT_GE(same_name, 39);  // but El Paso, whose clocks are those of its neighbour
    test::print_accuracy("offsets of 40 cities, winter and summer", errors_h, "h", 0);
}

/// "+4723+00832" or "+404251-0740023" (ISO 6709) in degrees.
geo::Geodetic place_of(const std::string& text) {
    const std::size_t lon_begin = text.find_first_of("+-", 1);
    const auto degrees_of = [](const std::string& angle, std::size_t digits) {
        const auto number = [&](std::size_t begin, std::size_t count) {
            return begin < angle.size() ? *parse_number(angle.substr(begin, count)) : 0;
        };
        const double size =
            number(1, digits) + number(1 + digits, 2) / 60 + number(3 + digits, 2) / 3600;
        return angle[0] == '-' ? -size : size;
    };
    return geodetic_deg(degrees_of(text.substr(0, lon_begin), 2),
                        degrees_of(text.substr(lon_begin), 3));
}

/// The database names a place for each zone, often one beside a border.
TEST(ZoneOfPlace, ClocksOfTheDatabasesOwnPlacesAreRight) {
    const std::filesystem::path path = "/usr/share/zoneinfo/zone.tab";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "not run: needs zone.tab of tzdata";
    std::vector<double> errors_h;
    int same_name = 0;
    std::string wrong;
    for (const std::string& line : split(read_text(path, "test"), '\n')) {
        const std::vector<std::string> fields = split(line, '\t');
        if (line.starts_with('#') || fields.size() < 3) continue;
        const Zone expected = Zone::named(fields[2]);
        const Zone found = zone_at(place_of(fields[1]), map()).zone;
        same_name += found.name() == expected.name();
        errors_h.push_back(std::max(std::abs(offset_h(found, 1) - offset_h(expected, 1)),
                                    std::abs(offset_h(found, 7) - offset_h(expected, 7))));
        if (errors_h.back() != 0) wrong += ' ' + expected.name();
    }
    fmt::print("[ accuracy ] tzdata {}: of {} places {} have their own zone, other clocks:{}\n",
               zone_database_version(), errors_h.size(), same_name, wrong);
    test::print_accuracy("offsets of its places", errors_h, "h", 1);
    EXPECT_GT(errors_h.size(), 400U);
    EXPECT_LE(std::count_if(errors_h.begin(), errors_h.end(), [](double h) { return h != 0; }), 3);
}

TEST(ZoneOfPlace, TheOpenSeaHasTheHourOfItsLongitude) {
    for (int lon_deg = -180; lon_deg < 180; ++lon_deg) {
        if ((lon_deg + 180) % 15 == 7 || (lon_deg + 180) % 15 == 8) continue;  // at the edge
        const ChosenZone found = zone_at(geodetic_deg(85.05, lon_deg + 0.05), map());
        EXPECT_TRUE(found.zone.name().starts_with("Etc/GMT")) << found.zone.name();
        EXPECT_EQ(offset_h(found.zone, 7), std::round((lon_deg + 0.05) / 15)) << lon_deg;
    }
    EXPECT_EQ(zone_at(geodetic_deg(-15, -150), map()).assumption,
              "time zone Etc/GMT+10 (-10:00) of the place");
    EXPECT_EQ(name_at(0, 0), "Etc/GMT");
}

TEST(ZoneOfPlace, TheDateLineFromBothSides) {
    EXPECT_EQ(name_at(30, 179.99), "Etc/GMT-12");
    for (const double lon_deg : {180.0, -180.0, -179.99, 180.01, 540.0})
        EXPECT_EQ(name_at(30, lon_deg), "Etc/GMT+12") << lon_deg;
    // Land goes on across the meridian, and so does its zone.
    for (const double lon_deg : {179.9, 179.99, 180.0, -180.0, -179.99, -179.0})
        EXPECT_EQ(name_at(68.0, lon_deg), "Asia/Anadyr") << lon_deg;
    EXPECT_EQ(name_at(-16.8, 179.95), "Pacific/Fiji");
    EXPECT_EQ(name_at(-16.8, -179.95), "Pacific/Fiji");
    // Longitudes may go beyond half a turn, also where nobody has brought them back.
    EXPECT_EQ(name_at(46.5, 8.5 + 360), "Europe/Zurich");
    EXPECT_EQ(name_at(36.3, 360 - 84.2), "America/New_York");
    EXPECT_EQ(map().name_at({radians(36.3), radians(360 - 84.2), 0}), "America/New_York");
    EXPECT_EQ(map().name_at({0.3, kPi, 0}), map().name_at({0.3, -kPi, 0}));
}

TEST(ZoneOfPlace, ThePolesHaveAZone) {
    for (const double lon_deg : {-180.0, -90.0, 0.0, 90.0, 179.9}) {
        EXPECT_EQ(offset_h(zone_at(geodetic_deg(90, lon_deg), map()).zone, 1),
                  std::round(lon_deg / 15))
            << lon_deg;
        EXPECT_NO_THROW(zone_at(geodetic_deg(-90, lon_deg), map()));
        EXPECT_EQ(name_at(-90, lon_deg), name_at(-89.95, lon_deg));
    }
}

TEST(ZoneOfPlace, ThisComputerKnowsEveryName) {
    std::vector<std::string> unknown;
    for (const std::string& name : map().names())
        if (!Zone::find(name)) unknown.push_back(name);
    EXPECT_EQ(map().names().size(), 434U);
    EXPECT_EQ(std::set(map().names().begin(), map().names().end()).size(), 434U);
    if (zone_database_version() >= "2025b") {  // the first with America/Coyhaique
        EXPECT_TRUE(unknown.empty()) << unknown.front();
    }
}

/// The grid outside the project is what tools/make_time_zones.py made the shipped form of.
TEST(ZoneOfPlace, IsTheGridThatItWasMadeOf) {
    SKIP_WITHOUT_TEST_DATA(outside);
    const std::vector<std::string> names =
        split(trimmed(read_text(outside / "timezones/zones.txt", "test")), '\n');
    GDALAllRegister();
    const GDALDatasetUniquePtr grid(
        GDALDataset::Open((outside / "timezones/timezones.png").c_str()));
    ASSERT_TRUE(grid);
    const int columns = grid->GetRasterXSize(), rows = grid->GetRasterYSize();
    std::vector<std::uint16_t> row(static_cast<std::size_t>(columns));
    int compared = 0;
    for (int y = 0; y < rows; y += 7) {
        ASSERT_EQ(grid->GetRasterBand(1)->RasterIO(GF_Read, 0, y, columns, 1, row.data(), columns,
                                                   1, GDT_UInt16, 0, 0),
                  CE_None);
        for (int x = y % 61; x < columns; x += 61, ++compared)
            ASSERT_EQ(name_at(90 - (y + 0.5) / 10, (x + 0.5) / 10 - 180),
                      names[row[static_cast<std::size_t>(x)]])
                << x << ' ' << y;
    }
    EXPECT_GT(compared, 15000);
}

TEST(ZoneOfPlace, IsKnownAtOnce) {
    using Clock = std::chrono::steady_clock;
    const auto took_ms = [](const auto& work) {
        const auto began = Clock::now();
        work();
        return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
    };
    std::vector<double> open_ms, look_up_ms;
    for (int i = 0; i < 30; ++i) {
        open_ms.push_back(took_ms([] { ZoneMap::shipped(); }));
        look_up_ms.push_back(took_ms([] { name_at(-89.99, 0); }));  // the longest way
    }
    test::print_accuracy("opening the map of time zones", open_ms, "ms", 10);
    test::print_accuracy("looking a zone up in it", look_up_ms, "ms", 1);
    EXPECT_LT(*std::min_element(open_ms.begin(), open_ms.end()), 10);
    EXPECT_LT(*std::min_element(look_up_ms.begin(), look_up_ms.end()), 1);
}

TEST(ZoneOfPlace, SolarNoonIsTheEquationOfTimeBeforeTwelve) {
    std::vector<double> errors_s;
    for (const double lon_deg : {-179.9, -84.2458, 0.0, 11.4041, 140.0033})
        for (int month = 1; month <= 12; ++month) {
            const geo::Geodetic place = geodetic_deg(47.2692, lon_deg);
            const Zone zone = choose_zone("solar", place).zone;
            const Instant noon =
                *day_events({2026, month, 11}, zone, place).first(EventKind::Transit);
            const CivilTime wall = zone.local(noon).wall;
            const double wall_s =
                wall.hour * 3600 + wall.minute * 60 + wall.second + wall.microsecond * 1e-6;
            const double expected_s = 12 * 3600 - position(noon, place).equation_of_time_s;
            errors_s.push_back(std::abs(wall_s - expected_s));
            // Half a second for the offset, which is one in whole seconds.
            EXPECT_LT(errors_s.back(), 0.6) << lon_deg << ' ' << month;
        }
    test::print_accuracy("noon by --tz solar against the equation of time", errors_s, "s", 0.6);
    EXPECT_EQ(choose_zone("solar", geodetic_deg(0, 8.5458)).zone.name(), "LMT+00:34:11");
    EXPECT_EQ(choose_zone(" Solar", geodetic_deg(0, -90)).zone.name(), "LMT-06:00");
    EXPECT_EQ(choose_zone("solar", geodetic_deg(0, 8.5)).assumption, "");
}

TEST(ZoneOfPlace, WordsMeanAPlacesZoneOrANamedOne) {
    const geo::Geodetic bern = geodetic_deg(46.95, 7.44);
    for (const char* const words : {"", "auto", "AUTO", " auto "}) {
        const ChosenZone chosen = choose_zone(words, bern);
        EXPECT_EQ(chosen.zone.name(), "Europe/Zurich");
        EXPECT_EQ(chosen.assumption, "time zone Europe/Zurich of the place");
    }
    EXPECT_EQ(choose_zone("America/New_York", bern).zone.name(), "America/New_York");
    EXPECT_EQ(choose_zone("America/New_York", bern).assumption, "");
    EXPECT_EQ(choose_zone("+05:30", bern).zone.name(), "+05:30");
    EXPECT_EQ(error_of([&] { choose_zone("Europe/Zurick", bern); }),
              "exit 3: time zone: Europe/Zurick: no such time zone; did you mean Europe/Zurich?");
}

/// Files that are not as tools/make_time_zones.py makes them.
class ZoneFile : public testing::Test {
  protected:
    static constexpr std::size_t kHashBytes = 8;

    std::filesystem::path write(const std::string& bytes) const {
        const std::filesystem::path path = dir_ / "zones.bin";
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    std::string error(const std::string& bytes) const {
        const std::filesystem::path path = write(bytes);
        std::string message = error_of([&] { ZoneMap::read(path); });
        const std::string begin = "exit 3: time zone: " + path.string() + ": ";
        const std::string end = "; install Relevo again, or pass --tz Europe/Zurich";
        EXPECT_TRUE(message.starts_with(begin) && message.ends_with(end)) << message;
        if (message.size() < begin.size() + end.size()) return message;
        return message.substr(begin.size(), message.size() - begin.size() - end.size());
    }
    /// FNV-1a behind the rest.
    static std::string hashed(std::string bytes) {
        std::uint64_t hash = 14695981039346656037U;
        for (const char byte : bytes) {
            hash ^= static_cast<unsigned char>(byte);
            hash *= 1099511628211U;
        }
        for (std::size_t i = 0; i < kHashBytes; ++i)
            bytes += static_cast<char>(hash >> (8 * i) & 255);
        return bytes;
    }

    std::filesystem::path dir_ = test::scratch_dir("sun_zone_file");
    std::string whole_ = read_text(share_dir() / "data/timezones/timezones.bin", "test");
};

TEST_F(ZoneFile, AZoneThatTheComputerLacksIsTheHourOfTheLongitude) {
    std::string bytes = whole_.substr(0, whole_.size() - kHashBytes);
    bytes.replace(bytes.find("Europe/Zurich"), 13, "Europe/Zurick");
    bytes.replace(bytes.find("Pacific/Auckland"), 16, "Pacific/Aukkland");
    const ZoneMap older = ZoneMap::read(write(hashed(bytes)));
    const ChosenZone bern = zone_at(geodetic_deg(46.95, 7.44), older);
    EXPECT_TRUE(bern.missing);
    EXPECT_EQ(bern.zone.name(), "UTC");
    EXPECT_EQ(
        bern.assumption,
        "time zone UTC, by longitude only: the time zone database of this computer (version " +
            zone_database_version() + ") has no Europe/Zurick");
    EXPECT_EQ(zone_at(geodetic_deg(46.55, 8.56), older).zone.name(), "+01:00");
    EXPECT_EQ(zone_at(geodetic_deg(-45.03, 168.66), older).zone.name(), "+11:00");
    EXPECT_FALSE(zone_at(geodetic_deg(48.2, 16.4), older).missing);
}

TEST_F(ZoneFile, WhatIsDamagedIsAnErrorThatNamesIt) {
    EXPECT_EQ(error_of([&] { ZoneMap::read(dir_ / "none.bin"); }),
              "exit 3: time zone: " + (dir_ / "none.bin").string() +
                  ": cannot be read, No such file or directory; install Relevo again, or pass "
                  "--tz Europe/Zurich");
    EXPECT_EQ(error(""), "damaged");
    EXPECT_EQ(error("relevo time zones 2\n"), "no map of time zones of this version");
    for (const std::size_t length :
         {std::size_t{20}, std::size_t{30}, std::size_t{5000}, whole_.size() - 1})
        EXPECT_EQ(error(whole_.substr(0, length)), "damaged") << length;
    for (std::size_t at = 20; at < whole_.size(); at += 997) {
        std::string bytes = whole_;
        bytes[at] = static_cast<char>(bytes[at] ^ 4);
        EXPECT_EQ(error(bytes), "damaged") << at;
    }
    EXPECT_EQ(error(whole_ + '\0'), "damaged");
}

TEST_F(ZoneFile, WhatIsWholeButMeansNothingIsNotRead) {
    const std::string head = "relevo time zones 1\n4 2 2\nUTC\nEurope/Zurich\n";
    using namespace std::string_literals;
    const ZoneMap small = ZoneMap::read(write(hashed(head + "\2\0\3\0\0\1\1\1\2\1\1"s)));
    EXPECT_EQ(small.name_at(geodetic_deg(45, 100)), "Europe/Zurich");
    EXPECT_EQ(small.name_at(geodetic_deg(-45, 10)), "Europe/Zurich");
    EXPECT_EQ(small.name_at(geodetic_deg(-45, 100)), "Europe/Zurich");
    EXPECT_EQ(small.name_at(geodetic_deg(-45, -10)), "UTC");
    for (const std::string& rows : {
             "\1\0\3\0\0"s,                // a cell of the first row has no zone
             "\1\0\4\2\0"s,                // no such name
             "\1\0\5\0\0"s,                // beyond the row
             "\1\0\4\0\1\4\0\0"s,          // likewise
             "\1\0\4\0"s,                  // a row too few
             "\1\0\4\0\0\0"s,              // a row too many
             "\1\0\x84\x80\x80\x80\0\0"s,  // a number that never ends
             "\6\0\4\0\0"s,                // more spans than cells
         })
        EXPECT_EQ(error(hashed(head + rows)), "damaged");
    EXPECT_EQ(error(hashed("relevo time zones 1\n4 2\n")), "damaged");
    EXPECT_EQ(error(hashed("relevo time zones 1\n4 0 1\nUTC\n")), "damaged");
    EXPECT_EQ(error(hashed("relevo time zones 1\n4 2 99999999999\nUTC\n")), "damaged");
}

TEST(IsWallTime, SaysWhatNeedsAZone) {
    for (const char* const text : {"2026-06-21T18:30", " 2026-06-21 18:30:15.5 "})
        EXPECT_TRUE(is_wall_time(text)) << text;
    for (const char* const text : {"2026-06-21T18:30Z", "2026-06-21T18:30 -03:30", "now"})
        EXPECT_FALSE(is_wall_time(text)) << text;
    EXPECT_EQ(error_of([] { is_wall_time("2026-06-31T18:30"); }),
              error_of([] { parse_time("2026-06-31T18:30"); }));
}

}  // namespace
}  // namespace relevo::sun::test_zone_of_place
