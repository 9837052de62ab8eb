#include "sun/time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include <date/date.h>
#include <fmt/format.h>

#include "base/error.h"
#include "sun/time_fields.h"

namespace relevo::sun {

namespace {

constexpr std::int64_t kMinute_us = 60 * kSecond_us;
constexpr std::int64_t kHour_us = 60 * kMinute_us;

// What four digits hold; far within what the calendar of the library counts.
constexpr int kFirstWritten = 1, kLastWritten = 9999;
constexpr std::int64_t kFarthest_us = 253'402'300'799'999'999;  // the end of the year 9999

void check_year(std::int64_t year) {
    if (year < kFirstWritten || year > kLastWritten)
        bad_input(fmt::format("date: year {}: sun and moon are computed for the years {} to {}",
                              year, kFirstYear, kLastYear));
}

/// Nearer to 1970 than the years that can be written; the first of them end the same way.
void check_moment(std::int64_t us) {
    if (us > kFarthest_us || us < -kFarthest_us)
        bad_input(
            fmt::format("time: {:.4g} s from 1970: sun and moon are computed for the years "
                        "{} to {}",
                        static_cast<double>(us) * 1e-6, kFirstYear, kLastYear));
}

std::int64_t day_number(Date date) {
    check_year(date.year);
    using date::day, date::month, date::year, date::sys_days;
    return sys_days{year{date.year} / month{static_cast<unsigned>(date.month)} /
                    day{static_cast<unsigned>(date.day)}}
        .time_since_epoch()
        .count();
}

Date date_of(std::int64_t days) {
    constexpr std::int64_t kFarthest_days = kFarthest_us / kDay_us;
    check_moment(std::clamp(days, -kFarthest_days - 1, kFarthest_days + 1) * kDay_us);
    const date::year_month_day ymd{date::sys_days{date::days{days}}};
    check_year(static_cast<int>(ymd.year()));
    return {static_cast<int>(ymd.year()), static_cast<int>(static_cast<unsigned>(ymd.month())),
            static_cast<int>(static_cast<unsigned>(ymd.day()))};
}

}  // namespace

std::int64_t stamp_us(const CivilTime& civil) {
    return day_number(civil.date) * kDay_us + civil.hour * kHour_us + civil.minute * kMinute_us +
           civil.second * kSecond_us + civil.microsecond;
}

CivilTime civil_of(std::int64_t us) {
    check_moment(us);
    const std::int64_t days = (us >= 0 ? us : us - (kDay_us - 1)) / kDay_us;
    const std::int64_t rest = us - days * kDay_us;
    return {date_of(days), static_cast<int>(rest / kHour_us),
            static_cast<int>(rest / kMinute_us % 60), static_cast<int>(rest / kSecond_us % 60),
            static_cast<int>(rest % kSecond_us)};
}

std::int64_t rounded_us(std::int64_t us, int decimals) {
    check_moment(us);
    std::int64_t unit = kSecond_us;
    for (int i = 0; i < decimals; ++i)
        unit /= 10;
    const std::int64_t up = us + unit / 2;
    const std::int64_t rest = ((up % unit) + unit) % unit;
    return up - rest;
}

std::string civil_text(const CivilTime& civil, int decimals) {
    std::string text = fmt::format("{}T{:02}:{:02}:{:02}", to_string(civil.date), civil.hour,
                                   civil.minute, civil.second);
    if (decimals > 0) text += fmt::format(".{:06}", civil.microsecond).substr(0, 1 + decimals);
    return text;
}

int days_in_month(int year, int month) {
    const date::year_month_day_last last{
        date::year{year}, date::month_day_last{date::month{static_cast<unsigned>(month)}}};
    return static_cast<int>(static_cast<unsigned>(last.day()));
}

Instant Instant::from_utc(const CivilTime& utc) {
    return from_unix_us(stamp_us(utc));
}

Instant Instant::now() {
    return from_unix_us(std::chrono::duration_cast<std::chrono::microseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count());
}

CivilTime Instant::utc() const {
    return civil_of(unix_us_);
}

Instant operator+(Instant instant, double seconds) {
    constexpr double kLongest_s = 1e12;  // so that a count of 64 bits holds it
    std::int64_t sum_us = 0;
    if (!(std::abs(seconds) <= kLongest_s) ||
        __builtin_add_overflow(instant.unix_us_, std::llround(seconds * 1e6), &sum_us))
        bad_input(
            fmt::format("time: {:.4g} s later: sun and moon are computed for the years {} "
                        "to {}",
                        seconds, kFirstYear, kLastYear));
    return Instant::from_unix_us(sum_us);
}

Date add_days(Date date, int days) {
    return date_of(day_number(date) + std::int64_t{days});
}

int days_between(Date from, Date to) {
    return static_cast<int>(day_number(to) - day_number(from));
}

std::string to_string(Date date) {
    return fmt::format("{:04}-{:02}-{:02}", date.year, date.month, date.day);
}

std::string to_iso(Instant instant, int decimals) {
    return civil_text(civil_of(rounded_us(instant.unix_us(), decimals)), decimals) + "Z";
}

std::string exact_iso(Instant instant) {
    return to_iso(instant, instant.unix_us() % 1'000'000 == 0 ? 0 : 6);
}

std::string offset_text(int utc_offset_s) {
    const int size = std::abs(utc_offset_s);
    std::string text =
        fmt::format("{}{:02}:{:02}", utc_offset_s < 0 ? '-' : '+', size / 3600, size / 60 % 60);
    if (size % 60) text += fmt::format(":{:02}", size % 60);
    return text;
}

FieldReader::FieldReader(std::string_view text, std::string_view who)
    : text_(text), rest_(text), who_(who) {}

bool FieldReader::take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
}

std::optional<int> FieldReader::digits(int count) {
    if (rest_.size() < static_cast<std::size_t>(count)) return std::nullopt;
    int value = 0;
    for (int i = 0; i < count; ++i) {
        const char c = rest_[static_cast<std::size_t>(i)];
        if (c < '0' || c > '9') return std::nullopt;
        value = 10 * value + (c - '0');
    }
    rest_.remove_prefix(static_cast<std::size_t>(count));
    return value;
}

void FieldReader::fail(std::string_view what) const {
    bad_input(fmt::format("{}: {}: {}", who_, text_, what));
}

void FieldReader::check(std::string_view field, int value, int least, int most) const {
    if (value < least || value > most)
        fail(fmt::format("no such {0}, expected {0} {1} to {2} but got {3}", field, least, most,
                         value));
}

std::optional<Date> FieldReader::date() {
    // A year of more than four digits is one, but none that is computed.
    const std::size_t end = rest_.find_first_not_of("0123456789");
    if (end != std::string_view::npos && end > 4 && rest_[end] == '-')
        fail(fmt::format("sun and moon are computed for the years {} to {}, but got {}", kFirstYear,
                         kLastYear, rest_.substr(0, end)));
    const auto year = digits(4);
    if (!year || !take('-')) return std::nullopt;
    const auto month = digits(2);
    if (!month || !take('-')) return std::nullopt;
    const auto day = digits(2);
    if (!day) return std::nullopt;
    if (*year < kFirstYear || *year > kLastYear)
        fail(fmt::format("sun and moon are computed for the years {} to {}, but got {}", kFirstYear,
                         kLastYear, *year));
    check("month", *month, 1, 12);
    const int last = days_in_month(*year, *month);
    if (*day < 1 || *day > last)
        fail(fmt::format("no such date, expected day 1 to {} of {:04}-{:02} but got {}", last,
                         *year, *month, *day));
    return Date{*year, *month, *day};
}

Date parse_date(std::string_view text) {
    FieldReader reader(text, "date");
    const auto date = reader.date();
    if (!date || !reader.rest().empty())
        reader.fail("not a date, expected YYYY-MM-DD such as 2026-06-21");
    return *date;
}

}  // namespace relevo::sun
