#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dem/load.h"
#include "dem/sample.h"
#include "fixture.h"

namespace relevo::dem::test_sample {
namespace {

using test::folder;
using test::Raster;

/// A plane, of which every mean is known, with a void in one corner.
Source plane(const std::vector<std::string>& layout, bool with_void) {
    Raster raster;
    raster.columns = 2050;
    raster.rows = 1555;
    raster.options = layout;
    raster.nodata = -9999;
    raster.value = [=](int column, int row, int) {
        return with_void && column > 1600 && row > 1200 ? -9999.0 : 100 + 0.25 * column + row;
    };
    return Source::open(test::write_raster(folder() / "plane.tif", raster));
}

struct Layout {
    std::vector<std::string> options;
    double worst_m;  // columns differ by 0.25, rows by 1
};

class Sample : public testing::TestWithParam<Layout> {};

TEST_P(Sample, IsThePlaneItIsTakenFrom) {
    const Source source = plane(GetParam().options, false);
    const Array2d<float> means = sample_means(source, 16, 2050 * 1555 / 9);
    ASSERT_EQ(means.width(), 128);
    ASSERT_EQ(means.height(), 97);
    double worst_m = 0;
    // Beyond the outermost blocks that are read, values are continued.
    for (int row = 30; row < 67; ++row)
        for (int column = 40; column < 88; ++column) {
            const double truth_m = 100 + 0.25 * (16 * column + 7.5) + 16 * row + 7.5;
            worst_m = std::max(worst_m, std::abs(means.at(column, row) - truth_m));
        }
    EXPECT_LE(worst_m, GetParam().worst_m);
}

TEST_P(Sample, CoversTheWholeAndKeepsVoids) {
    const Source source = plane(GetParam().options, true);
    const Array2d<float> means = sample_means(source, 16, 2050 * 1555 / 9);
    int voids = 0;
    for (int row = 0; row < means.height(); ++row)
        for (int column = 0; column < means.width(); ++column)
            voids += std::isnan(means.at(column, row));
    EXPECT_NEAR(voids, 450 * 355 / 256, 450 * 355 / 256 / 2);
    EXPECT_TRUE(std::isnan(means.at(127, 96)));
    EXPECT_FALSE(std::isnan(means.at(0, 96)));
    EXPECT_FALSE(std::isnan(means.at(127, 0)));
}

TEST_P(Sample, OfAllBlocksIsExactWhereTheyAreWhole) {
    const Source source = plane(GetParam().options, false);
    const Array2d<float> all = source.read({0, 0, 2048, 1552}, 128, 97);
    const Array2d<float> means = sample_means(source, 16, std::int64_t{1} << 30);
    for (int row = 0; row < 97; ++row)
        for (int column = 0; column < 128; ++column)
            // A strip of less than a mean's rows stands for all of them.
            EXPECT_NEAR(means.at(column, row), all.at(column, row), GetParam().worst_m);
}

INSTANTIATE_TEST_SUITE_P(Layouts, Sample,
                         testing::Values(Layout{{"COMPRESS=LZW", "BLOCKYSIZE=1"}, 8},
                                         Layout{{"COMPRESS=LZW", "BLOCKYSIZE=7"}, 8},
                                         Layout{{"COMPRESS=LZW", "BLOCKYSIZE=64"}, 0.01},
                                         Layout{{"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128"},
                                                0.01}));

}  // namespace
}  // namespace relevo::dem::test_sample
