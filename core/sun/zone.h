#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sun/posix_rule.h"
#include "sun/time.h"

namespace relevo::sun {

/// How often a wall clock showed a time.
enum class WallTimeKind {
    Unique,       ///< once
    Nonexistent,  ///< never: the clocks were put forward over it
    Ambiguous,    ///< twice: the clocks were put back over it
};

/// A wall time and the moment that was taken for it.
struct ResolvedTime {
    Instant utc;
    WallTimeKind kind = WallTimeKind::Unique;
    int utc_offset_s = 0;      ///< that was used
    std::string abbreviation;  ///< of the zone, with that offset: "CEST", "+0545"
};

/// What the clocks of a zone show at a moment.
struct LocalTime {
    CivilTime wall;
    int utc_offset_s = 0;
    std::string abbreviation;
};

/// A stretch of time [begin, end).
struct TimeSpan {
    Instant begin;
    Instant end;
    double length_s() const { return end - begin; }
};

/// The rules by which the clocks of a place are set: a zone of the IANA database of this computer
/// (/usr/share/zoneinfo), or a fixed offset. A value: it holds its own changes of offset from 1899
/// to 2101, so that it is read by many threads at once.
///
/// Times after the last change that the database lists (2037 as Debian builds it) follow the rule
/// in force then. Each of 344 wall times in 12 zones, 1931-2037, skipped and repeated ones
/// among them, comes out as Python's zoneinfo has it (tests/sun/test_zone.cpp).
class Zone {
  public:
    Zone() : Zone(0) {}  ///< UTC

    /// @param text  an IANA name ("Europe/Zurich"), or an offset ("+05:30", "+0530", "+05", "Z")
    /// @throws Error (BadInput) if there is no such zone, with the nearest name
    static Zone named(std::string_view text);
    /// A zone of the database; nothing where this computer's has none of that name.
    /// @param name  an IANA name
    static std::optional<Zone> find(std::string_view name);
    /// @param utc_offset_s  less than 24 hours either way
    static Zone fixed(int utc_offset_s) { return Zone(utc_offset_s); }
    /// Mean solar time of a meridian: a fixed offset, 240 s for each degree, to the whole second.
    /// @param lon_rad  [-pi, pi]
    static Zone mean_solar(double lon_rad);

    /// "Europe/Zurich", "+05:30", "UTC"; "LMT+00:34:11" (local mean time) of a meridian.
    const std::string& name() const { return name_; }

    LocalTime local(Instant instant) const;

    /// The moment at which the clocks show `wall`.
    /// @param fold  which moment to take where there is not exactly one: 0 reads the wall time with
    ///     the offset before the change of the clocks (of a time that comes twice, the first), 1
    ///     with the offset after it
    ResolvedTime resolve(const CivilTime& wall, int fold = 0) const;

    /// The local day: from the first moment of the date to the first moment of the next. 23 or 25
    /// hours long where the clocks change.
    /// @throws Error (BadInput) if the zone skipped that day, as Pacific/Apia did 2011-12-30
    TimeSpan day(Date date) const;
    /// Likewise; nothing for a day that was skipped.
    std::optional<TimeSpan> find_day(Date date) const;

    /// Offsets within a span of time; the first one begins with it.
    std::vector<OffsetChange> offsets(const TimeSpan& span) const;

  private:
    explicit Zone(int utc_offset_s);

    struct Period {
        std::int64_t begin_us;  // since 1970, UTC; the first one has no beginning
        int utc_offset_s;
        std::string abbreviation;
    };
    std::size_t period_at(std::int64_t unix_us) const;
    Instant first_moment(Date date) const;

    std::string name_;
    std::vector<Period> periods_;  // never empty, in order
};

/// Version of the IANA database in use ("2026b"), or "unknown".
std::string zone_database_version();

/// "2026-06-21T18:30:00+02:00", rounded to `decimals` (0 to 6) of the second.
std::string to_iso(Instant instant, const Zone& zone, int decimals = 0);

/// A moment given by the user.
struct ParsedTime {
    Instant utc;
    Zone zone;  ///< for showing results: the zone given, else the offset in the text
    WallTimeKind kind = WallTimeKind::Unique;
    /// What the user should be told when the wall time was skipped or came twice; else empty.
    std::string note;
    /// What was assumed of the zone by whoever gave it, as sun/zone_of_place.h says it; else empty.
    std::string assumption;
};

/// Reads a moment: "2026-06-21T18:30+02:00", "2026-06-21 16:30:15.25Z", "now", or a wall time such
/// as "2026-06-21T18:30" if a zone is given. Seconds and their fraction (rounded to microseconds)
/// may be left out; offsets are written +02:00, +0200 or +02.
///
/// Where the text has an offset, that counts, and the zone is for showing results; "Z" goes with
/// any zone, but another offset must be the one that the zone has at that moment.
/// @throws Error (BadInput) for text that is not a time, a date or hour that does not exist, a leap
///     second, a year outside 1900-2100, a wall time without a zone, an offset that the zone does
///     not have
ParsedTime parse_time(std::string_view text, const std::optional<Zone>& zone = std::nullopt);

/// Whether a moment that parse_time() reads is a wall time, which means nothing without a zone.
/// @throws Error (BadInput) for text that is not a time, as parse_time()
bool is_wall_time(std::string_view text);

/// A date, and when it is by a zone's clocks.
struct LocalDay {
    Date date;
    TimeSpan span;
};
/// The days from `first` to `last`, without those that the zone skipped.
/// @throws Error (BadInput) if `last` is before `first`
std::vector<LocalDay> local_days(Date first, Date last, const Zone& zone);

}  // namespace relevo::sun
