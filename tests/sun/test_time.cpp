#include <cmath>
#include <cstdint>

#include "sun/time.h"
#include "support/support.h"

namespace relevo::sun::test_time {
namespace {

TEST(Instant, CountsDaysOf86400Seconds) {
    EXPECT_EQ(Instant::from_utc({{1970, 1, 1}}).unix_us(), 0);
    EXPECT_EQ(Instant::from_utc({{2000, 1, 1}, 12}).unix_us(), 946'728'000'000'000);  // J2000
    EXPECT_EQ(Instant::from_utc({{1900, 1, 1}}).unix_us(), -2'208'988'800'000'000);   // RFC 868
    // 2016 ended with a leap second, which is not counted.
    EXPECT_EQ(Instant::from_utc({{2017, 1, 1}}) - Instant::from_utc({{2016, 12, 31}, 23, 59, 59}),
              1);
}

TEST(Instant, KeepsEveryMicrosecondOf1900To2100) {
    for (const int year : {1900, 1969, 1970, 2000, 2100}) {
        for (const int microsecond : {0, 1, 499'999, 999'999}) {
            const CivilTime civil{{year, 2, 28}, 23, 59, 59, microsecond};
            EXPECT_EQ(Instant::from_utc(civil).utc(), civil);
        }
    }
    const Instant start = Instant::from_utc({{2026, 6, 21}});
    EXPECT_EQ((start + 0.000001).unix_us() - start.unix_us(), 1);
    EXPECT_EQ((start + 6e9 - 6e9), start);
    EXPECT_DOUBLE_EQ((start + 1.25) - start, 1.25);
    EXPECT_LT(start, start + 1e-6);
}

TEST(Instant, IsoTextIsRoundedNotCut) {
    const Instant late = Instant::from_utc({{2023, 12, 31}, 23, 59, 59, 999'600});
    EXPECT_EQ(to_iso(late), "2024-01-01T00:00:00Z");
    EXPECT_EQ(to_iso(late, 3), "2024-01-01T00:00:00.000Z");
    EXPECT_EQ(to_iso(late, 4), "2023-12-31T23:59:59.9996Z");
    EXPECT_EQ(to_iso(late, 6), "2023-12-31T23:59:59.999600Z");
    const Instant old = Instant::from_utc({{1903, 2, 3}, 4, 5, 6, 500'000});
    EXPECT_EQ(to_iso(old), "1903-02-03T04:05:07Z");
    EXPECT_EQ(to_iso(old, 1), "1903-02-03T04:05:06.5Z");
}

TEST(Instant, NowIsThisComputersClock) {
    const Instant a = Instant::now();
    const Instant b = Instant::now();
    EXPECT_LE(a, b);
    EXPECT_GT(a, Instant::from_utc({{2024, 1, 1}}));
}

TEST(Date, KnowsTheCalendar) {
    EXPECT_EQ(to_string(add_days({2024, 2, 28}, 1)), "2024-02-29");
    EXPECT_EQ(to_string(add_days({2100, 2, 28}, 1)), "2100-03-01");  // no leap year
    EXPECT_EQ(to_string(add_days({1970, 1, 1}, -1)), "1969-12-31");
    EXPECT_EQ(days_between({1900, 1, 1}, {2101, 1, 1}), 73414);
    EXPECT_LT((Date{2026, 6, 21}), (Date{2026, 7, 1}));
    EXPECT_EQ(parse_date("2026-06-21"), (Date{2026, 6, 21}));
    EXPECT_EQ(parse_date("2000-02-29"), (Date{2000, 2, 29}));
}

TEST(Date, WhatIsNoDateIsAnError) {
    const auto error = [](std::string_view text) {
        return test::error_of([&] { parse_date(text); });
    };
    for (const std::string text : {"", "tomorrow", "21.6.2026", "2026-6-21", "2026-06-21T12:00",
                                   "2026-06-21 ", "20260621", "2026/06/21"})
        EXPECT_EQ(error(text),
                  "exit 3: date: " + text + ": not a date, expected YYYY-MM-DD such as 2026-06-21");
    EXPECT_EQ(error("2026-02-30"),
              "exit 3: date: 2026-02-30: no such date, expected day 1 to 28 of 2026-02 "
              "but got 30");
    EXPECT_EQ(error("2100-02-29"),
              "exit 3: date: 2100-02-29: no such date, expected day 1 to 28 of 2100-02 "
              "but got 29");
    EXPECT_EQ(error("2026-13-01"),
              "exit 3: date: 2026-13-01: no such month, expected month 1 to 12 but got "
              "13");
    EXPECT_EQ(error("2026-00-10"),
              "exit 3: date: 2026-00-10: no such month, expected month 1 to 12 but got "
              "0");
    EXPECT_EQ(error("1899-12-31"),
              "exit 3: date: 1899-12-31: sun and moon are computed for the years 1900 to 2100, "
              "but got 1899");
    EXPECT_EQ(error("2101-01-01"),
              "exit 3: date: 2101-01-01: sun and moon are computed for the years 1900 to 2100, "
              "but got 2101");
    // A year of more than four digits is one, but none that is computed.
    for (const std::string year : {"99999", "12026", "4294969322", "99999999999999999999"})
        EXPECT_EQ(error(year + "-06-21"),
                  "exit 3: date: " + year +
                      "-06-21: sun and moon are computed for the years 1900 to 2100, but got " +
                      year);
}

TEST(Date, WhatTheCalendarDoesNotHoldIsAnErrorAndNoOtherDate) {
    using test::error_of;
    const std::string years = ": sun and moon are computed for the years 1900 to 2100";
    // The calendar's own years wrap at 32767: 99999 would be -31073.
    for (const int year : {99999, 10000, 0, -1, 2'147'483'647, -2'147'483'647}) {
        const std::string expected = "exit 3: date: year " + std::to_string(year) + years;
        EXPECT_EQ(error_of([&] { Instant::from_utc({{year, 6, 21}}); }), expected);
        EXPECT_EQ(error_of([&] { add_days({year, 6, 21}, 1); }), expected);
        EXPECT_EQ(error_of([&] { days_between({2026, 6, 21}, {year, 6, 21}); }), expected);
    }
    EXPECT_EQ(to_string(add_days({9999, 12, 30}, 1)), "9999-12-31");
    for (const int days : {3'000'000, 2'147'483'647, -3'000'000, -2'147'483'647})
        EXPECT_NE(error_of([&] {
                      add_days({2026, 6, 21}, days);
                  }).find(years),
                  std::string::npos)
            << days;
    const Instant now = Instant::from_utc({{2026, 6, 21}});
    for (const double seconds :
         {1e13, -1e13, 1e20, 1e308, static_cast<double>(NAN), static_cast<double>(INFINITY)})
        EXPECT_NE(error_of([&] { now + seconds; }).find(years), std::string::npos) << seconds;
    EXPECT_DOUBLE_EQ(Instant::from_unix_us(INT64_MAX) - Instant::from_unix_us(INT64_MIN),
                     std::exp2(64) * 1e-6);
    for (const std::int64_t us : {INT64_MAX, INT64_MIN, INT64_MIN + 1, INT64_MAX / 2})
        for (const int decimals : {0, 3, 6}) {
            const Instant far = Instant::from_unix_us(us);
            EXPECT_NE(error_of([&] { to_iso(far, decimals); }).find(years), std::string::npos)
                << us;
            EXPECT_NE(error_of([&] { far.utc(); }).find(years), std::string::npos) << us;
        }
}

}  // namespace
}  // namespace relevo::sun::test_time
