#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "base/text.h"
#include "base/units.h"
#include "sun/events.h"
#include "sun/position.h"
#include "sun/tables.h"

namespace relevo::sun::test_events {
namespace {

Date date_of(std::string_view text) {
    return instant_of(std::string(text.substr(0, 10)) + "T00:00").utc().date;
}

std::optional<EventKind> kind_of(std::string_view name) {
    for (int k = 0; k <= static_cast<int>(EventKind::LowerTransit); ++k)
        if (name_of(static_cast<EventKind>(k)) == name) return static_cast<EventKind>(k);
    return std::nullopt;
}

Zone zone_of(const Row& row) {
    return Zone::fixed(static_cast<int>(row.number("zone_hours") * 3600));
}

TEST(Events, AgreeWithDe431) {
    OUTSIDE_ROWS(rows, csv, "generated_events.csv");
    Accuracy steady("DE431 1900-2100, events", "s", 0.1);
    Accuracy grazing("DE431 1900-2100, events rising slower than 2 arcsec/s", "s", 1);
    Accuracy transit("DE431 1900-2100, transits", "s", 0.1);
    Accuracy azimuth("DE431 1900-2100, azimuth at events", "arcsec", 1);
    std::map<std::string, std::vector<Row>> days;
    for (const Row& row : rows)
        days[row.text("place") + row.text("date_local")].push_back(row);
    int all_day = 0;
    for (const auto& [name, of_day] : days) {
        const Row& first = of_day.front();
        EarthOrientation earth;
        const Date date = date_of(first.text("date_local"));
        if (first.text("scale") == "UTC") {
            earth.ut1_minus_utc_s = first.number("dut1_s");
            earth.tt_minus_utc_s = first.number("delta_t_s") + first.number("dut1_s");
        } else {
            earth.tt_minus_utc_s = first.number("delta_t_s");
        }
        const geo::Geodetic place = first.place();
        const Day day = day_events(date, zone_of(first), place, {}, EarthRotation::fixed(earth));

        std::map<EventKind, std::vector<const Row*>> expected;
        for (const Row& row : of_day) {
            const std::string& event = row.text("event");
            if (const auto kind = kind_of(event)) {
                expected[*kind].push_back(&row);
                continue;
            }
            const Crossing want =
                event.ends_with("above_all_day") ? Crossing::AboveAllDay : Crossing::BelowAllDay;
            const Crossing got = event.starts_with("sun")        ? day.sun
                                 : event.starts_with("civil")    ? day.civil
                                 : event.starts_with("nautical") ? day.nautical
                                                                 : day.astronomical;
            EXPECT_EQ(got, want) << row.whole();
            ++all_day;
        }
        for (int k = 0; k < static_cast<int>(EventKind::LowerTransit); ++k) {
            const EventKind kind = static_cast<EventKind>(k);
            // At the pole itself, the table has no meridian; the program has that of the longitude.
            if (kind == EventKind::Transit && std::abs(first.number("lat_deg")) == 90) continue;
            const std::vector<Instant> found = day.all(kind);
            const auto& wanted = expected[kind];
            ASSERT_EQ(found.size(), wanted.size()) << name << " " << name_of(kind);
            for (std::size_t i = 0; i < found.size(); ++i) {
                const Row& row = *wanted[i];
                const double error_s = found[i] - instant_of(row.text("time_ut"));
                if (kind == EventKind::Transit) {
                    transit.add(error_s, row);
                    continue;
                }
                (std::abs(rate_arcsec_s(found[i], place)) < 2 ? grazing : steady).add(error_s, row);
                for (const Event& event : day.events)
                    if (event.utc == found[i] && event.kind == kind)
                        azimuth.add(
                            angle_between_deg(degrees(event.azimuth_rad), row.number("az_deg")) *
                                3600,
                            row);
            }
        }
    }
    fmt::print("[ accuracy ] DE431 1900-2100: {} days on which a threshold is not crossed\n",
               all_day);
    EXPECT_GT(all_day, 100);
}

class EventTables : public SunTables {};

TEST_P(EventTables, UsnoMinuteTables) {
    std::map<std::string, std::vector<Row>> places;
    int outside_years = 0;
    for (const Row& row : rows("usno_riseset.csv")) {
        const std::string& date = row.text("date_zone");
        if (date < "1900") {
            EXPECT_EQ(test::error_of([&] { parse_date(date); }),
                      "exit 3: date: " + date +
                          ": sun and moon are computed for the years 1900 to 2100, but got 1750");
            ++outside_years;
            continue;
        }
        places[row.text("place")].push_back(row);
    }
    EXPECT_GT(outside_years, 0);

    Accuracy minutes("USNO rise, set, civil twilight, " + GetParam(), "min", 1);
    Accuracy polar("USNO within two degrees of the pole, " + GetParam(), "min", 5);
    int same = 0, all = 0, all_day = 0;
    for (const auto& [name, of_place] : places) {
        const geo::Geodetic place = of_place.front().place();
        const bool at_pole = std::abs(degrees(place.lat_rad)) > 88;
        std::set<Date> dates;
        for (const Row& row : of_place)
            dates.insert(date_of(row.text("date_zone")));
        // A day more at both ends, for events that the minute moves over midnight.
        std::map<Date, Day> days;
        for (Day& day : day_events(add_days(*dates.begin(), -1), add_days(*dates.rbegin(), 1),
                                   zone_of(of_place.front()), place))
            days[day.date] = std::move(day);

        for (const Row& row : of_place) {
            const Date date = date_of(row.text("date_zone"));
            const Day& day = days.at(date);
            const std::string& event = row.text("event");
            const auto kind = kind_of(event);
            if (!kind) {
                const Crossing got = event.find("civil") != std::string::npos ? day.civil : day.sun;
                const bool up = event.starts_with("up") || event.starts_with("above");
                EXPECT_EQ(got, up ? Crossing::AboveAllDay : Crossing::BelowAllDay) << row.whole();
                ++all_day;
                continue;
            }
            const Instant printed =
                instant_of(row.text("date_zone") + "T" + row.text("time_hhmm_zone")) -
                row.number("zone_hours") * 3600;
            double nearest_s = 1e9;
            for (const int shift : {-1, 0, 1})
                for (const Instant t : days.at(add_days(date, shift)).all(*kind))
                    if (std::abs(t - printed) < std::abs(nearest_s)) nearest_s = t - printed;
            // To the nearest minute, as the Observatory does.
            const double error_min = std::round(nearest_s / 60);
            (at_pole ? polar : minutes).add(error_min, row);
            if (!at_pole) {
                ++all;
                same += error_min == 0;
            }
        }
        if (GetParam() == "outside") {
            // Nothing is found that the Observatory does not have.
            std::map<EventKind, std::vector<Instant>> printed;
            for (const Row& row : of_place)
                if (const auto kind = kind_of(row.text("event")))
                    printed[*kind].push_back(
                        instant_of(row.text("date_zone") + "T" + row.text("time_hhmm_zone")) -
                        row.number("zone_hours") * 3600);
            // Of Longyearbyen 2023 the table has twilight only.
            const auto has_year = [&](EventKind kind, int year) {
                return std::any_of(printed[kind].begin(), printed[kind].end(),
                                   [&](Instant t) { return t.utc().date.year == year; });
            };
            for (const Date date : dates)
                for (const EventKind kind : {EventKind::Sunrise, EventKind::Sunset})
                    for (const Instant t : days.at(date).all(kind))
                        EXPECT_TRUE(!has_year(kind, date.year) ||
                                    std::any_of(printed[kind].begin(), printed[kind].end(),
                                                [&](Instant p) {
                                                    return std::abs(p - t) < (at_pole ? 330 : 90);
                                                }))
                            << name << " " << name_of(kind) << " " << to_iso(t);
        }
    }
    fmt::print(
        "[ accuracy ] USNO minutes, {}: {} of {} the same minute ({:.2f} %), {} days up or "
        "down all day\n",
        GetParam(), same, all, 100.0 * same / all, all_day);
    EXPECT_GE(same, 0.97 * all);
    EXPECT_GT(all_day, 0);
}

TEST_P(EventTables, NrelSpaRiseTransitSet) {
    // The report (A.2) takes the geocentric sun, without its 8.8 arcsec of parallax, and one step
    // of Newton's method from its place at 0 h, which tells where the sun rises slowly, at 78
    // degrees.
    Accuracy rise("NREL spa.c sunrise and sunset, Singapore, " + GetParam(), "s", 2);
    Accuracy slow("NREL spa.c sunrise and sunset, Longyearbyen, " + GetParam(), "s", 10);
    Accuracy transit("NREL spa.c transit, " + GetParam(), "s", 1.5);
    DayOptions options;
    options.rule = RiseRule::at_center_elevation(radians(-0.5667 - 0.26667));
    for (const Row& row : rows("spa_c_riseset.csv")) {
        const Date date = date_of(row.text("date_ut"));
        if (date.year > kLastYear) continue;
        EarthOrientation earth;
        earth.tt_minus_utc_s = row.number("delta_t_s");
        const std::vector<Day> days = day_events(add_days(date, -1), add_days(date, 1), Zone(),
                                                 row.place(), options, EarthRotation::fixed(earth));
        for (const auto& [column, kind] : {std::pair("sunrise_ut", EventKind::Sunrise),
                                           std::pair("transit_ut", EventKind::Transit),
                                           std::pair("sunset_ut", EventKind::Sunset)}) {
            if (!row.has(column)) {
                EXPECT_NE(days[1].sun, Crossing::Crosses) << row.whole();
                continue;
            }
            const Instant printed =
                instant_of(row.text("date_ut").substr(0, 11) + row.text(column));
            const std::vector<Instant> found = days[1].all(kind);
            ASSERT_EQ(found.size(), 1U) << row.whole();
            (kind == EventKind::Transit             ? transit
             : std::abs(row.number("lat_deg")) > 70 ? slow
                                                    : rise)
                .add(found[0] - printed, row);
        }
    }
}

TEST_P(EventTables, PublishedExamples) {
    Accuracy seconds("NREL SPA calculator, rise, transit, set, " + GetParam(), "s", 2);
    Accuracy minutes("USNO twilights, " + GetParam(), "min", 1);
    int same = 0, all = 0;
    for (const Row& row : rows("published_examples.csv")) {
        const auto kind = kind_of(row.text("quantity"));
        if (!kind) continue;
        // "2015-01-02 lat 39.742476 lon -105.1786", "07:21:55" or "+00:18" of the next day.
        const std::vector<std::string> words = split(row.text("input"), ' ');
        ASSERT_EQ(words.size(), 5U) << row.whole();
        const geo::Geodetic place{radians(*parse_number(words[2])),
                                  radians(*parse_number(words[4])), 0};
        const bool golden = row.text("case").starts_with("Golden");
        const Zone zone = Zone::fixed(golden ? -7 * 3600 : 0);
        Date date = date_of(words[0]);
        std::string time = row.text("value");
        if (time.starts_with("+")) {
            date = add_days(date, 1);
            time.erase(0, 1);
        }
        time = time.substr(time.find(' ') + 1);
        const bool to_seconds = time.size() == 8;
        DayOptions options;
        EarthRotation rotation = EarthRotation::built_in();
        if (to_seconds) {
            // The calculator's rule and its TT-UT1.
            options.rule = RiseRule::at_center_elevation(radians(-0.5667 - 0.26667));
            EarthOrientation earth;
            earth.tt_minus_utc_s = 65;
            rotation = EarthRotation::fixed(earth);
        }
        Instant printed = parse_time(to_string(date) + "T" + time, zone).utc;
        // The calculator works by UT days, and prints the sunset of the evening before.
        if (time == "19:13:58" && golden) {
            date = add_days(date, -1);
            printed = printed - kDay_s;
        }
        std::vector<Instant> found = day_events(date, zone, place, options, rotation).all(*kind);
        ASSERT_FALSE(found.empty()) << row.whole();
        // A UT day in America may have two dusks.
        std::sort(found.begin(), found.end(), [&](Instant a, Instant b) {
            return std::abs(a - printed) < std::abs(b - printed);
        });
        if (to_seconds) {
            seconds.add(found[0] - printed, row);
        } else {
            // To the nearest minute; the site with Orlando's twilights cuts.
            const double exact_min = (found[0] - printed) / 60;
            const double error_min = row.text("case").starts_with("Orlando")
                                         ? std::floor(exact_min)
                                         : std::round(exact_min);
            minutes.add(error_min, row);
            ++all;
            same += error_min == 0;
        }
    }
    EXPECT_GE(same, all - 1);
    fmt::print("[ accuracy ] USNO twilights, {}: {} of {} the same minute\n", GetParam(), same,
               all);
}

INSTANTIATE_TEST_SUITE_P(Sun, EventTables, testing::Values("published", "outside"),
                         [](const auto& set) { return set.param; });

const Zone kZurich = Zone::named("Europe/Zurich");
const geo::Geodetic kBern{radians(46.951), radians(7.4386), 560};
const geo::Geodetic kSvalbard{radians(78.2232), radians(15.6267), 20};

TEST(Events, ComeInTheOrderOfAnOrdinaryDay) {
    const Day day = day_events({2026, 9, 21}, kZurich, kBern);
    std::string order;
    for (const Event& event : day.events)
        order += std::string(name_of(event.kind)) + " ";
    EXPECT_EQ(order,
              "lower_transit astronomical_dawn nautical_dawn civil_dawn sunrise transit sunset "
              "civil_dusk nautical_dusk astronomical_dusk ");
    EXPECT_EQ(day.date, (Date{2026, 9, 21}));
    EXPECT_EQ(day.span.length_s(), 86400);
    EXPECT_EQ(day.sun, Crossing::Crosses);
    EXPECT_EQ(day.definition,
              "sunrise and sunset: centre of the sun 50 arc-minutes below the horizon, without "
              "refraction (U.S. Naval Observatory)");
    EXPECT_NEAR(day.day_length_s, *day.first(EventKind::Sunset) - *day.first(EventKind::Sunrise),
                1e-6);
    EXPECT_FALSE(day_events({2026, 6, 21}, kZurich, kSvalbard).first(EventKind::Sunrise));
}

TEST(Events, AreWhereThePositionSaysThem) {
    const Day day = day_events({2026, 11, 21}, kZurich, kBern);
    for (const Event& event : day.events) {
        const Position p = position(event.utc, kBern);
        EXPECT_NEAR(angle_between_deg(degrees(event.azimuth_rad), degrees(p.azimuth_rad)) * 3600, 0,
                    0.01)
            << name_of(event.kind);
        EXPECT_NEAR(event.elevation_rad / kArcsecond_rad, p.elevation_rad / kArcsecond_rad, 0.005)
            << name_of(event.kind);
        const double el_deg = degrees(p.elevation_rad);
        switch (event.kind) {
            case EventKind::Sunrise:
            case EventKind::Sunset:
                EXPECT_NEAR(el_deg, -50.0 / 60, 0.01 / 3600);
                break;
            case EventKind::Transit:
                EXPECT_NEAR(degrees(p.azimuth_rad), 180, 0.01 / 3600);
                EXPECT_NEAR(p.hour_angle_rad / kArcsecond_rad, 0, 0.5);  // of the pole, 0.4
                break;
            case EventKind::LowerTransit:
                EXPECT_NEAR(std::remainder(degrees(p.azimuth_rad), 360), 0, 0.01 / 3600);
                break;
            case EventKind::AstronomicalDawn:
            case EventKind::AstronomicalDusk:
                EXPECT_NEAR(el_deg, -18, 0.01 / 3600);
                break;
            case EventKind::NauticalDawn:
            case EventKind::NauticalDusk:
                EXPECT_NEAR(el_deg, -12, 0.01 / 3600);
                break;
            default:
                EXPECT_NEAR(el_deg, -6, 0.01 / 3600);
        }
    }
    EXPECT_EQ(day.events.size(), 10U);
}

TEST(Events, PolarDayAndNightAreSaidOfEachThreshold) {
    const Day summer = day_events({2026, 6, 21}, kZurich, kSvalbard);
    EXPECT_EQ(summer.sun, Crossing::AboveAllDay);
    EXPECT_EQ(summer.civil, Crossing::AboveAllDay);
    EXPECT_EQ(summer.astronomical, Crossing::AboveAllDay);
    EXPECT_EQ(summer.day_length_s, 86400);
    ASSERT_EQ(summer.sun_up.size(), 1U);
    EXPECT_EQ(summer.sun_up[0].begin, summer.span.begin);
    EXPECT_EQ(summer.sun_up[0].end, summer.span.end);

    const Day winter = day_events({2026, 12, 21}, kZurich, kSvalbard);
    EXPECT_EQ(winter.sun, Crossing::BelowAllDay);
    EXPECT_EQ(winter.civil, Crossing::BelowAllDay);
    EXPECT_EQ(winter.nautical, Crossing::Crosses);  // at noon, some 11.6 degrees below
    EXPECT_EQ(winter.astronomical, Crossing::Crosses);
    EXPECT_EQ(winter.day_length_s, 0);
    EXPECT_TRUE(winter.sun_up.empty());
    EXPECT_TRUE(winter.golden_hour.empty());
}

TEST(Events, SomeComeTwiceOrNotAtAllOnALocalDay) {
    // The end of Longyearbyen's days with a sunset, 2020: USNO prints two sunrises on 16 April and
    // no sunrise on 25 August, by UT days.
    const Day april = day_events({2020, 4, 16}, Zone(), kSvalbard);
    EXPECT_EQ(april.all(EventKind::Sunrise).size(), 2U);
    EXPECT_EQ(april.all(EventKind::Sunset).size(), 1U);
    EXPECT_EQ(april.sun_up.size(), 2U);
    EXPECT_EQ(day_events({2020, 8, 25}, Zone(), kSvalbard).all(EventKind::Sunrise).size(), 0U);
    EXPECT_EQ(day_events({2020, 8, 25}, Zone(), kSvalbard).sun, Crossing::Crosses);

    // Where the clocks are near the sun's time, every day has one noon and one midnight, days of 23
    // and 25 hours included.
    int transits = 0, lower = 0, days = 0, long_days = 0;
    for (const Day& day : day_events({2026, 1, 1}, {2026, 12, 31}, kZurich, kBern)) {
        ++days;
        transits += static_cast<int>(day.all(EventKind::Transit).size());
        lower += static_cast<int>(day.all(EventKind::LowerTransit).size());
        long_days += day.span.length_s() != 86400;
        EXPECT_EQ(day.sun, Crossing::Crosses);
    }
    EXPECT_EQ(days, 365);
    EXPECT_EQ(transits, 365);
    EXPECT_EQ(lower, 365);
    EXPECT_EQ(long_days, 2);
}

TEST(Events, ASunThatOnlyGrazesTheHorizonIsNotMissed) {
    // A horizon half an arcsecond below the day's highest point: up for some minutes only, which
    // may lie between any two samples; half an arcsecond above it: not at all.
    for (const Date date : {Date{2026, 1, 5}, Date{2026, 6, 21}, Date{2026, 11, 1}}) {
        const Day plain = day_events(date, kZurich, kBern);
        double highest_rad = -2;
        const Instant noon = *plain.first(EventKind::Transit);
        for (double t_s = -300; t_s <= 300; t_s += 1)
            highest_rad = std::max(highest_rad, position(noon + t_s, kBern).elevation_rad);
        DayOptions options;
        options.rule = RiseRule::at_center_elevation(highest_rad - 0.5 * kArcsecond_rad);
        const Day grazing = day_events(date, kZurich, kBern, options);
        ASSERT_EQ(grazing.all(EventKind::Sunrise).size(), 1U) << to_string(date);
        ASSERT_EQ(grazing.all(EventKind::Sunset).size(), 1U) << to_string(date);
        EXPECT_GT(grazing.day_length_s, 30);
        EXPECT_LT(grazing.day_length_s, 300);
        options.rule = RiseRule::at_center_elevation(highest_rad + 0.5 * kArcsecond_rad);
        EXPECT_EQ(day_events(date, kZurich, kBern, options).sun, Crossing::BelowAllDay);
    }
}

/// When the sun's centre crosses an elevation, up and down, looked for every 20 s.
std::pair<std::vector<Instant>, std::vector<Instant>> crossings_of(const PositionTable& table,
                                                                   const TimeSpan& span,
                                                                   const Observer& observer,
                                                                   double elevation_rad) {
    constexpr double kStep_s = 20;
    std::pair<std::vector<Instant>, std::vector<Instant>> found;
    double before_rad = 0;
    for (double t_s = 0; t_s <= span.length_s(); t_s += kStep_s) {
        const double over_rad =
            elevation_of(table.vector_au(span.begin + t_s, observer)) - elevation_rad;
        if (t_s > 0 && (over_rad > 0) != (before_rad > 0))
            (over_rad > 0 ? found.first : found.second)
                .push_back(span.begin + t_s - kStep_s * over_rad / (over_rad - before_rad));
        before_rad = over_rad;
    }
    return found;
}

TEST(Events, InTheFirstAndTheLastHourOfADayAreFound) {
    // Beside the polar circle, 14 July 2026: the sun dips under the horizon around its lowest
    // point, for a minute or for hours, and the clocks put that point up to 50 minutes before or
    // after midnight.
    const Date date{2026, 7, 14};
    const Zone zone = Zone::fixed(3600);
    const TimeSpan span = zone.day(date);
    const PositionTable table(span.begin, span.end);
    const double horizon_rad = radians(-50.0 / 60);
    int pairs_first = 0, pairs_last = 0, short_first = 0, short_last = 0;
    for (double minutes = -50; minutes <= 50; minutes += 5) {
        for (double lat_deg = 67.3; lat_deg < 67.6; lat_deg += 0.004) {
            const geo::Geodetic place = geo::geodetic_deg(lat_deg, 15 + 1.5 - minutes / 4);
            const Observer observer(place);
            const auto [rising, setting] = crossings_of(table, span, observer, horizon_rad);
            const Day day = day_events(table, span, observer, {});
            const std::vector<Instant> sunrises = day.all(EventKind::Sunrise);
            const std::vector<Instant> sunsets = day.all(EventKind::Sunset);
            // What lasts less than a step may be seen by the one and not by the other.
            if (sunrises.size() + sunsets.size() > rising.size() + setting.size()) {
                EXPECT_GT(day.day_length_s, span.length_s() - 45) << lat_deg;
                continue;
            }
            ASSERT_EQ(sunrises.size(), rising.size()) << lat_deg << " " << minutes;
            ASSERT_EQ(sunsets.size(), setting.size()) << lat_deg << " " << minutes;
            for (std::size_t i = 0; i < rising.size(); ++i)
                EXPECT_NEAR(sunrises[i] - rising[i], 0, 20) << lat_deg << " " << minutes;
            for (std::size_t i = 0; i < setting.size(); ++i)
                EXPECT_NEAR(sunsets[i] - setting[i], 0, 20) << lat_deg << " " << minutes;
            for (std::size_t i = 0; i < rising.size() && i < setting.size(); ++i) {
                const double length_s = rising[i] - setting[i];
                if (length_s < 0) continue;
                const double from_s = setting[i] - span.begin, left_s = span.end - rising[i];
                pairs_first += from_s + length_s < 3600;
                short_first += from_s + length_s < 1500;
                pairs_last += left_s + length_s < 3600;
                short_last += left_s + length_s < 1500;
            }
        }
    }
    // The test sees what it is for.
    for (const int count : {pairs_first, pairs_last, short_first, short_last})
        EXPECT_GT(count, 2);
}

TEST(Events, AYearIsTheSameAsItsDays) {
    const std::vector<Day> year = day_events({2026, 1, 1}, {2026, 12, 31}, kZurich, kBern);
    for (const std::size_t i : {0U, 87U, 88U, 200U, 297U, 364U}) {
        const Day day = day_events(year[i].date, kZurich, kBern);
        ASSERT_EQ(day.events.size(), year[i].events.size()) << to_string(day.date);
        for (std::size_t k = 0; k < day.events.size(); ++k) {
            EXPECT_EQ(day.events[k].kind, year[i].events[k].kind);
            EXPECT_NEAR(day.events[k].utc - year[i].events[k].utc, 0, 1e-3);
        }
        EXPECT_EQ(day.definition, year[i].definition);
    }
    // Samoa's year without 30 December.
    EXPECT_EQ(day_events({2011, 12, 28}, {2012, 1, 1}, Zone::named("Pacific/Apia"),
                         {radians(-13.83), radians(-171.76), 0})
                  .size(),
              4U);
}

TEST(Events, GoldenAndBlueHourLieBetweenTheirElevations) {
    const Day day = day_events({2026, 3, 20}, kZurich, kBern);
    ASSERT_EQ(day.golden_hour.size(), 2U);
    ASSERT_EQ(day.blue_hour.size(), 2U);
    const auto el_deg = [](Instant t) { return degrees(position(t, kBern).elevation_rad); };
    EXPECT_NEAR(el_deg(day.blue_hour[0].begin), -6, 1e-4);
    EXPECT_NEAR(el_deg(day.blue_hour[0].end), -4, 1e-4);
    EXPECT_NEAR(el_deg(day.golden_hour[0].begin), -4, 1e-4);
    EXPECT_NEAR(el_deg(day.golden_hour[0].end), 6, 1e-4);
    EXPECT_NEAR(el_deg(day.golden_hour[1].begin), 6, 1e-4);
    EXPECT_NEAR(el_deg(day.golden_hour[1].end), -4, 1e-4);
    EXPECT_NEAR(el_deg(day.blue_hour[1].end), -6, 1e-4);
    EXPECT_NEAR(day.blue_hour[0].end - day.golden_hour[0].begin, 0, 1e-3);
    // In a winter of the north the golden hour lasts from morning to evening.
    const Day winter = day_events({2026, 2, 20}, kZurich, kSvalbard);
    ASSERT_EQ(winter.golden_hour.size(), 1U);
    EXPECT_GT(winter.golden_hour[0].length_s(), 6 * 3600);
}

TEST(Events, ErrorsSayWhatIsWrong) {
    EXPECT_EQ(test::error_of([] {
                  day_events({2026, 6, 21}, kZurich, {radians(91), 0, 0});
              }),
              "exit 3: sun: latitude 91: no such place, expected -90 to 90 degrees; "
              "latitude comes before longitude");
    EXPECT_EQ(test::error_of([] {
                  day_events({1850, 6, 21}, Zone(), kBern);
              }),
              "exit 3: time: 1850-06-21T00:00:00Z: sun and moon are computed for the years 1900 "
              "to 2100");
    EXPECT_EQ(test::error_of([] {
                  day_events({2026, 6, 22}, {2026, 6, 21}, kZurich, kBern);
              }),
              "exit 3: sun: from 2026-06-22 to 2026-06-21: ends before it begins");
    // The first and the last local day are whole, in every zone.
    for (const char* offset : {"+14:00", "-12:00"})
        for (const Date date : {Date{1900, 1, 1}, Date{2100, 12, 31}})
            EXPECT_EQ(test::error_of([&] { day_events(date, Zone::named(offset), kBern); }),
                      "no error");
}

}  // namespace
}  // namespace relevo::sun::test_events
