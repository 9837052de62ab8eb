#include "light/plane/horizon_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/text.h"
#include "base/units.h"
#include "light/plane/irradiance_rows.h"

namespace relevo::light {
namespace {

constexpr std::uint64_t kMostHorizonBytes = std::uint64_t{16} << 20;
constexpr int kSkylineDirections = 18000;

class HorizonReader {
  public:
    HorizonReader(const dem::FileErrors& errors, bool southern)
        : errors_(errors), southern_(southern) {}

    FileHorizon read(std::string_view text) {
        TextLines lines(text);
        std::string_view above;  // the last line without numbers
        while (const auto next = lines.next()) {
            const std::string_view line = trimmed(*next);
            if (line.empty() || line.starts_with('#')) continue;
            if (!rows_.empty() || parse_number(line.substr(0, line.find_first_of(" ,;\t"))))
                rows_.push_back({std::string(line), lines.number()});
            else
                above = line;
        }
        if (rows_.empty()) errors_.refuse("no numbers, expected the heights of a horizon");
        const std::string& first = rows_.front().text;
        if (first.find_first_of(",;\t") != first.npos)
            read_columns(above);
        else if (first.find(' ') != first.npos)
            read_pvsyst();
        else
            read_heights();
        check();
        return std::move(found_);
    }

  private:
    struct Row {
        std::string text;
        std::size_t line;
    };

    double number(const std::string& text, const Row& row, double least, double most,
                  const char* name) const {
        const auto value = parse_number(text);
        if (!value || *value < least || *value > most)
            errors_.refuse(row.line, fmt::format("{} \"{}\", expected {} to {} degrees", name, text,
                                                 least, most));
        return *value;
    }
    double height(const std::string& text, const Row& row) const {
        return number(text, row, -90, 90, "elevation");
    }
    void add(double azimuth_deg, double elevation_deg) {
        found_.directions.push_back(
            {azimuth_deg - 360 * std::floor(azimuth_deg / 360), elevation_deg});
    }

    void read_heights() {
        for (std::size_t k = 0; k < rows_.size(); ++k)
            add(360.0 * double(k) / double(rows_.size()), height(rows_[k].text, rows_[k]));
        found_.description = "heights from north on, clockwise (PVGIS)";
    }

    void read_pvsyst() {
        for (const Row& row : rows_) {
            const std::size_t blank = std::min(row.text.find(' '), row.text.size());
            const double azimuth_deg = number(row.text.substr(0, blank), row, -180, 180, "azimuth");
            add(southern_ ? -azimuth_deg : azimuth_deg + 180,
                height(std::string(trimmed(row.text.substr(blank))), row));
        }
        found_.description = fmt::format("azimuths from {} (PVsyst)",
                                         southern_ ? "north, counterclockwise" : "south");
    }

    void read_columns(std::string_view names) {
        const dem::CsvHeader header(names, errors_);
        const auto azimuth = header.find({"azimuth", "azimuth_deg", "horizon_azimuth"});
        const auto elevation = header.find(
            {"elevation", "elevation_deg", "horizon_deg", "horizon_elevation", "horizon"});
        if (!azimuth || !elevation)
            errors_.refuse(rows_.front().line,
                           "no line above it that names the columns azimuth and elevation");
        for (const Row& row : rows_) {
            const std::vector<std::string> fields = header.fields(row.text, row.line);
            add(number(dem::csv_field(fields, azimuth), row, 0, 360, "azimuth"),
                height(dem::csv_field(fields, elevation), row));
        }
        found_.description = "azimuths clockwise from north";
    }

    /// A turn may name its first direction again, as 0 and 360.
    void check() {
        auto& all = found_.directions;
        std::ranges::stable_sort(all, {}, &FileHorizon::Direction::azimuth_deg);
        const auto again = std::ranges::unique(all, [](const auto& a, const auto& b) {
            return a.azimuth_deg == b.azimuth_deg && a.elevation_deg == b.elevation_deg;
        });
        all.erase(again.begin(), again.end());
        const auto twice =
            std::ranges::adjacent_find(all, {}, &FileHorizon::Direction::azimuth_deg);
        if (twice != all.end())
            errors_.refuse(fmt::format("azimuth {:.10g} has the elevations {:.10g} and {:.10g}",
                                       twice->azimuth_deg, twice->elevation_deg,
                                       std::next(twice)->elevation_deg));
        if (all.size() < 2) errors_.refuse("one direction, expected two or more");
    }

    dem::FileErrors errors_;
    bool southern_;
    std::vector<Row> rows_;
    FileHorizon found_;
};

}  // namespace

Skyline FileHorizon::skyline() const {
    std::vector<double> elevation_rad;
    std::size_t next = 0;
    for (int k = 0; k < kSkylineDirections; ++k) {
        const double azimuth_deg = 360.0 * k / kSkylineDirections;
        while (next < directions.size() && directions[next].azimuth_deg <= azimuth_deg)
            ++next;
        const Direction& before = next > 0 ? directions[next - 1] : directions.back();
        const Direction& after = directions[next % directions.size()];
        const auto turned = [](double deg) { return deg < 0 ? deg + 360 : deg; };
        const double share = turned(azimuth_deg - before.azimuth_deg) /
                             turned(after.azimuth_deg - before.azimuth_deg);
        elevation_rad.push_back(
            radians(before.elevation_deg + share * (after.elevation_deg - before.elevation_deg)));
    }
    return Skyline(std::move(elevation_rad));
}

FileHorizon read_horizon(const std::string& path, std::string_view who, bool southern) {
    const dem::FileErrors errors{path, who};
    FileHorizon found =
        HorizonReader(errors, southern).read(dem::read_packed_text(errors, kMostHorizonBytes));
    found.description = fmt::format("{}, {} directions, {}, linear between",
                                    printable(std::filesystem::path(path).filename().string()),
                                    found.directions.size(), found.description);
    return found;
}

}  // namespace relevo::light
