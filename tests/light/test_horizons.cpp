#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/parallel_for.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal_support.h"
#include "light/fields.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/quick_math.h"
#include "light/sweep/kernels.h"
#include "light/sweep/sweep.h"
#include "support/support.h"

namespace relevo::light::test_horizons {
namespace {

constexpr double kSphere_m = 6'371'000;
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

double number(const test::Csv& csv, std::size_t row, std::string_view column) {
    return *parse_number(csv.rows[row][csv.column(column)]);
}

/// A direction over a map that is true to scale, by its azimuth from the top of the grid. Exact for
/// the compass rose.
SweepSun way_over(const glm::dvec2& spacing_m, double azimuth_deg, const glm::dvec2& reference) {
    const auto part = [](double deg) {
        const double turned = std::remainder(deg, 360);
        return std::abs(turned) == 90 ? 0.0 : std::cos(radians(turned));
    };
    return sun_over_map(spacing_m, {part(azimuth_deg - 90), -part(azimuth_deg)}, 0.1, reference);
}

/// Elevations of the horizon of a window [degrees].
Array2d<float> horizon_deg(const Array2d<float>& height_m, const glm::dvec2& spacing_m,
                           double azimuth_deg, double curvature, const Window& window) {
    Array2d<float> out(window.columns, window.rows, kHole);
    const Sweep sweep(height_m.data(), height_m.width(), height_m.height(), height_m.width());
    const SweepSun way =
        way_over(spacing_m, azimuth_deg, {double(window.column), double(window.row)});
    sweep.each_horizon(way.ray, curvature, 1e9, {window}, [&](const SweepRun& run) {
        for (int i = 0; i < run.count; ++i)
            out.at(run.column + i - window.column, run.row - window.row) =
                static_cast<float>(degrees(std::atan(double{run.found[i]})));
    });
    return out;
}
Array2d<float> horizon_deg(const Array2d<float>& height_m, const glm::dvec2& spacing_m,
                           double azimuth_deg) {
    return horizon_deg(height_m, spacing_m, azimuth_deg, 0,
                       {0, 0, height_m.width(), height_m.height()});
}

TEST(Horizons, DoNotJumpWhereSweepsGoAlongColumnsInsteadOfRows) {
    // A dome, all of which is its own hull; the ways on both sides of the diagonal of its posts.
    Array2d<float> dome(450, 350);
    for (int row = 0; row < dome.height(); ++row)
        for (int column = 0; column < dome.width(); ++column)
            dome.at(column, row) = static_cast<float>(
                3000 - 0.02 * (std::pow(column - 225, 2) + std::pow(row - 175, 2)));
    const Array2d<float> rows = horizon_deg(dome, {30, 30}, 44.99),
                         columns = horizon_deg(dome, {30, 30}, 45.01);
    double worst = 0;
    for (int row = 10; row < dome.height() - 10; ++row)
        for (int column = 10; column < dome.width() - 10; ++column)
            worst =
                std::max(worst, std::abs(double{rows.at(column, row)} - columns.at(column, row)));
    EXPECT_LT(worst, 0.05);
}

/// The largest of a share of numbers.
double quantile(std::vector<double> numbers, double share) {
    std::sort(numbers.begin(), numbers.end());
    return numbers[static_cast<std::size_t>(share * double(numbers.size() - 1))];
}

TEST(Horizons, AgreeWithCrossingsComputedIndependently) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const dem::Heightfield field =
        dem::load((dir / "dem" / "srtm_bigtujunga30m_utm11.tif").string());
    const test::Csv csv = test::read_csv(dir / "sun" / "terrain_horizon.csv");
    ASSERT_EQ(csv.rows.size(), 720U);
    const glm::dvec2 spacing = field.grid.post_spacing_m();
    const double cell = std::abs(field.grid.affine().x_column);
    EXPECT_NEAR(spacing.x, cell, 0.02);
    for (const bool flat : {true, false}) {
        std::vector<double> errors;
        for (std::size_t i = 0; i < csv.rows.size(); ++i) {
            const int column = static_cast<int>(number(csv, i, "col")),
                      row = static_cast<int>(number(csv, i, "row"));
            const Array2d<float> found =
                horizon_deg(field.height_m, {cell, cell}, number(csv, i, "grid_azimuth_deg"),
                            flat ? 0 : 0.87 / kSphere_m, {column, row, 1, 1});
            // Under the smooth Earth's horizon, which dips by 3 degrees at most, none is followed.
            const auto over_sea = [](double horizon) { return std::max(horizon, -4.0); };
            errors.push_back(
                std::abs(over_sea(found.at(0, 0)) -
                         over_sea(number(csv, i,
                                         flat ? "horizon_crossings_flat_deg"
                                              : "horizon_crossings_curved_k013_deg"))));
        }
        test::print_accuracy(flat ? "horizons against crossings, flat Earth"
                                  : "horizons against crossings, round Earth",
                             errors, "deg", 1);
        EXPECT_LE(quantile(errors, 0.5), 0.001);
        EXPECT_LE(quantile(errors, 0.95), 0.1);
        EXPECT_LE(quantile(errors, 0.99), 0.5);
    }
}

/// A raster of the outside world.
Array2d<float> read_band(const std::filesystem::path& path, int band) {
    dem::prepare_gdal();
    const std::unique_ptr<GDALDataset> dataset(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    Array2d<float> values(dataset->GetRasterXSize(), dataset->GetRasterYSize());
    EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, values.width(), values.height(),
                                                     values.data(), values.width(), values.height(),
                                                     GDT_Float32, 0, 0, nullptr),
              CE_None);
    return values;
}

TEST(Horizons, AgreeWithTopocalcWhereItIsExact) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const std::filesystem::path outside = dir / "sun" / "outside";
    const dem::Heightfield lakes = dem::load((outside / "topocalc_lakes_dem.tif").string());
    // There the ground is the same to the last post: what is left is the fan's, in whose rays a
    // horizon that stands between two is over the post of one.
    std::vector<double> exact, others;
    double bias = 0;
    for (int k = 0; k < 72; ++k) {
        const Array2d<float> theirs = read_band(outside / "topocalc_lakes_horizon.tif", k + 1);
        const Array2d<float> ours = horizon_deg(lakes.height_m, {50, 50}, 5.0 * k);
        ASSERT_EQ(ours.size(), theirs.size());
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const double difference = double{theirs.data()[i]} - std::max(0.0F, ours.data()[i]);
            if (k % 9 == 0) {
                exact.push_back(std::abs(difference));
            } else {
                others.push_back(std::abs(difference));
                bias += difference;
            }
        }
    }
    bias /= double(others.size());
    fmt::print(
        "[ accuracy ] topocalc, 26208 posts: at eight azimuths of the compass rose {:.2f} % within "
        "0.0001 degrees, 99 % within {:.5f} (limit 0.02), 99.9 % within {:.3f} (0.1), worst {:.3f} "
        "(1); at the 64 others, where it takes the nearest post, median {:.3f} (limit 0.2), bias "
        "{:.2f} (0.3 to 0.9)\n",
        100 * double(std::count_if(exact.begin(), exact.end(), [](double d) { return d < 1e-4; })) /
            double(exact.size()),
        quantile(exact, 0.99), quantile(exact, 0.999), quantile(exact, 1), quantile(others, 0.5),
        bias);
    EXPECT_LE(quantile(exact, 0.9), 1e-4);
    EXPECT_LE(quantile(exact, 0.99), 0.02);
    EXPECT_LE(quantile(exact, 0.999), 0.1);
    EXPECT_LE(quantile(exact, 1), 1);
    EXPECT_LE(quantile(others, 0.5), 0.2);
    EXPECT_GE(bias, 0.3);
    EXPECT_LE(bias, 0.9);
}

TEST(Horizons, AreThoseOfARoundWall) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const test::Csv csv = test::read_csv(dir / "sun" / "outside" / "grass_rhorizon_circle.csv");
    // Posts of the region that is N 228500 S 215000 W 630000 E 645000, every 10 m.
    Array2d<float> height_m(1500, 1350);
    for (int row = 0; row < height_m.height(); ++row)
        for (int column = 0; column < height_m.width(); ++column)
            height_m.at(column, row) =
                std::hypot(630005 + 10.0 * column - 637505, 228495 - 10.0 * row - 221755) >= 5000
                    ? 1000.0F
                    : 0.0F;
    const Window eye{750, 674, 1, 1};
    double least = 1, most = -1;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        const double off = horizon_deg(height_m, {10, 10}, number(csv, i, "azimuth_cw_north_deg"),
                                       1 / kSphere_m, eye)
                               .at(0, 0) -
                           number(csv, i, "exact_circle_deg");
        least = std::min(least, off);
        most = std::max(most, off);
    }
    fmt::print(
        "[ accuracy ] a round wall, {} azimuths: {:+.4f} to {:+.4f} degrees (limits -0.03, 0.001; "
        "r.horizon -0.0214 to -0.0001)\n",
        csv.rows.size(), least, most);
    EXPECT_GE(csv.rows.size(), 18U);
    EXPECT_GE(least, -0.03);
    EXPECT_LE(most, 0.001);
}

void compare_with_places(const std::string& name, const dem::Heightfield& field, int count,
                         double median_deg, double most_deg) {
    const dem::Posts posts(field);
    const std::vector<double> azimuths{0.1, 0.8, 2.5, 3.0, 3.9, 4.8, 6.2};
    const Horizons all = horizons(posts, azimuths);
    std::mt19937 lot(20260102);
    std::vector<glm::ivec2> where;
    while (static_cast<int>(where.size()) < count) {
        const glm::ivec2 post(lot() % static_cast<unsigned>(field.grid.columns()),
                              lot() % static_cast<unsigned>(field.grid.rows()));
        if (!std::isnan(field.height_m.at(post.x, post.y))) where.push_back(post);
    }
    std::vector<double> errors(where.size() * azimuths.size());
    parallel_for(0, count, 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const glm::ivec2 post = where[static_cast<std::size_t>(i)];
            const TerrainHorizon horizon(posts, field.grid.place(post.x, post.y));
            for (std::size_t k = 0; k < azimuths.size(); ++k)
                errors[static_cast<std::size_t>(i) * azimuths.size() + k] = std::abs(degrees(
                    all.elevation_rad[k].at(post.x, post.y) - horizon.elevation_rad(azimuths[k])));
        }
    });
    test::print_accuracy(name + ", horizons against those of places", errors, "deg", 1);
    EXPECT_LE(quantile(errors, 0.5), median_deg) << name;
    EXPECT_LE(quantile(errors, 0.99), most_deg) << name;
}

TEST(Horizons, AgreeWithTheExactOnesOfPlaces) {
    for (const char* const name : {"jacksboro.tif", "vancouver-island.tif"})
        compare_with_places(name, test::bundled(name), 300, 0.05, 1);
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* const name :
         {"srtm_bigtujunga30m_utm11.tif", "hawaii_rotated20.tif", "mt_rainier_90m.tif"})
        compare_with_places(name, dem::load((data / "dem" / name).string()), 300, 0.05, 1);
}

TEST(Horizons, HaveTheSameBitsForAnyWidthOfVectorsAndAnyWindow) {
    const Array2d<float> height_m = test::bundled("jacksboro.tif").height_m;
    for (const double azimuth_deg : {3.0, 77.0, 200.0, 283.0}) {
        const Array2d<float> all = horizon_deg(height_m, {75, 92}, azimuth_deg);
        for (const int floats : {1, 4, 8}) {
            set_widest_vector(floats);
            EXPECT_EQ(horizon_deg(height_m, {75, 92}, azimuth_deg), all) << floats;
        }
        set_widest_vector(kVectorFloats);
        // Lines are counted from the window's first post, here as there a post.
        const Window window{0, 0, 150, 90};
        const Array2d<float> part = horizon_deg(height_m, {75, 92}, azimuth_deg, 0, window);
        for (int row = 0; row < window.rows; ++row)
            for (int column = 0; column < window.columns; ++column)
                ASSERT_EQ(part.at(column, row), all.at(column, row)) << column << " " << row;
    }
}

TEST(Horizons, HolesHideNothingAndHaveNone) {
    // A wall with a gap, seen from the west of it.
    const dem::Heightfield field =
        test::field_of(61, 61, {500000, 10, 0, 0, 0, -10}, "EPSG:32631", [](int column, int row) {
            if (column == 40) return row == 30 ? double{kHole} : 50.0;
            return 0.0;
        });
    const Horizons east = horizons(dem::Posts(field), {kPi / 2});
    EXPECT_EQ(east.holes, 1);
    EXPECT_TRUE(std::isnan(east.elevation_rad[0].at(40, 30)));
    EXPECT_NEAR(degrees(east.elevation_rad[0].at(30, 20)), degrees(std::atan(0.5)), 0.1);
    EXPECT_NEAR(degrees(east.elevation_rad[0].at(30, 30)), 0, 0.1);
    EXPECT_EQ(
        east.definition,
        "elevation of the horizon as seen from the ground; ground of the DEM alone, on the WGS 84 "
        "ellipsoid with terrestrial refraction k = 0.13; outside the DEM smooth ground as high as "
        "its edge there");
}

TEST(SkyView, AgreesWithTopocalc) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const std::filesystem::path outside = dir / "sun" / "outside";
    const dem::Heightfield lakes = dem::load((outside / "topocalc_lakes_dem.tif").string());
    const SkyView ours = sky_view(dem::Posts(lakes), {.directions = 72});
    const Array2d<float> theirs = read_band(outside / "topocalc_lakes_skyview.tif", 1);
    std::vector<double> errors;
    // At its borders topocalc takes another slope.
    for (int row = 1; row + 1 < theirs.height(); ++row)
        for (int column = 1; column + 1 < theirs.width(); ++column)
            errors.push_back(std::abs(double{ours.share.at(column, row)} - theirs.at(column, row)));
    double mean = 0;
    for (const double error : errors)
        mean += error / double(errors.size());
    fmt::print("[ accuracy ] sky view against topocalc: mean {:.4f} (limit 0.005)\n", mean);
    test::print_accuracy("sky view against topocalc", errors, "", 0.1);
    EXPECT_LE(mean, 0.005);
}

TEST(SkyView, OfAnInclinedPlaneIsHalfOfOneAndItsCosine) {
    for (const double slope_deg : {0.0, 20.0, 45.0}) {
        const double a_post = 10 * std::tan(radians(slope_deg));
        // Inclined to the north-west; in the middle no edge is near.
        const dem::Heightfield plane = test::field_of(
            401, 401, {500000, 10, 0, 0, 0, -10}, "EPSG:32631",
            [&](int column, int row) { return 5000 + a_post * (column + row) / std::sqrt(2.0); });
        const dem::Posts posts(plane);
        const SkyView inclined = sky_view(posts, {.directions = 180});
        EXPECT_NEAR(inclined.share.at(200, 200), (1 + std::cos(radians(slope_deg))) / 2, 0.002)
            << slope_deg;
        // Of a level plane there: half the horizon is that of the slope.
        double level = 0;
        for (int i = 0; i < 720; ++i) {
            const double rise =
                std::max(0.0, std::tan(radians(slope_deg)) * std::cos(radians(0.5 * i)));
            level += 1 / (1 + rise * rise) / 720;
        }
        EXPECT_NEAR(sky_view(posts, {.directions = 180, .level = true}).share.at(200, 200), level,
                    0.002)
            << slope_deg;
    }
}

TEST(SkyView, MeanIsThatOfTheGroundWithoutItsHoles) {
    // A plain sees all of the sky, however much of it is not there.
    const dem::Heightfield plain =
        test::field_of(60, 40, {500000, 10, 0, 400, 0, -10}, "EPSG:32631", [](int column, int row) {
            const bool is_void = column >= 20 && column < 50 && row >= 10 && row < 30;
            return is_void ? double{kHole} : 7.0;
        });
    const SkyView seen = sky_view(dem::Posts(plain));
    EXPECT_EQ(seen.holes, 30 * 20);
    EXPECT_NEAR(seen.mean, 1, 1e-3);
}

TEST(SkyView, OfASlopeIsRelatedToWhatTheSlopeSeesAlone) {
    // The sides of a long valley rise by s. Half-way up, the other side stands h over the horizon:
    // of the sky (1 + cos(s + h)) / 2 is left, and an endless slope sees (1 + cos s) / 2.
    for (const double slope_deg : {10.0, 30.0, 60.0}) {
        const double a_post = 10 * std::tan(radians(slope_deg));
        const dem::Heightfield valley =
            test::field_of(41, 601, {500000, 10, 0, 3000, 0, -10}, "EPSG:32631",
                           [&](int column, int) { return a_post * std::abs(column - 20); });
        const SkyView seen =
            sky_view(dem::Posts(valley), {.directions = 180, .of_open_slope = true});
        const double h = std::atan(10 * a_post / 300);
        EXPECT_NEAR(seen.share.at(30, 300),
                    (1 + std::cos(radians(slope_deg) + h)) / (1 + std::cos(radians(slope_deg))),
                    0.01)
            << slope_deg;
    }
}

TEST(SkyView, FewerDirectionsAreNotFarOff) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const SkyView many = sky_view(posts, {.directions = 360}), usual = sky_view(posts);
    std::vector<double> errors;
    for (std::size_t i = 0; i < many.share.size(); ++i)
        errors.push_back(std::abs(double{many.share.data()[i]} - usual.share.data()[i]));
    test::print_accuracy("sky view of 36 directions against 360", errors, "", 0.02);
    EXPECT_LE(quantile(errors, 0.99), 0.01);
    EXPECT_EQ(test::error_of([&] { sky_view(posts, {.directions = 3}); }),
              "exit 3: sky view: 3 directions: expected 4 to 3600");
}

TEST(QuickMath, ArcTangent) {
    double worst = 0;
    for (double t = 0; t < 200; t = t * 1.01 + 1e-4)
        worst =
            std::max(worst, std::abs(double{quick_atan(float(t))} - std::atan(double{float(t)})));
    EXPECT_LE(worst, 2e-7);
}

}  // namespace
}  // namespace relevo::light::test_horizons
