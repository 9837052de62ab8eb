// Rivers that are found in made-up valleys, and in Tyrol.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "climate/cover.h"
#include "climate/rivers.h"
#include "support/support.h"

namespace relevo::climate::test_rivers {
namespace {

constexpr double kApart_m = 200;

/// A valley from the first row down to the last one, which falls by 0.5 % and winds along
/// floor(row) [columns].
class Valley {
  public:
    static constexpr int kWidth = 96, kRows = 160;

    explicit Valley(double lowest_m = 50) : heights_(kWidth, kRows) {
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kWidth; ++column)
                heights_.at(column, row) =
                    static_cast<float>(lowest_m + (kRows - 1 - row) +
                                       20 * std::max(std::abs(column - floor(row)) - 1, 0.0));
    }

    static double floor(double row) { return 48 + 12 * std::sin(row / 25); }

    Array2d<float>& heights() { return heights_; }
    Array2d<RiverSite> rivers(float dryness, double apart_m = kApart_m) const {
        return climate::rivers(
            {.height_m = heights_,
             .apart_m = {apart_m, apart_m},
             .place =
                 [](double column, double row) {
                     return geo::geodetic_deg(47 - row * kApart_m / kDegree_m,
                                              11 + column * kApart_m / kDegree_m);
                 },
             .growing = [=](const geo::Geodetic&,
                            float) { return Growing{.dryness = dryness, .temperature_c = 8}; }});
    }

  private:
    Array2d<float> heights_;
};

/// The site of the widest river near the valley's floor.
int river_column(const Array2d<RiverSite>& rivers, int row) {
    const int middle = static_cast<int>(std::lround(Valley::floor(row)));
    int widest = middle;
    for (int column = middle - 1; column <= middle + 1; ++column)
        if (rivers.at(column, row).width_m > rivers.at(widest, row).width_m) widest = column;
    return widest;
}

TEST(Rivers, RunAlongTheFloorOfAValleyAndGrow) {
    const Array2d<RiverSite> rivers = Valley().rivers(3);
    float before_m = 0;
    for (int row = 20; row < Valley::kRows - 3; ++row) {
        const int column = river_column(rivers, row);
        const RiverSite& river = rivers.at(column, row);
        ASSERT_GT(river.width_m, 0) << row;
        EXPECT_GE(river.width_m, 0.999F * before_m) << row;
        const double along_row = river.off_m / kApart_m / std::cos(river.normal_rad);
        EXPECT_NEAR(column + along_row, Valley::floor(row), 1) << row;
        before_m = river.width_m;
    }
    // 96 x 160 sites of 0.04 km2, of which nearly all drain to the last row's river: 614 km2 with
    // 3 x 300 mm of rain, of which exp(-2/3) runs off, are 9.0 m3/s.
    EXPECT_NEAR(before_m, 7 * std::sqrt(9.0), 1.5);
    // Slopes of 10 % have none.
    for (int row = 20; row < Valley::kRows - 3; ++row)
        EXPECT_EQ(rivers.at(static_cast<int>(Valley::floor(row)) - 20, row).width_m, 0) << row;
}

TEST(Rivers, LeaveHollowsOverTheirRim) {
    Valley valley;
    for (int row = 70; row < 85; ++row)  // deeper than the valley's floor below it for 40 rows
        for (int column = 0; column < Valley::kWidth; ++column)
            valley.heights().at(column, row) -= 100;
    const Array2d<RiverSite> rivers = valley.rivers(3);
    const Array2d<RiverSite> whole = Valley().rivers(3);
    const int row = 150, column = static_cast<int>(std::lround(Valley::floor(row)));
    EXPECT_NEAR(rivers.at(column, row).width_m, whole.at(column, row).width_m, 0.5);
}

TEST(Rivers, NeedRainAndNearSitesAndEndInTheSeaAndInVoids) {
    const Array2d<RiverSite> dry = Valley().rivers(0.3F);
    EXPECT_TRUE(std::ranges::all_of(dry, [](const RiverSite& s) { return s.width_m == 0; }));
    const Array2d<RiverSite> far = Valley().rivers(3, 1001);
    EXPECT_TRUE(std::ranges::all_of(far, [](const RiverSite& s) { return s.width_m == 0; }));
    // Below 0 from row 60 on.
    const Array2d<RiverSite> sea = Valley(-99).rivers(3);
    const auto at = [](int row) { return static_cast<int>(std::lround(Valley::floor(row))); };
    EXPECT_GT(sea.at(at(50), 50).width_m, 0);
    for (int row = 64; row < Valley::kRows; ++row)
        EXPECT_LT(sea.at(at(row), row).width_m, 0.5F * sea.at(at(50), 50).width_m)
            << row;  // brooks on the shore
    Valley holed;
    for (int column = 0; column < Valley::kWidth; ++column)
        holed.heights().at(column, 100) = NAN;
    const Array2d<RiverSite> parted = holed.rivers(3);
    EXPECT_GT(parted.at(at(96), 96).width_m, 0);
    EXPECT_LT(parted.at(at(115), 115).width_m, 0.6F * parted.at(at(96), 96).width_m);
    // None of these is a raster with a river, and none ends the program.
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 2), std::pair(1, 9)}) {
        const Array2d<float> few(width, height, 10);
        EXPECT_EQ(
            rivers({.height_m = few,
                    .apart_m = {kApart_m, kApart_m},
                    .place = [](double, double) { return geo::geodetic_deg(47, 11); },
                    .growing = [](const geo::Geodetic&, float) { return Growing{.dryness = 3}; }})
                .size(),
            few.size());
    }
}

/// Heights of a DEM in degrees, every so many posts.
struct Thinned {
    Array2d<float> heights;
    std::array<double, 6> transform{};

    Thinned(const std::filesystem::path& file, int every) {
        GDALAllRegister();
        const GDALDatasetUniquePtr data(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
        data->GetGeoTransform(transform.data());
        const int width = data->GetRasterXSize(), height = data->GetRasterYSize();
        Array2d<float> all(width, height);
        EXPECT_EQ(data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, all.data(), width,
                                                   height, GDT_Float32, 0, 0),
                  CE_None);
        heights = Array2d<float>((width - 1) / every + 1, (height - 1) / every + 1);
        for (int row = 0; row < heights.height(); ++row)
            for (int column = 0; column < heights.width(); ++column)
                heights.at(column, row) = all.at(column * every, row * every);
        for (const std::size_t i : {1U, 5U})
            transform[i] *= every;
    }
    glm::dvec2 site(double lat, double lon) const {
        return {(lon - transform[0]) / transform[1] - 0.5,
                (lat - transform[3]) / transform[5] - 0.5};
    }
    geo::Geodetic place(double column, double row) const {
        return geo::geodetic_deg(transform[3] + (row + 0.5) * transform[5],
                                 transform[0] + (column + 0.5) * transform[1]);
    }
};

TEST(Rivers, OfTyrolAreWhereTheyAre) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Thinned dem(data / "dem/tyrol_aw3d30_n47e011_1s_cog.tif", 8);
    const ClimateMap climate = ClimateMap::shipped();
    const CoverColumn climate_there(climate.at(geo::geodetic_deg(47.3, 11.5)));
    const glm::dvec2 apart_m(8 * kDegree_m / 3600 * std::cos(radians(47.5)), 8 * kDegree_m / 3600);
    const Array2d<RiverSite> found =
        rivers({.height_m = dem.heights,
                .apart_m = apart_m,
                .place = [&](double c, double r) { return dem.place(c, r); },
                .growing =
                    [&](const geo::Geodetic&, float height_m) {
                        return Growing{
                            .dryness = static_cast<float>(climate_there.dryness(height_m)),
                            .temperature_c = static_cast<float>(climate_there.mean_c(height_m))};
                    }});
    struct Known {
        const char* name;
        double lat, lon;
        float least_m;
    };
    // Bridges over rivers.
    for (const Known& known :
         {Known{"Inn, Hall", 47.2755, 11.5060, 25}, Known{"Inn, Schwaz", 47.3478, 11.7050, 25},
          Known{"Inn, Rattenberg", 47.4402, 11.8920, 25},
          Known{"Sill, Matrei", 47.1290, 11.4510, 8}, Known{"Ziller, Zell", 47.2330, 11.8810, 8},
          Known{"Isar, Lenggries", 47.6820, 11.5690, 10},
          Known{"Isar, Bad Toelz", 47.7610, 11.5560, 10}}) {
        // Valley floors are 2 km wide and more, and level.
        const glm::ivec2 at(round(dem.site(known.lat, known.lon)));
        RiverSite river;
        for (int row = at.y - 2; row <= at.y + 2; ++row)
            for (int column = at.x - 2; column <= at.x + 2; ++column)
                if (const RiverSite& one = found.at(column, row); one.width_m > river.width_m)
                    river = one;
        fmt::print("[ rivers ] {}: {:.0f} m wide\n", known.name, river.width_m);
        EXPECT_GT(river.width_m, known.least_m) << known.name;
    }
}

}  // namespace
}  // namespace relevo::climate::test_rivers
