#include "session/climate_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace relevo::session {

namespace {

constexpr double kEverywhere_m = -499;

/// Rounded to tens: the heights are accurate to 100 to 200 m.
std::string height_text(double height_m) {
    return fmt::format("{:.0f} m", 10 * std::round(height_m / 10));
}

std::string above(const char* what, const std::optional<double>& line_m) {
    if (!line_m) return fmt::format("no {}", what);
    if (*line_m < kEverywhere_m) return fmt::format("{} everywhere", what);
    return fmt::format("{} from {}", what, height_text(*line_m));
}

}  // namespace

double middle_height_m(double lowest_m, double highest_m) {
    const double lowest = highest_m > 0 ? std::max(lowest_m, 0.0) : lowest_m;
    return std::clamp(0.5 * (lowest + highest_m), -500.0, 9000.0);
}

ClimateReport climate_report(const climate::ClimateMap& map, const geo::Geodetic& place,
                             sun::Instant utc) {
    const climate::CoverColumn column(map.at(place));
    const climate::Months temperature = column.temperature_c(place.height_m);
    ClimateReport report{.height_m = place.height_m,
                         .january_c = temperature[0],
                         .july_c = temperature[6],
                         .year_mm = column.year_mm(),
                         .date = utc.utc().date};
    const int day = climate::day_of_year(report.date.month, report.date.day);
    report.cover = column.cover(place.height_m, day);
    report.tree_line_m = column.tree_line_m();
    report.ice_line_m = column.ice_line_m();
    report.snow_line_m = column.snow_line_m(day);
    return report;
}

double snowy_share(const climate::ClimateMap& map, const dem::Heightfield& field,
                   sun::Instant utc) {
    constexpr int kAside = 16;
    const sun::Date date = utc.utc().date;
    const int day = climate::day_of_year(date.month, date.day);
    int land = 0, snowy = 0;
    for (int j = 0; j < kAside; ++j)
        for (int i = 0; i < kAside; ++i) {
            const int column = (2 * i + 1) * field.height_m.width() / (2 * kAside);
            const int row = (2 * j + 1) * field.height_m.height() / (2 * kAside);
            const float height_m = field.height_m.at(column, row);
            if (!(height_m > 0)) continue;  // sea, and voids
            const climate::Cover cover =
                climate::CoverColumn(map.at(field.place(column, row))).cover(height_m, day);
            ++land;
            snowy += cover == climate::Cover::Ice || cover == climate::Cover::Snow;
        }
    return land > 0 ? static_cast<double>(snowy) / land : 0;
}

std::string climate_text(const ClimateReport& report) {
    return fmt::format("January {:.1f}, July {:.1f} degC at {:.0f} m, {:.0f} mm of rain a year",
                       report.january_c, report.july_c, report.height_m,
                       10 * std::round(report.year_mm / 10));
}

std::string ground_text(const ClimateReport& report) {
    std::string trees = "trees at all heights";
    if (report.tree_line_m)
        trees = *report.tree_line_m < kEverywhere_m
                    ? "no trees"
                    : fmt::format("trees up to {}", height_text(*report.tree_line_m));
    return fmt::format("{}, {}, {} on {}", trees, above("permanent ice", report.ice_line_m),
                       above("snow", report.snow_line_m), sun::to_string(report.date));
}

}  // namespace relevo::session
