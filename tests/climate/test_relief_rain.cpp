#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/units.h"
#include "climate/fine_cover.h"
#include "support/support.h"

namespace relevo::climate::test_relief_rain {
namespace {

using geo::geodetic_deg;

/// Heights of a file in degrees, nearest posts.
class File {
  public:
    explicit File(const std::string& path) {
        GDALAllRegister();
        const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> dataset(
            GDALDataset::Open(path.c_str(), GDAL_OF_RASTER),
            [](GDALDataset* open) { delete open; });
        dataset->GetGeoTransform(place_);
        heights_ = Array2d<float>(dataset->GetRasterXSize(), dataset->GetRasterYSize());
        EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(
                      GF_Read, 0, 0, heights_.width(), heights_.height(), heights_.data(),
                      heights_.width(), heights_.height(), GDT_Float32, 0, 0),
                  CE_None);
    }

    float operator()(const geo::Geodetic& place) const {
        const double lon_deg = degrees(place.lon_rad) + (place.lon_rad < 0 ? 360 : 0);
        const int column = static_cast<int>(std::floor((lon_deg - place_[0]) / place_[1])),
                  row = static_cast<int>(
                      std::floor((degrees(place.lat_rad) - place_[3]) / place_[5]));
        if (column < 0 || row < 0 || column >= heights_.width() || row >= heights_.height())
            return NAN;
        return heights_.at(column, row);
    }

  private:
    double place_[6]{};
    Array2d<float> heights_;
};

struct Known {
    const char* name;
    double lat_deg, lon_deg;
    bool wet;  // more than 2000 mm a year; the others have less than 800
};

// T. W. Giambelluca et al., Online Rainfall Atlas of Hawaii, Bull. Amer. Meteor. Soc. 94, 2013, in
// round numbers.
constexpr Known kKnown[] = {
    {"Hilo", 19.72, -155.08, true},          {"Laupahoehoe", 19.98, -155.24, true},
    {"Volcano", 19.43, -155.23, true},       {"Hana", 20.75, -155.99, true},
    {"Kona airport", 19.73, -156.04, false}, {"Kawaihae", 20.04, -155.82, false},
    {"South Point", 18.95, -155.67, false},  {"Lahaina", 20.88, -156.67, false},
    {"Kihei", 20.75, -156.45, false},        {"Honolulu airport", 21.32, -157.92, false},
    {"Kekaha", 21.97, -159.72, false},       {"Lanai", 20.83, -156.92, false},
};

TEST(ReliefRain, TellsTheDrySidesOfIslandsFromTheWetOnes) {
    SKIP_WITHOUT_TEST_DATA(data);
    const File file("NETCDF:" + (data / "dem/HI_topo_04.nc").string());
    constexpr double kApart_deg = 1.0 / 12;
    Array2d<float> heights(85, 61);
    const auto place = [](int column, int row) {
        return geodetic_deg(18 + row * kApart_deg, -161 + column * kApart_deg);
    };
    for (int row = 0; row < heights.height(); ++row)
        for (int column = 0; column < heights.width(); ++column)
            heights.at(column, row) = std::max(file(place(column, row)), 0.0F);
    const double apart_m = kApart_deg * 111'200;
    const TradeWind wind = trade_wind(geodetic_deg(20.5, -157.5));
    EXPECT_EQ(wind.share, 1);
    const Array2d<float> factors =
        relief_rain(heights, {apart_m * std::cos(radians(20.5)), apart_m}, wind);
    float least_wet = 10, most_dry = 0;
    for (const Known& known : kKnown) {
        const float factor =
            factors.at(static_cast<int>(std::lround((known.lon_deg + 161) / kApart_deg)),
                       static_cast<int>(std::lround((known.lat_deg - 18) / kApart_deg)));
        fmt::print("[ accuracy ] {}: {:.2f} of the rain, known as {}\n", known.name, factor,
                   known.wet ? "wet" : "dry");
        if (known.wet)
            least_wet = std::min(least_wet, factor);
        else
            most_dry = std::max(most_dry, factor);
    }
    EXPECT_GT(least_wet, most_dry);
}

TEST(ReliefRain, FallsBeforeAMountainWhateverTheWind) {
    Array2d<float> heights(33, 33);
    for (int row = 0; row < 33; ++row)
        for (int column = 0; column < 33; ++column)
            heights.at(column, row) = static_cast<float>(
                1500 * std::exp(-0.02 * (std::pow(column - 16, 2) + std::pow(row - 16, 2))) - 100);
    for (const double from_deg : {0.0, 90.0, 180.0, 270.0}) {
        const Array2d<float> factors =
            relief_rain(heights, {2000, 2000}, {.from_rad = radians(from_deg), .share = 1});
        const int x = static_cast<int>(std::lround(5 * std::sin(radians(from_deg)))),
                  y = static_cast<int>(std::lround(5 * std::cos(radians(from_deg))));
        EXPECT_GT(factors.at(16 + x, 16 + y), 2.5F * factors.at(16 - x, 16 - y)) << from_deg;
        double sum = 0;
        int land = 0;
        for (int row = 0; row < 33; ++row)
            for (int column = 0; column < 33; ++column)
                if (heights.at(column, row) > 0) {
                    sum += factors.at(column, row);
                    ++land;
                }
        EXPECT_NEAR(sum / land, 1, 0.15) << from_deg;  // but for its bounds
    }
}

TEST(ReliefRain, IsOneWithoutTradeWinds) {
    EXPECT_EQ(trade_wind(geodetic_deg(47, 11)).share, 0);
    EXPECT_EQ(trade_wind(geodetic_deg(15, 74)).share, 0);     // Western Ghats: monsoon
    EXPECT_EQ(trade_wind(geodetic_deg(-21, 55.5)).share, 1);  // La Reunion
    const Array2d<float> hill(9, 9, 500);
    for (const float factor : relief_rain(hill, {1000, 1000}, {}))
        EXPECT_EQ(factor, 1);
    EXPECT_EQ(rain_above_inversion(4000, {}), 1);
    EXPECT_LT(rain_above_inversion(4000, {.share = 1}), 0.1);
    EXPECT_EQ(rain_above_inversion(1900, {.share = 1}), 1);
}

}  // namespace
}  // namespace relevo::climate::test_relief_rain
