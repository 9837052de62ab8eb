#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::sun {

/// From this moment on, clocks are this far ahead of UTC.
struct OffsetChange {
    std::int64_t unix_s = 0;
    int utc_offset_s = 0;
    std::string abbreviation;
};

/// The changes of a POSIX TZ rule ("CET-1CEST,M3.5.0,M10.5.0/3") in those years, in order; none
/// for a rule without daylight saving time, nor for text that is not such a rule.
/// Source: IEEE Std 1003.1 (8.3), with the hours beyond 24 and below 0 of RFC 8536 (3.3.1).
std::vector<OffsetChange> posix_rule_changes(std::string_view rule, int first_year, int last_year);

}  // namespace relevo::sun
