// Polygons over four rasters against exact statistics made independently (../shared).

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "dem/csv.h"
#include "support/support.h"
#include "zones/zone_sums.h"

namespace relevo::zones::test_zones_outside {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::filesystem::path& path) {
    const std::vector<std::string> lines = split(read_text(path, "test"), '\n');
    const std::vector<std::string> names = dem::csv_fields(lines.at(0), ',');
    std::vector<Row> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (trimmed(lines[i]).empty()) continue;
        const std::vector<std::string> fields = dem::csv_fields(lines[i], ',');
        Row row;
        for (std::size_t k = 0; k < names.size() && k < fields.size(); ++k)
            row[std::string(trimmed(names[k]))] = std::string(trimmed(fields[k]));
        rows.push_back(row);
    }
    return rows;
}

/// Compares all figures of a zone; "" is none.
void compare(const ZoneRow& found, const Row& expected, double tolerance) {
    const std::pair<const char*, double> figures[] = {{"area", found.area_m2},
                                                      {"area_valid", found.area_valid_m2},
                                                      {"cells", found.cells},
                                                      {"mean", found.mean},
                                                      {"min", found.min},
                                                      {"max", found.max},
                                                      {"share_over_40", found.share_above}};
    for (const auto& [column, value] : figures) {
        const auto number = parse_number(expected.at(column));
        if (!number) {
            EXPECT_TRUE(std::isnan(value)) << expected.at("zone") << " " << column;
            continue;
        }
        EXPECT_NEAR(value, *number, tolerance * std::max(std::abs(*number), 1e-3))
            << expected.at("zone") << " " << column;
    }
}

std::map<std::string, ZoneRow> sums(const std::filesystem::path& zones,
                                    const std::filesystem::path& raster) {
    const ZoneFile file = read_zones(zones.string(), "zone");
    const auto rows = sum_zones(file, raster.string(), {.weights = {}, .above = 40}).front();
    std::map<std::string, ZoneRow> by_name;
    for (std::size_t i = 0; i < rows.size(); ++i)
        by_name[file.zones[i].id] = rows[i];
    return by_name;
}

TEST(ZonesOutside, AreExactByTheEvenOddRule) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::filesystem::path dir = data / "sun" / "outside" / "planes" / "zones";
    std::map<std::string, std::map<std::string, ZoneRow>> found;
    int compared = 0;
    for (const Row& row : rows_of(dir / "zones.csv")) {
        if (row.at("rule") == "nonzero") continue;
        const std::string raster = row.at("raster");
        if (found[raster].empty())
            found[raster] = sums(dir / "zones.geojson", dir / (raster + ".asc"));
        compare(found[raster].at(row.at("zone")), row, 1e-6);
        ++compared;
    }
    EXPECT_EQ(compared, 34);
}

TEST(ZonesOutside, InDegreesAndInAnotherCrs) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::filesystem::path dir = data / "sun" / "outside" / "planes" / "zones";
    const auto degrees = sums(dir / "zones_degrees.geojson", dir / "plane_degrees.asc");
    for (const Row& row : rows_of(dir / "zones_degrees.csv"))
        if (row.at("weights") == "ellipsoid") compare(degrees.at(row.at("zone")), row, 1e-4);
    const auto other = sums(dir / "zones_other.geojson", dir / "plane_laea.asc");
    for (const Row& row : rows_of(dir / "zones_other.csv"))
        if (row.at("edges") == "straight in EPSG:4326")
            compare(other.at(row.at("zone")), row, 1e-4);
}

}  // namespace
}  // namespace relevo::zones::test_zones_outside
