// What other programs read of the rasters of light, but for their values: overviews.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "output/raster_writer.h"
#include "support/support.h"

namespace relevo::output {
namespace {

constexpr int kSide = 1024;  // more than a block: with overviews

dem::Grid grid() {
    return {kSide, kSide, {500000, 10, 0, 5200000, 0, -10}, geo::Crs::parse("EPSG:32632", "test")};
}

std::filesystem::path written(const Array2d<float>& values, RasterType type) {
    const std::filesystem::path path = test::scratch_dir("raster") / "figures.tif";
    OutputFile file(path, /*overwrite=*/true, "test");
    RasterWriter writer(file, grid(), type, {{"figures", "1"}});
    writer.put(0, 0, 0, values);
    writer.finish({});
    return path;
}

/// The overview of half the columns and rows.
template <typename Value>
Array2d<Value> overview_of(const std::filesystem::path& path) {
    GDALAllRegister();
    GDALDataset* const dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER);
    GDALRasterBand* const half = dataset->GetRasterBand(1)->GetOverview(0);
    EXPECT_NE(half, nullptr);
    Array2d<Value> values(kSide / 2, kSide / 2);
    EXPECT_EQ(half->GetXSize(), kSide / 2);
    EXPECT_EQ(half->RasterIO(GF_Read, 0, 0, kSide / 2, kSide / 2, values.data(), kSide / 2,
                             kSide / 2, sizeof(Value) == 1 ? GDT_Byte : GDT_Float32, 0, 0),
              CE_None);
    GDALClose(dataset);
    return values;
}

TEST(RasterOverviews, OfAMaskAreItsOwnPostsSoThatAsMuchIsLit) {
    // Lit at a tenth of its posts, each alone: of means none would be left.
    std::mt19937 random(3);
    Array2d<std::uint8_t> mask(kSide, kSide);
    for (std::uint8_t& value : mask)
        value = random() % 10 == 0 ? 1 : random() % 50 == 0 ? 255 : 0;
    Array2d<float> light(kSide, kSide);
    std::ranges::transform(mask, light.begin(), [](std::uint8_t value) {
        return value == 255 ? std::numeric_limits<float>::quiet_NaN() : value;
    });
    const auto half = overview_of<std::uint8_t>(written(light, RasterType::Byte));
    int lit = 0, holes = 0;
    for (int row = 0; row < kSide / 2; ++row)
        for (int column = 0; column < kSide / 2; ++column) {
            const std::uint8_t value = half.at(column, row);
            const std::array<std::uint8_t, 4> own{
                mask.at(2 * column, 2 * row), mask.at(2 * column + 1, 2 * row),
                mask.at(2 * column, 2 * row + 1), mask.at(2 * column + 1, 2 * row + 1)};
            ASSERT_NE(std::find(own.begin(), own.end(), value), own.end());
            lit += value == 1;
            holes += value == 255;
        }
    const double posts = double{1} * kSide * kSide / 4;
    EXPECT_NEAR(lit / posts, 0.1, 0.003);
    EXPECT_NEAR(holes / posts, 0.018, 0.002);
}

TEST(RasterOverviews, OfFiguresAreMeansOfThePostsThatHaveOne) {
    std::mt19937 random(4);
    Array2d<float> hours(kSide, kSide);
    for (float& value : hours)
        value =
            random() % 20 == 0 ? std::nanf("") : 14 * static_cast<float>(random() % 1000) / 1e3F;
    const auto half = overview_of<float>(written(hours, RasterType::Float));
    for (int row = 0; row < kSide / 2; row += 7)
        for (int column = 0; column < kSide / 2; column += 5) {
            double sum = 0;
            int count = 0;
            for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
                const float value = hours.at(2 * column + x, 2 * row + y);
                if (std::isnan(value)) continue;
                sum += double{value};
                ++count;
            }
            if (count == 0) continue;
            ASSERT_NEAR(double{half.at(column, row)}, sum / count, 1e-4);
        }
}

}  // namespace
}  // namespace relevo::output
