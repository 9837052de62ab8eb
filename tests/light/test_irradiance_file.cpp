#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "light/plane/irradiance_file.h"
#include "support/support.h"

namespace relevo::light::test_irradiance_file {
namespace {

std::string file(const std::string& text, const std::string& name = "table.csv") {
    const std::filesystem::path path = test::scratch_dir() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

IrradianceTable read(const std::string& text, const IrradianceOptions& options = {}) {
    return read_irradiance(file(text), "--irradiance", options);
}

/// What is wrong with a table, without its path.
std::string fault(const std::string& text, const IrradianceOptions& options = {}) {
    const std::string path = file(text);
    std::string error = test::error_of([&] { read_irradiance(path, "--irradiance", options); });
    if (const auto at = error.find(path); at != error.npos) error.erase(at, path.size() + 2);
    return error;
}

constexpr const char* kEpwRest = "?9,1,1,50,90000,0,0,300";

std::string epw_row(const char* stamp, const char* values) {
    return fmt::format("{},{},{},0,0,0\n", stamp, kEpwRest, values);
}

std::string epw(const std::string& rows, const char* leap = "No") {
    return fmt::format(
        "LOCATION,Town,ST,CTY,TMY3,1,39.833,-104.65,-7.0,1650.0\r\n"
        "HOLIDAYS/DAYLIGHT SAVINGS,{},0,0,0\r\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\r\n{}",
        leap, rows);
}

std::string iso(sun::Instant utc, const IrradianceTable& table) {
    return sun::to_iso(utc, table.clock);
}

TEST(IrradianceFile, AnEpwRowEndsAtItsStamp) {
    const IrradianceTable table =
        read(epw(epw_row("1995,1,31,23,60", "1,2,3") + epw_row("1995,1,31,24,60", "100,200,30") +
                 epw_row("2003,2,1,1,60", "0,0,0")));
    ASSERT_EQ(table.rows.size(), 3U);
    EXPECT_EQ(iso(table.rows[1].span.begin, table), "1995-01-31T23:00:00-07:00");
    EXPECT_EQ(iso(table.rows[1].span.end, table), "1995-02-01T00:00:00-07:00");
    EXPECT_EQ(table.rows[1].ghi, 100);
    EXPECT_EQ(table.rows[1].dni, 200);
    EXPECT_EQ(table.rows[1].dhi, 30);
    EXPECT_EQ(table.rows[1].line, 5U);
    EXPECT_TRUE(table.typical);
    EXPECT_FALSE(table.instant_s);
    ASSERT_TRUE(table.place);
    EXPECT_EQ(table.place->height_m, 1650);
}

TEST(IrradianceFile, WhatIsWrongWithAnEpwIsNamed) {
    const std::string first = epw_row("1995,1,1,1,0", "0,0,0");
    EXPECT_EQ(fault(epw(first + epw_row("1995,1,1,2,0", "0,9999,0"))),
              "exit 3: --irradiance: line 5: dni 9999: a missing value; fill it in");
    EXPECT_EQ(fault(epw(first + epw_row("1995,1,1,2,0", "0,0,-3"))),
              "exit 3: --irradiance: line 5: dhi -3: negative, expected 0 W/m2 or more");
    EXPECT_EQ(fault(epw(first + epw_row("1995,1,1,3,0", "0,0,0"))),
              "exit 3: --irradiance: line 5: a gap: begins 1995-01-01T02:00:00-07:00, but the row "
              "above it ends 1995-01-01T01:00:00-07:00");
    EXPECT_EQ(fault(epw(first + first)),
              "exit 3: --irradiance: line 5: 1995-01-01T00:00:00-07:00 comes twice");
    EXPECT_EQ(
        fault(epw(first + epw_row("1995,1,1,2,60", "0,0,0"))),
        "exit 3: --irradiance: line 5: minutes 0 and 60 in one file: which hours its rows are "
        "is not known");
    EXPECT_EQ(fault(epw(epw_row("1995,1,1,1,30", "0,0,0"))),
              "exit 3: --irradiance: line 4: minute 30, expected 0 or 60 in all rows");
    EXPECT_EQ(fault(epw(epw_row("1995,2,30,1,0", "0,0,0"))).find("line 4") == std::string::npos,
              false);
    EXPECT_EQ(fault(epw("")), "exit 3: --irradiance: no rows of irradiance");
}

TEST(IrradianceFile, LeapDaysAreOfYearsThatHaveThem) {
    std::string day;
    for (int hour = 1; hour <= 24; ++hour)
        day += epw_row(fmt::format("2020,2,29,{},0", hour).c_str(), "0,0,0");
    EXPECT_EQ(read(epw(day, "Yes")).rows.size(), 24U);
    EXPECT_EQ(fault(epw(day)),
              "exit 3: --irradiance: line 4: 29 February in a year without it by its header: "
              "24 rows; remove that day");
    EXPECT_EQ(fault(epw(day + epw_row("1999,3,1,1,0", "0,0,0"), "Yes")),
              "exit 3: --irradiance: line 4: 29 February in a typical year: 25 rows; remove that "
              "day");
}

TEST(IrradianceFile, PvgisNamesInstants) {
    const IrradianceTable csv = read(
        "Latitude (decimal degrees): 45.000\r\nLongitude (decimal degrees): 8.000\r\n"
        "Elevation (m): 250.0\r\nIrradiance Time Offset (h): 0.1761\r\nmonth,year\r\n1,2018\r\n"
        "time(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m,WD10m,SP\r\n"
        "20180131:2300,2,94,1.0,-0.0,1.0,283,1,257,99870\r\n"
        "20070201:0000,2,95,0.0,2.5,0.0,291,1,258,99800\r\n\r\nT2m: 2-m air temperature\r\n");
    ASSERT_EQ(csv.rows.size(), 2U);
    EXPECT_EQ(iso(csv.rows[0].span.begin, csv), "2018-01-31T23:00:00+00:00");
    EXPECT_NEAR(*csv.instant_s, 0.1761 * 3600, 1e-9);
    EXPECT_EQ(csv.rows[1].dni, 2.5);
    EXPECT_TRUE(csv.typical);
    const char* json =
        R"j({"inputs": {"location": {"latitude": 45.0, "longitude": 8.0, "elevation": 250.0,
        "irradiance_time_offset": 0.1761}}, "outputs": {"tmy_hourly": [
        {"time(UTC)": "20180131:2300", "G(h)": 1.0, "Gb(n)": 0.0, "Gd(h)": 1.0},
        {"time(UTC)": "20070201:0000", "G(h)": 0.0, "Gb(n)": %, "Gd(h)": 0.0}]}})j";
    const auto with = [&](const std::string& value) {
        std::string text = json;
        return text.replace(text.find('%'), 1, value);
    };
    const IrradianceTable same = read(with("2.5"));
    EXPECT_EQ(same.rows[1].span.begin, csv.rows[1].span.begin);
    EXPECT_EQ(same.rows[1].dni, 2.5);
    EXPECT_EQ(same.instant_s, csv.instant_s);
    EXPECT_EQ(fault(with("-1")),
              "exit 3: --irradiance: entry 2: dni -1: negative, expected 0 W/m2 or more");
    EXPECT_EQ(fault(with("\"x\"")).rfind("exit 3: --irradiance: not a typical year of PVGIS", 0),
              0U);
}

TEST(IrradianceFile, AnNsrdbRowIsAnInstantOfItsHour) {
    const IrradianceTable nsrdb = read(
        "Source,Location ID,Latitude,Longitude,Time Zone,Elevation,Local Time Zone\n"
        "NSRDB,149190,40.01,-105.27,-7,1628,-7\nYear,Month,Day,Hour,Minute,DHI,DNI,GHI\n"
        "2020,1,1,8,30,39,1,40\n2020,1,1,9,30,100,4,101\n");
    EXPECT_EQ(iso(nsrdb.rows[0].span.begin, nsrdb), "2020-01-01T08:00:00-07:00");
    EXPECT_EQ(*nsrdb.instant_s, 1800);
    EXPECT_EQ(nsrdb.rows[1].ghi, 101);
    EXPECT_EQ(nsrdb.rows[1].dhi, 100);
}

TEST(IrradianceFile, APlainCsvSaysWhatItsTimesAre) {
    const std::string text =
        "# remark\ntime;dhi;ghi;dni\n2026-06-21T10:00+02:00;1;2;3\n2026-06-21T10:15+02:00;1;2;3\n";
    const auto table = [&](const char* interval) {
        return read(text, {.interval = RowTime::parse(interval), .zone = {}});
    };
    EXPECT_EQ(iso(table("end").rows[0].span.begin, table("end")), "2026-06-21T09:45:00+02:00");
    EXPECT_EQ(iso(table("begin").rows[0].span.begin, table("end")), "2026-06-21T10:00:00+02:00");
    EXPECT_EQ(table("begin").rows[0].dni, 3);
    EXPECT_EQ(*table("instant+0.1").instant_s, 360);
    EXPECT_FALSE(RowTime::parse("instant+1"));
    EXPECT_FALSE(RowTime::parse("middle"));
    EXPECT_EQ(fault(text),
              "exit 2: --interval: missing; a CSV with a column time needs end, begin or instant");
    const IrradianceTable both =
        read("begin,end,ghi,dni,dhi\n2026-06-21T10:00Z,2026-06-21T10:30Z,1,2,3\n");
    EXPECT_EQ(both.rows[0].span.length_s(), 1800);
}

TEST(IrradianceFile, WhatIsWrongWithAPlainCsvIsNamed) {
    const auto wrong = [](const std::string& rows, const char* interval = "begin",
                          const std::optional<sun::Zone>& zone = {}) {
        return fault("time,ghi,dni,dhi\n" + rows, {RowTime::parse(interval), zone});
    };
    EXPECT_EQ(
        wrong("2026-06-21T10:00+02:00,1,1,1\n2026-06-21T11:00+01:00,1,1,1\n"),
        "exit 3: --irradiance: line 3: time 2026-06-21T11:00+01:00 is of another zone than in "
        "line 2, expected one offset in all rows");
    EXPECT_EQ(wrong("2026-06-21T10:00,1,1,1\n"),
              "exit 3: --irradiance: line 2: time 2026-06-21T10:00 without an offset; write "
              "2026-06-21T10:00+01:00, or pass --tz");
    EXPECT_EQ(wrong("2026-06-21T10:00,1,x,1\n", "begin", sun::Zone()),
              "exit 3: --irradiance: line 2: \"x\", expected a number");
    EXPECT_EQ(wrong("2026-06-21T10:00Z,1,1,1\n2026-06-21T13:00Z,1,1,1\n"),
              "exit 3: --irradiance: line 2: 3 h long, expected an hour or less");
    EXPECT_EQ(wrong("2026-06-21T10:00Z,1,1,3000\n"),
              "exit 3: --irradiance: line 2: dhi 3000: expected at most 2500 W/m2");
    EXPECT_EQ(fault("when,ghi\n", {RowTime::parse("end"), {}}),
              "exit 3: --irradiance: no column time, expected a line that names it");
    // Instants far apart stand for themselves.
    const IrradianceTable sparse =
        read("time,ghi,dni,dhi\n2026-06-21T10:00Z,1,1,1\n2026-06-25T13:00Z,1,1,1\n",
             {RowTime::parse("instant"), {}});
    EXPECT_TRUE(sparse.sparse);
    EXPECT_EQ(wrong("2026-06-21T10:00Z,1,1,1\n2026-06-21T11:00Z,1,1,1\n2026-06-21T13:00Z,1,1,1\n",
                    "instant")
                  .substr(0, 42),
              "exit 3: --irradiance: line 4: a gap: begin");
}

}  // namespace
}  // namespace relevo::light::test_irradiance_file
