#include <cmath>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/array2d.h"
#include "base/units.h"
#include "cli/raster.h"
#include "light/fields.h"
#include "light/point/clear_sky.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light::test_clear_sky {
namespace {

/// What r.sun takes for the sun of a day: its distance and its declination.
struct Day {
    double angle, distance_au, declination_rad;

    explicit Day(int number) : angle(2 * kPi * number / 365.25) {
        distance_au = 1 / std::sqrt(1 + 0.03344 * std::cos(angle - 0.048869));
        declination_rad =
            std::asin(0.3978 * std::sin(angle - 1.4 + 0.0355 * std::sin(angle - 0.0489)));
    }
};

struct Sun {
    double elevation_rad, azimuth_rad;

    Sun(const Day& day, double solar_time_h, double lat_rad) {
        const double hour = radians(15 * (solar_time_h - 12)), d = day.declination_rad;
        const double east = -std::cos(d) * std::sin(hour),
                     north = std::sin(d) * std::cos(lat_rad) -
                             std::cos(d) * std::sin(lat_rad) * std::cos(hour),
                     up = std::sin(d) * std::sin(lat_rad) +
                          std::cos(d) * std::cos(lat_rad) * std::cos(hour);
        elevation_rad = std::asin(up);
        azimuth_rad = std::atan2(east, north);
        if (azimuth_rad < 0) azimuth_rad += 2 * kPi;
    }
};

/// All bands of a raster.
std::vector<Array2d<float>> bands_of(GDALDataset& dataset) {
    std::vector<Array2d<float>> bands;
    for (int k = 1; k <= dataset.GetRasterCount(); ++k) {
        Array2d<float>& band =
            bands.emplace_back(dataset.GetRasterXSize(), dataset.GetRasterYSize());
        EXPECT_EQ(dataset.GetRasterBand(k)->RasterIO(GF_Read, 0, 0, band.width(), band.height(),
                                                     band.data(), band.width(), band.height(),
                                                     GDT_Float32, 0, 0),
                  CE_None);
    }
    return bands;
}

TEST(ClearSky, BeamsAreThoseThatRSunIsExpectedToGive) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const std::string path = (dir / "sun" / "outside" / "grass_rsun_beam.tif").string();
    const test::Dataset dataset = test::opened(path);
    ASSERT_TRUE(dataset);
    const std::vector<Array2d<float>> bands = bands_of(*dataset);
    const dem::Grid grid = dem::Source::open(path).grid();
    const Day day(90);
    const ClearSky clear(3, day.distance_au);
    std::vector<double> off_wh;
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) {
            const auto value = [&](int band) {
                return double{bands[static_cast<std::size_t>(band)].at(column, row)};
            };
            const double slope = radians(value(1)), aspect = radians(value(2));
            const double expected = value(11);
            if ((value(2) == -9999 && slope > 0) || std::isnan(expected)) continue;
            const double lat_rad = grid.place(column, row).lat_rad;
            double sum_wh = 0;
            for (double time_h = 0.125; time_h < 24; time_h += 0.25) {
                const Sun sun(day, time_h, lat_rad);
                const double at = sun.azimuth_rad / radians(45);
                const int k = static_cast<int>(at) % 8;
                const double horizon_deg =
                    value(3 + k) + (at - std::floor(at)) * (value(3 + (k + 1) % 8) - value(3 + k));
                if (sun.elevation_rad <= radians(horizon_deg)) continue;
                const double onto = std::cos(slope) * std::sin(sun.elevation_rad) +
                                    std::sin(slope) * std::cos(sun.elevation_rad) *
                                        std::cos(sun.azimuth_rad - aspect);
                sum_wh += 0.25 * std::max(0.0, onto) * clear.beam(sun.elevation_rad, value(0));
            }
            off_wh.push_back(std::abs(sum_wh - expected));
        }
    std::sort(off_wh.begin(), off_wh.end());
    const auto quantile = [&](double share) {
        return off_wh[static_cast<std::size_t>(share * double(off_wh.size() - 1))];
    };
    fmt::print(
        "[ accuracy ] beams against r.sun's expected raster, {} cells: median {:.4f} Wh/m2 (limit "
        "0.02), 98.9 % within {:.2f} (limit 1), worst {:.1f}\n",
        off_wh.size(), quantile(0.5), quantile(0.989), off_wh.back());
    EXPECT_GT(off_wh.size(), 150'000U);
    EXPECT_LE(quantile(0.5), 0.02);
    EXPECT_LE(quantile(0.989), 1);
}

/// r.sun's surface: Z = -0.0002 (x - 637500)^2 + 0.0002 (y - 221750)^2, 50 m apart.
dem::Heightfield saddle() {
    return test::field_of(
        300, 270, {630025, 50, 0, 228475, 0, -50}, "EPSG:3358", [](int column, int row) {
            const double x = 630025 + 50 * column - 637500.0, y = 228475 - 50 * row - 221750.0;
            return 0.0002 * (y * y - x * x);
        });
}

TEST(ClearSky, OfASaddleBeamsAreAsRSunSumsThemUp) {
    const dem::Heightfield field = saddle();
    const dem::Posts posts(field);
    // Day 90; its sun is at the declination of r.sun's within 0.1 degrees.
    const sun::Instant noon = sun::parse_time("2023-03-31T17:20Z", {}).utc;
    SunHoursOptions options{.step_s = 300, .irradiation = SunHoursOptions::Irradiation{}};
    const SunHours day = sun_hours(posts, noon - 43200.0, noon + 43200.0, options);
    double sum = 0, least = 1e9, most = 0, cells = 0;
    for (int row = 1; row < 269; ++row)
        for (int column = 1; column < 299; ++column) {
            const double beam = 1000 * double{day.beam_kwh.at(column, row)};
            sum += beam;
            least = std::min(least, beam);
            most = std::max(most, beam);
            ++cells;
        }
    fmt::print(
        "[ accuracy ] beams of a saddle: mean {:.1f} Wh/m2 (r.sun 3425.5, a march with its "
        "formulas "
        "3404.7), least {:.1f}, most {:.1f} (6845)\n",
        sum / cells, least, most);
    EXPECT_NEAR(sum / cells, 3404.7, 0.01 * 3404.7);
    EXPECT_NEAR(most, 6845, 0.01 * 6845);
}

TEST(ClearSky, ManyDaysAreAsLongAsTheirDays) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const sun::Instant begin = sun::parse_time("2026-11-01T05:00Z", {}).utc;
    SunHoursOptions options{.step_s = 600, .irradiation = SunHoursOptions::Irradiation{}};
    const SunHours all = sun_hours(posts, begin, begin + 6 * 86400.0, options);
    double worst = 0, sum = 0, count = 0, diffuse = 0;
    const SunHours first = sun_hours(posts, begin, begin + 3 * 86400.0, options),
                   last = sun_hours(posts, begin + 3 * 86400.0, begin + 6 * 86400.0, options);
    double mean = 0;
    for (std::size_t i = 0; i < all.beam_kwh.size(); ++i) {
        const double one = double{first.beam_kwh.data()[i]} + last.beam_kwh.data()[i];
        const double off = std::abs(all.beam_kwh.data()[i] - one);
        worst = std::max(worst, off);
        sum += off;
        mean += one;
        ++count;
        diffuse =
            std::max(diffuse, std::abs(double{first.diffuse_kwh.data()[i]} +
                                       last.diffuse_kwh.data()[i] - all.diffuse_kwh.data()[i]));
    }
    fmt::print(
        "[ accuracy ] beams of six days by directions against the same by suns: off by {:.4f} "
        "kWh/m2 in the mean (limit 1 % of {:.2f}), worst {:.3f}\n",
        sum / count, mean / count, worst);
    EXPECT_LE(sum / mean, 0.01);
    EXPECT_LE(diffuse, 1e-4);
}

TEST(ClearSky, LightOfTheSkyAndOfTheGroundGoByTheSkyView) {
    // A plain at the equator has all of the sky and no ground over it.
    const dem::Heightfield plain = test::field_of(21, 21, {500000, 30, 0, 300, 0, -30},
                                                  "EPSG:32631", [](int, int) { return 0.0; });
    const sun::Instant midnight = sun::parse_time("2026-03-20T00:00Z", {}).utc;
    SunHoursOptions options{.irradiation = SunHoursOptions::Irradiation{}};
    const SunHours day = sun_hours(dem::Posts(plain), midnight, midnight + 86400.0, options);
    EXPECT_NEAR(day.reflected_kwh.at(10, 10), 0, 1e-3);
    // Sums of the model by hand, the sun going through the zenith at a quarter of a degree a
    // minute.
    double beam_wh = 0, diffuse_wh = 0;
    const ClearSky clear(3, 0.9958);
    for (double e = 0.125; e < 90; e += 0.25) {
        beam_wh += 2 / 60.0 * std::sin(radians(e)) * clear.beam(radians(e), 0);
        diffuse_wh += 2 / 60.0 * clear.diffuse(radians(e));
    }
    EXPECT_NEAR(day.beam_kwh.at(10, 10), beam_wh / 1000, 0.003 * beam_wh / 1000);
    EXPECT_NEAR(day.diffuse_kwh.at(10, 10), diffuse_wh / 1000, 0.003 * diffuse_wh / 1000);
    // Under a wall in the north the sun is the same, of the sky there is less.
    const dem::Heightfield wall =
        test::field_of(21, 21, {500000, 30, 0, 300, 0, -30}, "EPSG:32631",
                       [](int, int row) { return row == 5 ? 100.0 : 0.0; });
    options.irradiation->albedo = 0.5;
    const SunHours under = sun_hours(dem::Posts(wall), midnight, midnight + 86400.0, options);
    const double lost = 1 - under.diffuse_kwh.at(10, 10) / day.diffuse_kwh.at(10, 10);
    EXPECT_GT(lost, 0.02);
    EXPECT_NEAR(under.reflected_kwh.at(10, 10), 0.5 * lost * (beam_wh + diffuse_wh) / 1000, 0.002);
}

}  // namespace
}  // namespace relevo::light::test_clear_sky
