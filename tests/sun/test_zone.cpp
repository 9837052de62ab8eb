#include <fmt/format.h>

#include "sun/posix_rule.h"
#include "sun/tables.h"
#include "sun/zone.h"

namespace relevo::sun::test_zone {
namespace {

CivilTime civil(std::string_view text) {
    return instant_of(text).utc();
}

std::string utc_of(std::string_view text, const std::optional<Zone>& zone = std::nullopt) {
    return to_iso(parse_time(text, zone).utc, 6);
}

std::string parse_error(std::string_view text, const std::optional<Zone>& zone = std::nullopt) {
    return test::error_of([&] { parse_time(text, zone); });
}

TEST(Zone, EveryWallTimeOfTheTable) {
    OUTSIDE_ROWS(rows, csv, "timezones.csv");
    // Made with tzdata 2025b; Morocco has since given up changing its clocks (2026c).
    const bool morocco_changed = zone_database_version() >= "2026c";
    int checked = 0, unique = 0, gaps = 0, ambiguous = 0;
    for (const Row& row : rows) {
        const std::string& wall = row.text("local_wall");
        if (morocco_changed && row.text("zone") == "Africa/Casablanca" && wall > "2026-09") {
            fmt::print("not run, another law in tzdata {}: {}\n", zone_database_version(),
                       row.whole());
            continue;
        }
        const Zone zone = Zone::named(row.text("zone"));
        const int fold = row.has("fold") ? std::stoi(row.text("fold")) : 0;
        const ResolvedTime found = zone.resolve(civil(wall), fold);
        const std::string kind = found.kind == WallTimeKind::Unique        ? "unique"
                                 : found.kind == WallTimeKind::Nonexistent ? "gap"
                                                                           : "ambiguous";
        EXPECT_EQ(kind, row.text("kind")) << row.whole();
        EXPECT_EQ(to_iso(found.utc), row.text("utc") + "Z") << row.whole();
        EXPECT_EQ(found.utc_offset_s, row.number("utc_offset_s")) << row.whole();
        EXPECT_EQ(found.abbreviation, row.text("abbrev")) << row.whole();

        const LocalTime back = zone.local(found.utc);
        if (kind != "gap") {
            EXPECT_EQ(back.wall, civil(wall)) << row.whole();
            EXPECT_EQ(back.utc_offset_s, found.utc_offset_s) << row.whole();
            EXPECT_EQ(back.abbreviation, found.abbreviation) << row.whole();
        } else {
            EXPECT_NE(back.wall, civil(wall)) << row.whole();
        }
        const ParsedTime parsed = parse_time(wall, zone);
        EXPECT_EQ(parsed.utc, zone.resolve(civil(wall)).utc) << row.whole();
        EXPECT_EQ(parsed.note.empty(), kind == "unique") << row.whole();
        ++checked;
        ++(kind == "unique" ? unique : kind == "gap" ? gaps : ambiguous);
    }
    fmt::print("[ accuracy ] tzdata {}: {} wall times right: {} unique, {} in gaps, {} ambiguous\n",
               zone_database_version(), checked, unique, gaps, ambiguous);
    EXPECT_GE(checked, 340);
}

// Directive 2000/84/EC: last Sundays of March and October, 01:00 UTC. (The same rules without the
// outside table.)
TEST(Zone, SkippedAndRepeatedTimesAreSaidSo) {
    const Zone zurich = Zone::named("Europe/Zurich");
    const ParsedTime gap = parse_time("2026-03-29T02:30", zurich);
    EXPECT_EQ(gap.kind, WallTimeKind::Nonexistent);
    EXPECT_EQ(to_iso(gap.utc), "2026-03-29T01:30:00Z");
    EXPECT_EQ(gap.note,
              "2026-03-29T02:30: does not exist in Europe/Zurich (clocks went forward); taken as "
              "2026-03-29T03:30:00+02:00");
    EXPECT_EQ(to_iso(zurich.resolve(civil("2026-03-29T02:30"), 1).utc), "2026-03-29T00:30:00Z");

    const ParsedTime twice = parse_time("2026-10-25T02:30", zurich);
    EXPECT_EQ(twice.kind, WallTimeKind::Ambiguous);
    EXPECT_EQ(to_iso(twice.utc), "2026-10-25T00:30:00Z");
    EXPECT_EQ(twice.note,
              "2026-10-25T02:30: is ambiguous in Europe/Zurich (clocks went back); taken as the "
              "first (+02:00), not the second (+01:00)");
    EXPECT_EQ(to_iso(zurich.resolve(civil("2026-10-25T02:30"), 1).utc), "2026-10-25T01:30:00Z");

    const ParsedTime plain = parse_time("2026-10-25T03:00", zurich);
    EXPECT_EQ(plain.kind, WallTimeKind::Unique);
    EXPECT_EQ(plain.note, "");
    EXPECT_EQ(to_iso(plain.utc), "2026-10-25T02:00:00Z");
}

TEST(Zone, SummerTimeGoesOnAfterTheListedYears) {
    // The database lists changes until 2037; the rule goes on.
    const Zone zurich = Zone::named("Europe/Zurich");
    EXPECT_EQ(utc_of("2077-07-01T12:00", zurich), "2077-07-01T10:00:00.000000Z");
    EXPECT_EQ(utc_of("2077-12-01T12:00", zurich), "2077-12-01T11:00:00.000000Z");
    EXPECT_EQ(parse_time("2077-03-28T02:30", zurich).kind, WallTimeKind::Nonexistent);
    // South of the equator: New Zealand, last Sunday of September to first Sunday of April.
    const Zone auckland = Zone::named("Pacific/Auckland");
    EXPECT_EQ(to_iso(Instant::from_utc({{2099, 1, 10}}), auckland), "2099-01-10T13:00:00+13:00");
    EXPECT_EQ(to_iso(Instant::from_utc({{2099, 6, 10}}), auckland), "2099-06-10T12:00:00+12:00");
}

TEST(Zone, RulesOfPosixInEveryForm) {
    const auto moments = [](std::string_view rule) {
        std::string text;
        for (const OffsetChange& c : posix_rule_changes(rule, 2023, 2024))
            text += to_iso(Instant::from_unix_us(c.unix_s * 1'000'000)) + " " +
                    offset_text(c.utc_offset_s) + " " + c.abbreviation + "; ";
        return text;
    };
    EXPECT_EQ(moments("CET-1CEST,M3.5.0,M10.5.0/3"),
              "2023-03-26T01:00:00Z +02:00 CEST; 2023-10-29T01:00:00Z +01:00 CET; "
              "2024-03-31T01:00:00Z +02:00 CEST; 2024-10-27T01:00:00Z +01:00 CET; ");
    // Dublin's summer time is its standard; its winter time is an hour back.
    EXPECT_EQ(moments("IST-1GMT0,M10.5.0,M3.5.0/1"),
              "2023-03-26T01:00:00Z +01:00 IST; 2023-10-29T01:00:00Z +00:00 GMT; "
              "2024-03-31T01:00:00Z +01:00 IST; 2024-10-27T01:00:00Z +00:00 GMT; ");
    // Hours before and after the day (Nuuk, Gaza), names in brackets, half an hour (Lord Howe).
    EXPECT_EQ(moments("<-02>2<-01>,M3.5.0/-1,M10.5.0/0").substr(0, 66),
              "2023-03-26T01:00:00Z -01:00 -01; 2023-10-29T01:00:00Z -02:00 -02; ");
    EXPECT_EQ(moments("EET-2EEST,M3.4.4/50,M10.4.4/50").substr(0, 35),
              "2023-03-25T00:00:00Z +03:00 EEST; 2");
    EXPECT_EQ(moments("<+1030>-10:30<+11>-11,M10.1.0,M4.1.0").substr(0, 38),
              "2023-04-01T15:00:00Z +10:30 +1030; 202");
    // Days of the year: J60 is 1 March in every year, 60 is 1 March in leap years' 29 days only.
    EXPECT_EQ(moments("AAA0BBB,J60/0,J300/0").substr(0, 21), "2023-03-01T00:00:00Z ");
    const std::string both = moments("AAA0BBB,J60/0,J300/0");
    EXPECT_NE(both.find("2024-03-01T00:00:00Z "), std::string::npos) << both;
    EXPECT_NE(both.find("2024-10-26T23:00:00Z "), std::string::npos) << both;
    EXPECT_EQ(moments("AAA0BBB,60/0,300/0").substr(0, 21), "2023-03-02T00:00:00Z ");
    for (const char* none : {"", "UTC0", "<+0530>-5:30", "CET-1CEST", "CET-1CEST,M13.1.0,M3.1.0",
                             "CET-1CEST,M3.5.0", "C%T-1", "CET-1CEST,M3.5.0,M10.5.0x"})
        EXPECT_EQ(moments(none), "") << none;
}

TEST(Zone, LocalDaysAreAsLongAsTheClocksMakeThem) {
    const auto hours = [](const char* zone, Date date) {
        return Zone::named(zone).day(date).length_s() / 3600;
    };
    EXPECT_EQ(hours("Europe/Zurich", {2026, 6, 21}), 24);
    EXPECT_EQ(hours("Europe/Zurich", {2026, 3, 29}), 23);
    EXPECT_EQ(hours("Europe/Zurich", {2026, 10, 25}), 25);
    EXPECT_EQ(hours("Australia/Lord_Howe", {2026, 4, 5}), 24.5);
    // Sao Paulo's summer began at midnight, which did not exist.
    EXPECT_EQ(hours("America/Sao_Paulo", {2018, 11, 4}), 23);
    EXPECT_EQ(to_iso(Zone::named("America/Sao_Paulo").day({2018, 11, 4}).begin,
                     Zone::named("America/Sao_Paulo")),
              "2018-11-04T01:00:00-02:00");
    EXPECT_EQ(hours("+05:30", {2026, 6, 21}), 24);
    EXPECT_EQ(to_iso(Zone::named("+05:30").day({2026, 6, 21}).begin), "2026-06-20T18:30:00Z");
    // Samoa went over the date line.
    EXPECT_EQ(hours("Pacific/Apia", {2011, 12, 29}), 24);
    EXPECT_EQ(test::error_of([&] {
                  hours("Pacific/Apia", {2011, 12, 30});
              }),
              "exit 3: time zone: 2011-12-30: there was no such day in Pacific/Apia, its clocks "
              "skipped it");
}

TEST(Zone, NamesAndOffsets) {
    EXPECT_EQ(Zone().name(), "UTC");
    EXPECT_EQ(Zone::named("Z").name(), "UTC");
    EXPECT_EQ(Zone::named("UTC").name(), "UTC");
    EXPECT_EQ(Zone::named(" Europe/Zurich ").name(), "Europe/Zurich");
    EXPECT_EQ(Zone::named("+05:30").name(), "+05:30");
    EXPECT_EQ(Zone::named("-0330").name(), "-03:30");
    EXPECT_EQ(Zone::named("+07").name(), "+07:00");
    EXPECT_EQ(Zone::named("+00:00").name(), "UTC");
    EXPECT_EQ(Zone::named("+00:19:32").name(), "+00:19:32");
    const LocalTime kathmandu =
        Zone::named("Asia/Kathmandu").local(Instant::from_utc({{2026, 6, 21}}));
    EXPECT_EQ(kathmandu.wall, (CivilTime{{2026, 6, 21}, 5, 45}));
    EXPECT_EQ(kathmandu.abbreviation, "+0545");
    EXPECT_NE(zone_database_version(), "unknown");
}

TEST(Zone, UnknownZonesAreErrorsWithTheNearestName) {
    const auto error = [](std::string_view text) {
        return test::error_of([&] { Zone::named(text); });
    };
    for (const std::string text : {"Europe/Zuric", "europe/zurich", "Zurich", "Zürich"})
        EXPECT_EQ(error(text), "exit 3: time zone: " + text +
                                   ": no such time zone; did you mean Europe/Zurich?");
    EXPECT_EQ(error("new york"),
              "exit 3: time zone: new york: no such time zone; did you mean America/New_York?");
    EXPECT_EQ(error("OSLO"),
              "exit 3: time zone: OSLO: no such time zone; did you mean Europe/Oslo?");
    EXPECT_EQ(error("Middle-earth/Shire"),
              "exit 3: time zone: Middle-earth/Shire: no such time zone, expected a name of the "
              "IANA database such as Europe/Zurich or an offset such as +02:00");
    EXPECT_EQ(error(""),
              "exit 3: time zone: : no time zone, expected a name such as Europe/Zurich "
              "or an offset");
    for (const std::string text : {"+5", "+05:3", "+05:30x", "-", "+ab:00"})
        EXPECT_EQ(error(text),
                  "exit 3: time zone: " + text + ": bad offset, expected +hh:mm such as +02:00");
    for (const std::string text : {"+24:00", "-05:60", "+9900"})
        EXPECT_EQ(error(text),
                  "exit 3: time zone: " + text + ": bad offset, expected at most 23:59 either way");
}

TEST(ParseTime, ReadsIso8601) {
    EXPECT_EQ(utc_of("2026-06-21T18:30+02:00"), "2026-06-21T16:30:00.000000Z");
    EXPECT_EQ(utc_of("2026-06-21T18:30:15.25Z"), "2026-06-21T18:30:15.250000Z");
    EXPECT_EQ(utc_of("2026-06-21 18:30:15,1234567-0330"), "2026-06-21T22:00:15.123457Z");
    EXPECT_EQ(utc_of("2026-06-21 18:30:15 +02"), "2026-06-21T16:30:15.000000Z");
    EXPECT_EQ(utc_of("2026-06-21t18:30z"), "2026-06-21T18:30:00.000000Z");
    EXPECT_EQ(utc_of(" 2026-06-21T00:10+05:45\n"), "2026-06-20T18:25:00.000000Z");
    EXPECT_EQ(utc_of("1910-06-21T12:00+00:34:08"), "1910-06-21T11:25:52.000000Z");
    EXPECT_EQ(utc_of("2026-06-21T18:30", Zone::named("Europe/Zurich")),
              "2026-06-21T16:30:00.000000Z");
    EXPECT_EQ(utc_of("2026-06-21T18:30", Zone::named("+05:30")), "2026-06-21T13:00:00.000000Z");
    EXPECT_EQ(utc_of("2016-12-31T23:59:59.999999Z"), "2016-12-31T23:59:59.999999Z");

    const double age_s = Instant::now() - parse_time("now").utc;
    EXPECT_GE(age_s, 0);
    EXPECT_LT(age_s, 10);
}

TEST(ParseTime, RemembersTheZoneForShowingResults) {
    EXPECT_EQ(parse_time("2026-06-21T18:30+02:00").zone.name(), "+02:00");
    EXPECT_EQ(parse_time("2026-06-21T18:30Z").zone.name(), "UTC");
    const Zone zurich = Zone::named("Europe/Zurich");
    // UTC goes with every zone, and an offset with the zone that has it.
    const ParsedTime utc = parse_time("2026-06-21T16:30Z", zurich);
    EXPECT_EQ(to_iso(utc.utc, utc.zone), "2026-06-21T18:30:00+02:00");
    EXPECT_EQ(parse_time("2026-06-21T18:30+02:00", zurich).zone.name(), "Europe/Zurich");
    // An offset tells the two apart, so there is nothing to note.
    EXPECT_EQ(utc_of("2026-10-25T02:30+01:00", zurich), "2026-10-25T01:30:00.000000Z");
    EXPECT_EQ(parse_time("2026-10-25T02:30+01:00", zurich).note, "");
}

TEST(ParseTime, ATimeWithoutAZoneIsAnError) {
    EXPECT_EQ(parse_error("2026-06-21T18:30"),
              "exit 3: time: 2026-06-21T18:30: no time zone; write 2026-06-21T18:30Z for "
              "UTC or 2026-06-21T18:30+02:00, or pass --tz Europe/Zurich");
    EXPECT_EQ(parse_error(" 2026-06-21 18:30:15.5 "),
              "exit 3: time: 2026-06-21 18:30:15.5: no time zone; write 2026-06-21 "
              "18:30:15.5Z for UTC or 2026-06-21 18:30:15.5+02:00, or pass --tz Europe/Zurich");
}

TEST(ParseTime, AnOffsetThatTheZoneDoesNotHaveIsAnError) {
    EXPECT_EQ(parse_error("2026-06-21T18:30+01:00", Zone::named("Europe/Zurich")),
              "exit 3: time: 2026-06-21T18:30+01:00: offset +01:00 contradicts Europe/Zurich, "
              "expected +02:00 (CEST); use only one of them");
    EXPECT_EQ(parse_error("2026-06-21T18:30+01:00", Zone::named("+05:30")),
              "exit 3: time: 2026-06-21T18:30+01:00: offset +01:00 contradicts +05:30, expected "
              "+05:30 (+05:30); use only one of them");
}

TEST(ParseTime, ImpossibleTimesAreErrors) {
    EXPECT_EQ(parse_error("2026-02-30T12:00Z"),
              "exit 3: time: 2026-02-30T12:00Z: no such date, expected day 1 to 28 of "
              "2026-02 but got 30");
    EXPECT_EQ(parse_error("2026-06-21T24:00Z"),
              "exit 3: time: 2026-06-21T24:00Z: no such hour, expected hour 0 to 23 but "
              "got 24");
    EXPECT_EQ(parse_error("2026-06-21T12:60Z"),
              "exit 3: time: 2026-06-21T12:60Z: no such minute, expected minute 0 to 59 "
              "but got 60");
    EXPECT_EQ(parse_error("2026-06-21T12:00:61Z"),
              "exit 3: time: 2026-06-21T12:00:61Z: no such second, expected second 0 to "
              "59 but got 61");
    EXPECT_EQ(parse_error("2016-12-31T23:59:60Z"),
              "exit 3: time: 2016-12-31T23:59:60Z: leap seconds cannot be given; take "
              "second 59, or 00 of the next minute");
    EXPECT_EQ(parse_error("1899-12-31T12:00Z"),
              "exit 3: time: 1899-12-31T12:00Z: sun and moon are computed for the years 1900 "
              "to 2100, but got 1899");
    EXPECT_EQ(parse_error("2101-01-01T00:00Z"),
              "exit 3: time: 2101-01-01T00:00Z: sun and moon are computed for the years 1900 "
              "to 2100, but got 2101");
    EXPECT_EQ(parse_error("2026-06-21"),
              "exit 3: time: 2026-06-21: no time of day, expected one such as T18:30 "
              "after it");
    EXPECT_EQ(parse_error("2026-06-21T18:30+2"),
              "exit 3: time: 2026-06-21T18:30+2: bad offset, expected +hh:mm such as "
              "+02:00");
    EXPECT_EQ(parse_error("2026-06-21T18:30+25:00"),
              "exit 3: time: 2026-06-21T18:30+25:00: bad offset, expected at most 23:59 "
              "either way");
    for (const std::string text :
         {"noon", "21.6.2026 18:30", "18:30", "2026-06-21T18", "2026-06-21T18:3Z",
          "2026-06-21T18:30:5Z", "2026-06-21T18:30:15.Z", "2026-06-21T18:30Zulu",
          "2026-06-21T18:30 CEST", "2026-06-21x18:30Z", "20260621T1830Z", "-2026-06-21T18:30Z"})
        EXPECT_EQ(parse_error(text),
                  "exit 3: time: " + text +
                      ": not a time, expected YYYY-MM-DDThh:mm with Z or an offset, such as "
                      "2026-06-21T18:30+02:00");
}

}  // namespace
}  // namespace relevo::sun::test_zone
