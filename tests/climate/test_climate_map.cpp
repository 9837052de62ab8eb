#include <ctime>
#include <fstream>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "climate/climate_map.h"
#include "support/support.h"

// The climate of a place, by the map that comes along (data/README.md).
namespace relevo::climate {
namespace {

using geo::geodetic_deg;
using test::error_of;

std::filesystem::path shipped_file() {
    return share_dir() / "data/climate/climate.bin";
}

/// Grids of a GeoTIFF: plane after plane, row after row.
std::vector<double> cells_of(const std::filesystem::path& file, int& columns, int& rows) {
    GDALAllRegister();
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str()));
    EXPECT_TRUE(dataset) << file;
    columns = dataset->GetRasterXSize();
    rows = dataset->GetRasterYSize();
    const int planes = dataset->GetRasterCount();
    std::vector<double> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                              static_cast<std::size_t>(planes));
    EXPECT_EQ(CE_None, dataset->RasterIO(GF_Read, 0, 0, columns, rows, cells.data(), columns, rows,
                                         GDT_Float64, planes, nullptr, 0, 0, 0));
    return cells;
}

TEST(ClimateMap, IsTheGridsThatItWasMadeOf) {
    SKIP_WITHOUT_TEST_DATA(data);
    if (!std::filesystem::exists(data / "climate")) GTEST_SKIP() << "not run: needs climate grids";
    int columns = 0, rows = 0;
    const std::vector<double> cells = cells_of(data / "climate/t0_1deg.tif", columns, rows);
    const std::vector<double> relief = cells_of(data / "climate/orog_1deg.tif", columns, rows);
    const ClimateMap map = ClimateMap::shipped();
    int differ = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; column += 3) {
            const auto at = static_cast<std::size_t>(row * columns + column);
            const Normals normals = map.at(geodetic_deg(89.5 - row, column - 179.5));
            differ += std::abs(normals.relief_m - relief[at]) > 1e-6;
            for (std::size_t month = 0; month < 12; ++month) {
                const auto plane = month * static_cast<std::size_t>(columns * rows);
                differ += std::abs(normals.sea_level_c[month] - cells[plane + at] / 10) > 1e-6;
            }
        }
    }
    EXPECT_EQ(differ, 0);
}

TEST(ClimateMap, IceIsMappedWhereItIs) {
    const ClimateMap map = ClimateMap::shipped();
    EXPECT_EQ(map.at(geodetic_deg(72.58, -38.46)).mapped_ice, 1);  // Greenland's summit
    EXPECT_EQ(map.at(geodetic_deg(-90, 0)).mapped_ice, 1);         // the South Pole
    EXPECT_EQ(map.at(geodetic_deg(-68.55, 78.2)).mapped_ice, 0);   // the Vestfold Hills
    EXPECT_EQ(map.at(geodetic_deg(48.2, 16.4)).mapped_ice, 0);     // Vienna
    const double alps = map.around(geodetic_deg(46.5, 8.0), 0.5).mapped_ice;
    EXPECT_GT(alps, 0.02);
    EXPECT_LT(alps, 0.5);
}

TEST(ClimateMap, IsWholeAcrossTheDateLineAndAtThePoles) {
    const ClimateMap map = ClimateMap::shipped();
    for (const double lat_deg : {90.0, 60.0, 0.0, -20.0, -90.0}) {
        const Normals west = map.at(geodetic_deg(lat_deg, 179.999));
        const Normals east = map.at(geodetic_deg(lat_deg, -179.999));
        for (std::size_t month = 0; month < 12; ++month) {
            EXPECT_NEAR(west.sea_level_c[month], east.sea_level_c[month], 0.02) << lat_deg;
            EXPECT_NEAR(west.rain_mm[month], east.rain_mm[month], 0.5) << lat_deg;
            EXPECT_GE(west.rain_mm[month], 0);
        }
    }
}

TEST(ClimateMap, IsLinearFromTheLastCellBeforeTheDateLineToTheFirstBehindIt) {
    // Middles of the cells of temperature, of one degree, lie half a degree from it.
    const ClimateMap map = ClimateMap::shipped();
    for (const double lat_deg : {67.5, 51.5, -16.5}) {
        const Normals west = map.at(geodetic_deg(lat_deg, 179.5)),
                      east = map.at(geodetic_deg(lat_deg, -179.5));
        double differ = 0;
        for (std::size_t month = 0; month < 12; ++month) {
            const double a = west.sea_level_c[month], b = east.sea_level_c[month];
            differ = std::max(differ, std::abs(a - b));
            const auto at = [&](double lon_deg) {
                return map.at(geodetic_deg(lat_deg, lon_deg)).sea_level_c[month];
            };
            EXPECT_NEAR(at(180), (a + b) / 2, 1e-9) << lat_deg;
            EXPECT_NEAR(at(-180), (a + b) / 2, 1e-9) << lat_deg;
            EXPECT_NEAR(at(179.75), 0.75 * a + 0.25 * b, 1e-9) << lat_deg;
            EXPECT_NEAR(at(-179.75), 0.25 * a + 0.75 * b, 1e-9) << lat_deg;
        }
        EXPECT_GE(differ, 0.1) << lat_deg;  // or it would show nothing
    }
}

TEST(ClimateMap, APoleIsOnePlace) {
    const ClimateMap map = ClimateMap::shipped();
    for (const double lat_deg : {90.0, -90.0}) {
        const Normals greenwich = map.at(geodetic_deg(lat_deg, 0));
        for (const double lon_deg : {-170.0, -60.0, 95.0}) {
            const Normals other = map.at(geodetic_deg(lat_deg, lon_deg));
            EXPECT_NEAR(other.sea_level_c[0], greenwich.sea_level_c[0], 1e-9);
            EXPECT_NEAR(other.rain_mm[6], greenwich.rain_mm[6], 1e-9);
        }
    }
}

TEST(ClimateMap, APoleHasTheMeanOfTheRowAroundIt) {
    const ClimateMap map = ClimateMap::shipped();
    for (const double side : {1.0, -1.0}) {
        double sum_c = 0;
        for (int column = 0; column < 360; ++column)
            sum_c += map.at(geodetic_deg(side * 89.5, column - 179.5)).sea_level_c[0];
        EXPECT_NEAR(map.at(geodetic_deg(side * 90, 0)).sea_level_c[0], sum_c / 360, 1e-9) << side;
    }
}

TEST(ClimateMap, MappedIceOfABoxIsTheSameFromEitherSideOfTheDateLine) {
    const ClimateMap map = ClimateMap::shipped();
    int mixed = 0;
    for (double lat_deg = -85; lat_deg < 72; lat_deg += 0.5) {
        const double west = map.around(geodetic_deg(lat_deg, 179.99), 8).mapped_ice;
        const double east = map.around(geodetic_deg(lat_deg, -179.99), 8).mapped_ice;
        EXPECT_NEAR(west, east, 0.08) << lat_deg;
        mixed += west > 0.2 && west < 0.8;
    }
    EXPECT_GT(mixed, 3);  // or it would show nothing
}

TEST(ClimateMap, MappedIceOfABoxIsTheMeanOfItsCellsOnBothSidesOfTheDateLine) {
    // Each fifth of 41 x 41 cells of a twentieth of a degree.
    constexpr double kCell_deg = 0.05, kHalf_deg = 2, kEast_deg = -179.975;
    const ClimateMap map = ClimateMap::shipped();
    int apart = 0;
    for (double lat_deg = -84.975; lat_deg < -60; lat_deg += 0.5) {
        double sum = 0, east_of_line = 0;
        int count = 0;
        for (int j = -40; j <= 40; j += 5)
            for (int i = -40; i <= 40; i += 5, ++count) {
                const auto ice = [&](int column) {
                    return map
                        .at(geodetic_deg(lat_deg + j * kCell_deg, kEast_deg + column * kCell_deg))
                        .mapped_ice;
                };
                sum += ice(i);
                east_of_line += ice(std::max(i, 0));
            }
        const double found = map.around(geodetic_deg(lat_deg, kEast_deg), kHalf_deg).mapped_ice;
        EXPECT_NEAR(found, sum / count, 1e-9) << lat_deg;
        apart += std::abs(sum - east_of_line) > 0.02 * count;
    }
    EXPECT_GE(apart, 1);  // or it would show nothing
}

TEST(ClimateMap, OpensInMilliseconds) {
    // Of the processor, and the least of several: other programs of a test run take turns.
    double least_ms = 1e9;
    for (int i = 0; i < 5; ++i) {
        const std::clock_t began = std::clock();
        const Normals normals = ClimateMap::shipped().at(geodetic_deg(47, 11));
        const auto took = static_cast<double>(std::clock() - began);
        EXPECT_GT(normals.relief_m, 500);
        least_ms = std::min(least_ms, 1e3 * took / CLOCKS_PER_SEC);
    }
    fmt::print("[ measured ] file, bands and a place: {:.2f} ms\n", least_ms);
    EXPECT_LT(least_ms, 20);  // a guard for slow machines
}

TEST(ClimateMap, SaysWhatIsWrongWithItsFile) {
    const std::filesystem::path folder = test::scratch_dir();
    const auto file_of = [&](const std::string& bytes) {
        const std::filesystem::path path = folder / "climate.bin";
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    };
    const std::string whole = read_text(shipped_file(), "test");
    const auto error = [&](const std::string& bytes) {
        const std::filesystem::path path = file_of(bytes);
        std::string text = error_of([&] { ClimateMap::read(path).at(geodetic_deg(0, 0)); });
        return text.replace(text.find(path.string()), path.string().size(), "FILE");
    };
    EXPECT_EQ(error("elevation"), "exit 3: climate: FILE: damaged; install Relevo again");
    EXPECT_EQ(error("relevo climate 2\n"),
              "exit 3: climate: FILE: no such map of this version; install Relevo again");
    EXPECT_EQ(error(whole.substr(0, whole.size() / 2)),
              "exit 3: climate: FILE: damaged; install Relevo again");
    std::string flipped = whole;
    for (std::size_t at = 1000; at < flipped.size(); at += 1000)
        flipped[at] = static_cast<char>(flipped[at] ^ 16);
    EXPECT_EQ(error(flipped), "exit 3: climate: FILE: damaged; install Relevo again");
    EXPECT_EQ(error(""), "exit 3: climate: FILE: damaged; install Relevo again");
    EXPECT_THAT(error_of([&] { ClimateMap::read(folder / "none.bin"); }),
                testing::EndsWith("; install Relevo again"));
}

}  // namespace
}  // namespace relevo::climate
