#include <cmath>

#include "base/units.h"
#include "sun/moon_events.h"
#include "sun/tables.h"

namespace relevo::sun::test_moon_events {
namespace {

TEST(MoonEvents, AreThoseOfTheNavalObservatory) {
    // Printed to the minute.
    const test::Csv csv =
        test::read_csv(test::source_dir() / "tests" / "data" / "moon" / "usno_riseset.csv");
    Accuracy minutes(
        "U.S. Naval Observatory, moonrise and moonset 45 to 61 degrees from the equator", "s", 40);
    Accuracy polar("U.S. Naval Observatory, moonrise and moonset 80 to 85 degrees", "s", 200);
    for (const Row& row : rows_of(csv)) {
        const Instant time = row.time();
        const auto days =
            moon_days((time - 3600).utc().date, (time + 3600).utc().date, Zone(), row.place());
        double least_s = 1e9;
        for (const MoonDay& day : days)
            for (const Event& event : day.events)
                if (name_of(event.kind) == row.text("event") &&
                    std::abs(event.utc - time) < std::abs(least_s))
                    least_s = event.utc - time;
        (std::abs(row.number("lat_deg")) > 70 ? polar : minutes).add(least_s, row);
    }
}

TEST(MoonEvents, MayBeMissingOnADay) {
    // The moon rises 50 minutes later each day, so that a month has a day without moonrise.
    const auto days = moon_days({2026, 3, 1}, {2026, 3, 31}, Zone(), {radians(46.5), 0, 0});
    int rises = 0, without = 0, transits = 0;
    for (const MoonDay& day : days) {
        int of_day = 0;
        for (const Event& event : day.events) {
            of_day += event.kind == EventKind::Moonrise;
            transits += event.kind == EventKind::Transit;
        }
        rises += of_day;
        without += of_day == 0;
        double up_s = 0;
        for (const TimeSpan& up : day.moon_up)
            up_s += up.length_s();
        EXPECT_DOUBLE_EQ(up_s, day.moon_up_s);
    }
    EXPECT_EQ(rises, 30);
    EXPECT_EQ(without, 1);
    EXPECT_EQ(transits, 30);
}

TEST(MoonEvents, StaysUpOrDownNearThePole) {
    // At 85 degrees the moon stays up for days each month.
    int up = 0, down = 0;
    for (const MoonDay& day :
         moon_days({2026, 3, 1}, {2026, 3, 31}, Zone(), {radians(85.0), 0, 0})) {
        up += day.moon == Crossing::AboveAllDay;
        down += day.moon == Crossing::BelowAllDay;
        if (day.moon == Crossing::AboveAllDay) {
            EXPECT_DOUBLE_EQ(day.moon_up_s, day.span.length_s());
        }
    }
    EXPECT_GE(up, 8);
    EXPECT_GE(down, 8);
}

TEST(MoonEvents, HaveTheirPhasesAndRefuseDatesBackwards) {
    const auto days = moon_days({2026, 3, 1}, {2026, 3, 31}, Zone(), {radians(46.5), 0, 0});
    std::string phases;
    for (const MoonDay& day : days)
        for (const PhaseTime& phase : day.phases)
            phases += std::to_string(day.date.day) + " " + std::string(name_of(phase.phase)) + "; ";
    EXPECT_EQ(phases, "3 full moon; 11 last quarter; 19 new moon; 25 first quarter; ");
    EXPECT_EQ(test::error_of([] {
                  moon_days({2026, 3, 2}, {2026, 3, 1}, Zone(), {0, 0, 0});
              }),
              "exit 3: sun: from 2026-03-02 to 2026-03-01: ends before it begins");
}

}  // namespace
}  // namespace relevo::sun::test_moon_events
