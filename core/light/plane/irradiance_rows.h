#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/csv.h"
#include "light/plane/irradiance_file.h"

// What readers of irradiance and of horizons share. Inside of this room only.

namespace relevo::light {

/// The lines of a text, without their ends.
class TextLines {
  public:
    explicit TextLines(std::string_view text) : text_(text) {}

    std::optional<std::string_view> next();
    std::size_t number() const { return number_; }  ///< of the last line, from 1

  private:
    std::string_view text_;
    std::size_t at_ = 0, number_ = 0;
};

/// A file of irradiance before its rows are checked against each other.
struct IrradianceFile {
    dem::FileErrors errors;
    RowTime time{};
    std::optional<double> step_s{};  ///< that the format has; none: that of the rows
    bool begins_with_step = false;   ///< rows begin at multiples of the step, not at the instant
    bool leap_days = true;
    sun::Zone clock{};
    std::optional<geo::Geodetic> place{};
    std::string format{};
    const char* unit = "line";

    struct Row {
        sun::Instant stamp;
        std::optional<sun::Instant> end;  ///< the stamp is the begin
        std::array<double, 3> values;     ///< ghi, dni, dhi
        std::size_t line;
    };
    std::vector<Row> rows{};

    [[noreturn]] void refuse(std::size_t line, std::string_view what) const;
    /// @throws Error (BadInput), likewise all below, for what is not a number
    double number(std::string_view text, std::size_t line) const;
    template <std::size_t kCount>
    std::array<double, kCount> numbers(const std::vector<std::string>& fields,
                                       const std::array<std::size_t, kCount>& columns,
                                       std::size_t line) const {
        std::array<double, kCount> result;
        for (std::size_t k = 0; k < kCount; ++k)
            result[k] = number(dem::csv_field(fields, columns[k]), line);
        return result;
    }
    void set_place(double lat_deg, double lon_deg, double height_m);
    void set_clock(double hours);
    /// @param wall  year, month, day, hour (0 to 23) and minute by the clock
    sun::Instant instant(const std::array<double, 5>& wall, std::size_t line) const;
    /// Adds a row, but not one with an irradiance that is missing or impossible.
    void add(sun::Instant stamp, const std::array<double, 3>& values, std::size_t line,
             std::optional<sun::Instant> end = {});

    /// Checks the order of the rows and gives them their spans.
    IrradianceTable arranged() const;
};

}  // namespace relevo::light
