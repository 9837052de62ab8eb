#include "base/units.h"
#include "sun/event_time.h"
#include "support/support.h"

namespace relevo::sun::test_event_time {
namespace {

using test::error_of;

const Zone kZurich = Zone::named("Europe/Zurich");
const Date kMidsummer{2026, 6, 21};

TEST(EventTime, ReadsDateEventOffsetAndPlace) {
    const EventTime time = parse_event_time("2026-06-21 sunset-1h30min@46.55,8.56,1800");
    EXPECT_EQ(time.date, kMidsummer);
    EXPECT_EQ(time.event, EventKind::Sunset);
    EXPECT_EQ(time.offset_s, -5400);
    EXPECT_NEAR(degrees(time.place->place.lat_rad), 46.55, 1e-12);
    EXPECT_NEAR(degrees(time.place->place.lon_rad), 8.56, 1e-12);
    EXPECT_EQ(time.place->place.height_m, 1800);
    EXPECT_FALSE(parse_event_time("sunrise@46.55,8.56").date);
    EXPECT_EQ(parse_event_time("2026-06-21Tnoon@46.55,8.56").event, EventKind::Transit);
    EXPECT_EQ(parse_event_time(" civil_dawn @46.55, 8.56").event, EventKind::CivilDawn);
}

TEST(EventTime, KnowsEveryEvent) {
    const Date date{2026, 5, 1};  // whose events are all before midnight
    for (const auto& [name, kind] :
         {std::pair{"sunrise", EventKind::Sunrise}, std::pair{"sunset", EventKind::Sunset},
          std::pair{"noon", EventKind::Transit}, std::pair{"midnight", EventKind::LowerTransit},
          std::pair{"civil-dawn", EventKind::CivilDawn},
          std::pair{"civil-dusk", EventKind::CivilDusk},
          std::pair{"nautical-dawn", EventKind::NauticalDawn},
          std::pair{"nautical-dusk", EventKind::NauticalDusk},
          std::pair{"astronomical-dawn", EventKind::AstronomicalDawn},
          std::pair{"astronomical-dusk", EventKind::AstronomicalDusk}}) {
        const std::string text = std::string(name) + "+15min@46.55,8.56";
        const EventTime time = parse_event_time(text);
        EXPECT_EQ(time.event, kind);
        EXPECT_EQ(time.offset_s, 900);
        const Day day = day_events(date, kZurich, time.place->place);
        EXPECT_NEAR(resolve(time, date, kZurich).utc - *day.first(kind), 900, 1e-3) << name;
    }
    for (const bool last : {false, true}) {
        const EventTime time =
            parse_event_time(last ? "last-light@46.55,8.56" : "first-light@46.55,8.56");
        EXPECT_FALSE(time.event);
        EXPECT_EQ(time.last, last);
    }
}

TEST(EventTime, IsToldByItsAtOrItsEvent) {
    EXPECT_TRUE(is_event_time("sunrise@46.55,8.56"));
    EXPECT_TRUE(is_event_time("2026-06-21 civil-dusk+10min"));
    EXPECT_FALSE(is_event_time("2026-06-21T18:30+02:00"));
}

TEST(EventTime, TakesTheDateFromTheTextOrTheOption) {
    const Instant expected =
        *day_events(kMidsummer, kZurich, geo::geodetic_deg(46.55, 8.56)).first(EventKind::Sunrise);
    for (const auto& [text, given] :
         {std::pair{"2026-06-21 sunrise@46.55,8.56", std::optional<Date>()},
          std::pair{"2026-06-21 sunrise@46.55,8.56", std::optional(kMidsummer)},
          std::pair{"sunrise@46.55,8.56", std::optional(kMidsummer)}}) {
        const ParsedTime time = resolve(parse_event_time(text), given, kZurich);
        EXPECT_NEAR(time.utc - expected, 0, 1e-3);
        EXPECT_EQ(time.zone.name(), "Europe/Zurich");
    }
}

// Reykjavik has the sun until 00:03 of 22 June, and from 02:55 on (Almanak Haskola Islands, 2026).
TEST(EventTime, TheEveningOfADayMayEndAfterMidnight) {
    const Zone iceland = Zone::named("Atlantic/Reykjavik");
    const auto local = [&](const char* event) {
        return to_iso(
            resolve(parse_event_time(std::string(event) + "@64.147,-21.94"), kMidsummer, iceland)
                .utc,
            iceland);
    };
    EXPECT_EQ(local("sunset").substr(0, 15), "2026-06-22T00:0");
    EXPECT_EQ(local("sunrise").substr(0, 14), "2026-06-21T02:");
    EXPECT_EQ(local("noon").substr(0, 14), "2026-06-21T13:");
    // Dusk and dawn of a day stand about its noon likewise.
    const Zone britain = Zone::named("Europe/London");
    const auto at = [&](const char* event) {
        return resolve(parse_event_time(std::string(event) + "@54,-2"), kMidsummer, britain).utc;
    };
    EXPECT_EQ(to_iso(at("nautical-dusk"), britain).substr(0, 14), "2026-06-22T00:");
    EXPECT_EQ(to_iso(at("nautical-dawn"), britain).substr(0, 14), "2026-06-21T01:");
    EXPECT_GT(at("sunset"), at("noon"));
    EXPECT_LT(at("civil-dawn"), at("sunrise"));
    EXPECT_GT(at("nautical-dusk"), at("civil-dusk"));
}

TEST(EventTime, OfClocksFarFromTheSunsIsOnThatDate) {
    const Zone utc;
    const ParsedTime sunset =
        resolve(parse_event_time("sunset@21.3,-157.9"), kMidsummer, utc);  // Honolulu
    EXPECT_EQ(to_iso(sunset.utc, utc).substr(0, 13), "2026-06-21T05");
}

TEST(EventTime, AStepIsADurationOrMinutesAlone) {
    EXPECT_EQ(parse_step_s("3min"), 180);
    EXPECT_EQ(parse_step_s("3"), 180);
    EXPECT_EQ(parse_step_s("0.5"), 30);
    EXPECT_EQ(parse_step_s("1h30min"), 5400);
    EXPECT_EQ(parse_step_s("45s"), 45);
    for (const char* none : {"", "0", "0s", "-1", "3 minutes", "min", "nan", "inf", "3d"})
        EXPECT_EQ(parse_step_s(none), std::nullopt) << none;
}

TEST(EventTime, ErrorsSayWhatIsWrong) {
    const auto message = [](const char* text, std::optional<Date> date = kMidsummer,
                            std::optional<Zone> zone = kZurich) {
        return error_of([&] { resolve(parse_event_time(text), date, zone); });
    };
    EXPECT_EQ(message("sunrize@46.55,8.56"),
              "exit 3: time: sunrize@46.55,8.56: no such event as \"sunrize\"; did "
              "you mean sunrise?");
    EXPECT_EQ(message("tea-time@46.55,8.56"),
              "exit 3: time: tea-time@46.55,8.56: no such event as \"tea-time\", "
              "expected one of sunrise, sunset, noon, midnight, civil-dawn, civil-dusk, "
              "nautical-dawn, nautical-dusk, astronomical-dawn, astronomical-dusk, first-light, "
              "last-light");
    EXPECT_EQ(message("sunrise-30@46.55,8.56"),
              "exit 3: time: sunrise-30@46.55,8.56: offset \"-30\", expected hours, "
              "minutes or seconds such as -30min, +1h30min or +45s");
    EXPECT_EQ(message("sunrise"),
              "exit 3: time: sunrise: no place, expected one after an @ such as "
              "sunrise@46.55,8.56");
    EXPECT_EQ(
        message("sunrise@100,8.56"),
        "exit 2: --time: 100,8.56: latitude, expected -90 to 90 degrees but got 100; latitude "
        "comes first, perhaps 8.56,100");
    EXPECT_EQ(message("2026-06-21@46.55,8.56"),
              "exit 3: time: 2026-06-21@46.55,8.56: no event after the date, "
              "expected one such as 2026-06-21 sunrise@46.55,8.56");
    EXPECT_EQ(message("sunrise@46.55,8.56", std::nullopt),
              "exit 3: time: sunrise@46.55,8.56: no date; write 2026-06-21 "
              "sunrise@46.55,8.56 or pass --date");
    EXPECT_EQ(message("sunrise@46.55,8.56", kMidsummer, std::nullopt),
              "exit 3: time: sunrise@46.55,8.56: no time zone to count the day "
              "2026-06-21 by; pass --tz, as in --tz Europe/Zurich");
    EXPECT_EQ(message("2026-06-20 sunrise@46.55,8.56"),
              "exit 3: time: 2026-06-20 sunrise@46.55,8.56: contradicts --date 2026-06-21; use "
              "only one of them");
    EXPECT_EQ(message("sunset@78.2,15.6"),
              "exit 3: time: sunset@78.2,15.6: does not happen on 2026-06-21 in "
              "Europe/Zurich, the sun stays above all day");
    EXPECT_EQ(message("2026-12-21 sunrise@78.2,15.6", std::nullopt),
              "exit 3: time: 2026-12-21 sunrise@78.2,15.6: does not happen on "
              "2026-12-21 in Europe/Zurich, the sun stays below all day");
    EXPECT_EQ(message("first-light@46.55,8.56"),
              "exit 3: time: first-light@46.55,8.56: first and last light depend on the terrain; "
              "name a DEM");
    EXPECT_EQ(message("2126-06-21 sunrise@46.55,8.56", std::nullopt),
              "exit 3: time: 2126-06-21 sunrise@46.55,8.56: sun and moon are computed "
              "for the years 1900 to 2100, but got 2126");
}

}  // namespace
}  // namespace relevo::sun::test_event_time
