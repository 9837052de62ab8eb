#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "sun/time.h"

/// Shared by time.cpp and zone.cpp: calendar arithmetic and the reading of fields.
namespace relevo::sun {

/// Microseconds from 1970-01-01T00:00 to `civil` on the same clock, and back.
std::int64_t stamp_us(const CivilTime& civil);
CivilTime civil_of(std::int64_t us);

/// Rounded to `decimals` (0 to 6) of the second.
std::int64_t rounded_us(std::int64_t us, int decimals);

/// "2026-06-21T18:30:00", cut to `decimals` of the second.
std::string civil_text(const CivilTime& civil, int decimals);

int days_in_month(int year, int month);

/// Reads a date or a time from left to right; errors name the whole text.
class FieldReader {
  public:
    FieldReader(std::string_view text, std::string_view who);

    std::string_view rest() const { return rest_; }
    bool take(char c);
    std::optional<int> digits(int count);
    /// "2026-06-21"; nothing where the text has another form. @throws Error for an impossible date
    std::optional<Date> date();
    void check(std::string_view field, int value, int least, int most) const;
    [[noreturn]] void fail(std::string_view what) const;

  private:
    std::string_view text_, rest_;
    std::string_view who_;
};

}  // namespace relevo::sun
