#include "light/plane/irradiance_rows.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/format.h"

namespace relevo::light {
namespace {

constexpr double kMost_w_m2 = 2500;  // clouds add to the sun, but no more than that

/// The shortest time between two rows that follow each other.
double shortest_step_s(const std::vector<IrradianceFile::Row>& rows) {
    double step_s = rows.size() < 2 ? kHour_s : 1e12;
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (rows[i].stamp > rows[i - 1].stamp)
            step_s = std::min(step_s, rows[i].stamp - rows[i - 1].stamp);
    return step_s;
}

/// @param step_s  from row to row
sun::TimeSpan span_of(const IrradianceFile::Row& row, const IrradianceFile& file, double step_s) {
    if (row.end) return {row.stamp, *row.end};
    if (file.time.kind == RowTime::Kind::End) return {row.stamp - step_s, row.stamp};
    sun::Instant begin = row.stamp;
    if (file.begins_with_step) {
        const sun::CivilTime wall = file.clock.local(row.stamp).wall;
        begin = begin - std::fmod(wall.hour * kHour_s + wall.minute * 60.0, step_s);
    }
    return {begin, begin + step_s};
}

/// Whether a row goes on in the next month of another year, as typical years do.
bool is_next_month(const Irradiance& before, const Irradiance& row, const sun::Zone& clock) {
    const sun::Date last = clock.local(before.span.begin).wall.date;
    const sun::CivilTime first = clock.local(row.span.begin).wall;
    const sun::Date next = sun::add_days(last, 1);
    return (next.day == 1 || (last.month == 2 && last.day == 28)) &&
           clock.local(before.span.end).wall.date == next && first.date.day == 1 &&
           first.hour == 0 && first.date.month == last.month % 12 + 1;
}

/// Refuses a row that does not follow the one before.
void check_order(const Irradiance& before, const Irradiance& row, const IrradianceFile& file,
                 IrradianceTable& table) {
    const double gap_s = row.span.begin - before.span.end;
    if (std::abs(gap_s) < 0.5) return;
    if (table.sparse && row.span.begin > before.span.begin) return;
    if (is_next_month(before, row, file.clock)) {
        table.typical |= std::abs(gap_s) > 2 * kDay_s;
        return;
    }
    const std::string begin = sun::to_iso(row.span.begin, file.clock),
                      end = sun::to_iso(before.span.end, file.clock);
    if (row.span.begin == before.span.begin)
        file.refuse(row.line, fmt::format("{} comes twice", begin));
    file.refuse(row.line,
                gap_s < 0
                    ? fmt::format("begins {}, before the end of the row above it, {}", begin, end)
                    : fmt::format("a gap: begins {}, but the row above it ends {}", begin, end));
}

void check_leap_days(const IrradianceFile& file, const IrradianceTable& table) {
    if (file.leap_days && !table.typical) return;
    const char* const year = table.typical ? "a typical year" : "a year without it by its header";
    for (const Irradiance& row : table.rows) {
        const sun::Date date = table.clock.local(row.span.begin).wall.date;
        if (date.month == 2 && date.day == 29)
            file.refuse(row.line, fmt::format("29 February in {}: {} rows; remove that day", year,
                                              table.rows.size()));
    }
}

std::string description_of(const IrradianceFile& file, const IrradianceTable& table,
                           double step_s) {
    std::string text = file.format;
    if (table.place) text += ", " + geo::degrees_text(*table.place);
    if (table.typical) text += ", typical year";
    if (table.sparse) return text + ", instants, each for itself";
    if (table.instant_s)
        return text + fmt::format(", instants {:.4g} h after the rows' begin, not spread",
                                  *table.instant_s / kHour_s);
    return text + fmt::format(", means of {:.6g} min", step_s / 60);
}

}  // namespace

std::optional<std::string_view> TextLines::next() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

void IrradianceFile::refuse(std::size_t line, std::string_view what) const {
    errors.refuse(fmt::format("{} {}: {}", unit, line, what));
}

double IrradianceFile::number(std::string_view text, std::size_t line) const {
    const std::optional<double> value = parse_number(trimmed(text));
    if (!value) refuse(line, fmt::format("\"{}\", expected a number", text));
    return *value;
}

void IrradianceFile::set_place(double lat_deg, double lon_deg, double height_m) {
    if (!(std::abs(lat_deg) <= 90) || !(lon_deg >= -180 && lon_deg <= 360))
        errors.refuse(fmt::format("latitude {}, longitude {}: no place", lat_deg, lon_deg));
    place = geo::geodetic_deg(lat_deg, lon_deg, height_m);
}

void IrradianceFile::set_clock(double hours) {
    if (!(std::abs(hours) <= 15)) errors.refuse(fmt::format("time zone {}: none", hours));
    clock = sun::Zone::fixed(static_cast<int>(std::lround(hours * kHour_s)));
}

sun::Instant IrradianceFile::instant(const std::array<double, 5>& wall, std::size_t line) const {
    const auto [year, month, day, hour, minute] = wall;
    if (!(hour >= 0 && hour < 24 && minute >= 0 && minute < 60))
        refuse(line, fmt::format("hour {}, minute {}: no time of a day", hour, minute));
    try {
        const sun::Date date = sun::parse_date(fmt::format("{:04}-{:02}-{:02}", year, month, day));
        return clock.resolve({date, static_cast<int>(hour), static_cast<int>(minute), 0, 0}).utc;
    } catch (const Error& error) {
        refuse(line, error.what());
    }
}

void IrradianceFile::add(sun::Instant stamp, const std::array<double, 3>& values, std::size_t line,
                         std::optional<sun::Instant> end) {
    constexpr std::array kNames{"ghi", "dni", "dhi"};
    for (std::size_t k = 0; k < 3; ++k) {
        const double value = values[k], size = std::abs(value);
        const auto wrong = [&](const char* what) {
            refuse(line, fmt::format("{} {:.10g}: {}", kNames[k], value, what));
        };
        if (value == -999 || size == 9999 || size == 99999) wrong("a missing value; fill it in");
        if (value < 0) wrong("negative, expected 0 W/m2 or more");
        if (value > kMost_w_m2) wrong("expected at most 2500 W/m2");
    }
    rows.push_back({stamp, end, values, line});
}

IrradianceTable IrradianceFile::arranged() const {
    if (rows.empty()) errors.refuse("no rows of irradiance");
    IrradianceTable table;
    table.clock = clock;
    table.place = place;
    table.unit = unit;
    const bool instants = time.kind == RowTime::Kind::Instant;
    double length_s = step_s.value_or(shortest_step_s(rows));
    if (rows.front().end) length_s = *rows.front().end - rows.front().stamp;
    table.sparse = instants && length_s > kHour_s;
    if (table.sparse) length_s = kHour_s;
    for (const Row& row : rows) {
        const auto [ghi, dni, dhi] = row.values;
        const Irradiance next{span_of(row, *this, length_s), ghi, dni, dhi, row.line};
        if (next.span.length_s() <= 0 || next.span.length_s() > kHour_s)
            refuse(row.line, fmt::format("{:.6g} h long, expected an hour or less",
                                         next.span.length_s() / kHour_s));
        if (!table.rows.empty()) check_order(table.rows.back(), next, *this, table);
        table.rows.push_back(next);
    }
    if (instants)
        table.instant_s =
            rows.front().stamp - table.rows.front().span.begin + time.instant_h * kHour_s;
    check_leap_days(*this, table);
    table.description = description_of(*this, table, length_s);
    return table;
}

}  // namespace relevo::light
