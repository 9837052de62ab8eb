#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/units.h"

/// Time as people write it and as the sun needs it.
namespace relevo::sun {

inline constexpr int kFirstYear = 1900;  ///< first year the sun's ephemeris is good for
inline constexpr int kLastYear = 2100;   ///< last such year
using relevo::kDay_s;
inline constexpr std::int64_t kSecond_us = 1'000'000;
inline constexpr std::int64_t kDay_us = 86'400 * kSecond_us;
inline constexpr double kUnixEpoch_jd = 2440587.5;  ///< Julian date of 1970-01-01

/// A day of the Gregorian calendar.
struct Date {
    int year = 1970;
    int month = 1;  ///< 1 to 12
    int day = 1;    ///< 1 to 31
    friend auto operator<=>(const Date&, const Date&) = default;
};

/// What a wall clock and a calendar show together, in a zone that is known from elsewhere.
struct CivilTime {
    Date date;
    int hour = 0;         ///< 0 to 23
    int minute = 0;       ///< 0 to 59
    int second = 0;       ///< 0 to 59
    int microsecond = 0;  ///< 0 to 999999
    friend auto operator<=>(const CivilTime&, const CivilTime&) = default;
};

/// A moment, as UTC: a count of whole microseconds since 1970-01-01T00:00Z in which every day has
/// 86400 seconds, like POSIX time.
///
/// Leap seconds have no moment of their own: 23:59:60 cannot be written, and the difference of two
/// instants is one second short for every leap second between them. The sun follows UT1, which
/// UTC is kept near to by those very seconds, so nothing is lost: sun/earth_rotation.h knows them.
/// Before 1962 there was no UTC of today's kind, and an instant there is UT1.
///
/// Values outside 1900-2100 can be held and compared; what cannot be computed for them throws. The
/// calendar goes from the year 1 to 9999: dates and moments outside of it are an Error (BadInput)
/// wherever one is made from the other.
class Instant {
  public:
    constexpr Instant() = default;  ///< 1970-01-01T00:00Z
    static constexpr Instant from_unix_us(std::int64_t microseconds) {
        Instant instant;
        instant.unix_us_ = microseconds;
        return instant;
    }
    /// @param utc  read as UTC; its fields must be in their ranges
    static Instant from_utc(const CivilTime& utc);
    /// The clock of this computer.
    static Instant now();

    constexpr std::int64_t unix_us() const { return unix_us_; }
    CivilTime utc() const;

    friend constexpr auto operator<=>(Instant, Instant) = default;
    /// Rounded to the nearest microsecond.
    /// @throws Error (BadInput) for more than 1e12 s, and what a count of 64 bits does not hold
    friend Instant operator+(Instant instant, double seconds);
    friend Instant operator-(Instant instant, double seconds) { return instant + -seconds; }
    /// Seconds from `b` to `a`, without leap seconds.
    friend constexpr double operator-(Instant a, Instant b) {
        std::int64_t us = 0;
        if (__builtin_sub_overflow(a.unix_us_, b.unix_us_, &us))
            return static_cast<double>(a.unix_us_) * 1e-6 - static_cast<double>(b.unix_us_) * 1e-6;
        return static_cast<double>(us) * 1e-6;
    }

  private:
    std::int64_t unix_us_ = 0;
};

/// `days` later in the calendar (earlier if negative).
Date add_days(Date date, int days);

/// Days from `from` to `to`.
int days_between(Date from, Date to);

/// "2026-06-21".
std::string to_string(Date date);

/// "2026-06-21T16:30:00Z", rounded to `decimals` (0 to 6) of the second.
std::string to_iso(Instant instant, int decimals = 0);

/// The same with as many decimals as it takes to be read as the same moment: none, or 6.
std::string exact_iso(Instant instant);

/// "+02:00", "-03:30"; with seconds where there are any ("+00:34:08").
std::string offset_text(int utc_offset_s);

/// A calendar day "2026-06-21".
/// @throws Error (BadInput) if it is not one, does not exist, or lies outside 1900-2100
Date parse_date(std::string_view text);

}  // namespace relevo::sun
