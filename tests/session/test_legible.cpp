// Whether what is seen in a picture from above is the ground's shape.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "dem/posts.h"
#include "light/raster/horizons.h"
#include "light/raster/shadows.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "sun/position.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_legible {
namespace {

constexpr int kSide_px = 320, kWide_px = 16;
constexpr std::size_t kPredictors = 4;
using Values = Array2d<double>;

const double kNone = std::numeric_limits<double>::quiet_NaN();

/// Which ground is to be seen: that above water, or the floor of the sea too.
enum class Seen { Land, LandAndFloor };

/// Of one DEM, what its picture may be explained by: incidence of the sun, whether it is in sight,
/// both at once, and the sky that is in sight.
class Predictors {
  public:
    Predictors(const LoadedDem& dem, const geo::LocalFrame& frame, const sun::Position& sun,
               Seen ground)
        : field_(dem.field) {
        const dem::Posts posts(field_);
        const double ce = std::cos(sun.elevation_rad);
        const glm::dvec3 to_sun(ce * std::sin(sun.azimuth_rad), ce * std::cos(sun.azimuth_rad),
                                std::sin(sun.elevation_rad));
        const Array2d<float> lit =
            light::shadows(posts, light::SunOverDem::of(sun), {.soft = true}).lit;
        const Array2d<float> sky = light::sky_view(posts, {.directions = 8}).share;
        const int width = field_.height_m.width(), height = field_.height_m.height();
        for (Array2d<float>& one : of_posts_)
            one = Array2d<float>(width, height, std::numeric_limits<float>::quiet_NaN());
        Array2d<glm::dvec3> at(width, height, glm::dvec3(kNone));
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                at.at(column, row) = frame.to_local(field_.place(column, row));
        for (int row = 1; row + 1 < height; ++row)
            for (int column = 1; column + 1 < width; ++column) {
                if (dem.drawn.water.any()) {
                    const dem::WaterKind kind = dem.drawn.water.kind.at(column, row);
                    const bool floor =
                        ground == Seen::LandAndFloor && kind == dem::WaterKind::SeaFloor;
                    if (kind != dem::WaterKind::None && !floor) continue;
                }
                glm::dvec3 normal =
                    normalize(cross(at.at(column + 1, row) - at.at(column - 1, row),
                                    at.at(column, row + 1) - at.at(column, row - 1)));
                if (normal.z < 0) normal = -normal;
                const double incidence = std::max(dot(normal, to_sun), 0.0);
                const double share = lit.at(column, row);
                const std::array<double, kPredictors> values{incidence, share, incidence * share,
                                                             sky.at(column, row)};
                for (std::size_t k = 0; k < kPredictors; ++k)
                    of_posts_[k].at(column, row) = static_cast<float>(values[k]);
            }
    }

    /// The mean over a pixel. @param post, wide  its middle and its width, posts
    std::array<double, kPredictors> at(const glm::dvec2& post, double wide) const {
        std::array<double, kPredictors> mean{};
        const int samples = std::clamp(static_cast<int>(std::ceil(wide)) + 1, 1, 6);
        for (int i = 0; i < samples; ++i)
            for (int j = 0; j < samples; ++j) {
                const glm::dvec2 p =
                    post + wide * ((glm::dvec2(i, j) + 0.5) / static_cast<double>(samples) - 0.5);
                for (std::size_t k = 0; k < kPredictors; ++k)
                    mean[k] += between(of_posts_[k], p) / (samples * samples);
            }
        return mean;
    }

  private:
    static double between(const Array2d<float>& values, const glm::dvec2& p) {
        const int column = static_cast<int>(std::floor(p.x)),
                  row = static_cast<int>(std::floor(p.y));
        if (column < 0 || row < 0 || column + 1 >= values.width() || row + 1 >= values.height())
            return kNone;
        const double tx = p.x - column, ty = p.y - row;
        return (1 - ty) * ((1 - tx) * values.at(column, row) + tx * values.at(column + 1, row)) +
               ty * ((1 - tx) * values.at(column, row + 1) + tx * values.at(column + 1, row + 1));
    }

    const dem::Heightfield& field_;
    std::array<Array2d<float>, kPredictors> of_posts_;
};

/// Leaves out what the others leave out.
Values only_where(Values values, const Values& others) {
    for (int y = 0; y < values.height(); ++y)
        for (int x = 0; x < values.width(); ++x)
            if (std::isnan(others.at(x, y))) values.at(x, y) = kNone;
    return values;
}

/// For each pixel, the sum and the number of those in reach along a row or a column that are not
/// NaN. A pixel reaches kWide_px / 2 to both sides.
struct Sums {
    Values sum, count;

    Sums(const Values& values, const Values& counts, glm::ivec2 along)
        : sum(values.width(), values.height(), 0), count(values.width(), values.height(), 0) {
        for (int y = 0; y < values.height(); ++y)
            for (int x = 0; x < values.width(); ++x)
                for (int i = -kWide_px / 2; i <= kWide_px / 2; ++i) {
                    const int u = x + i * along.x, v = y + i * along.y;
                    if (u < 0 || v < 0 || u >= values.width() || v >= values.height()) continue;
                    const double value = values.at(u, v);
                    if (std::isnan(value)) continue;
                    sum.at(x, y) += value;
                    count.at(x, y) += counts.at(u, v);
                }
    }
};

/// Values less the mean of the square around each, which reaches kWide_px / 2 to all sides. NaN
/// does not count.
Values narrow(const Values& values) {
    const Sums rows(values, Values(values.width(), values.height(), 1), {1, 0});
    const Sums all(rows.sum, rows.count, {0, 1});
    Values result(values.width(), values.height(), kNone);
    for (int y = 0; y < values.height(); ++y)
        for (int x = 0; x < values.width(); ++x)
            if (const double count = all.count.at(x, y); count > kWide_px * kWide_px / 2)
                result.at(x, y) = values.at(x, y) - all.sum.at(x, y) / count;
    return result;
}

double linear(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double lightness(double luminance) {
    return luminance > 0.008856 ? 116 * std::cbrt(luminance) - 16 : 903.3 * luminance;
}

/// How light pixels are: as eyes tell luminance, CIE 1976 L*, of which differences are as large as
/// they look, where a border of snow is a hundred times the luminance of a wooded slope's light and
/// shade; or as a picture's bytes do, luma of Rec. 709.
enum class Lightness { LStar, Luma };

Values lightness_of(const image::Image8& picture, Lightness as = Lightness::LStar) {
    Values result(picture.width, picture.height, 0);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto sum = [&](const auto& of) {
                return 0.2126 * of(picture.at(x, y, 0) / 255.0) +
                       0.7152 * of(picture.at(x, y, 1) / 255.0) +
                       0.0722 * of(picture.at(x, y, 2) / 255.0);
            };
            result.at(x, y) =
                as == Lightness::LStar ? lightness(sum(linear)) : sum([](double v) { return v; });
        }
    return result;
}

/// Share of the variance of `values` that a sum of the predictors explains: least squares.
double explained(const Values& values, const std::array<Values, kPredictors>& by) {
    std::array<std::array<double, kPredictors + 1>, kPredictors> system{};
    double variance = 0;
    for (int y = 0; y < values.height(); ++y)
        for (int x = 0; x < values.width(); ++x) {
            std::array<double, kPredictors> row{};
            double whole = values.at(x, y);
            for (std::size_t k = 0; k < kPredictors; ++k)
                whole += row[k] = by[k].at(x, y);
            if (std::isnan(whole)) continue;
            const double value = values.at(x, y);
            variance += value * value;
            for (std::size_t i = 0; i < kPredictors; ++i) {
                for (std::size_t j = 0; j < kPredictors; ++j)
                    system[i][j] += row[i] * row[j];
                system[i][kPredictors] += row[i] * value;
            }
        }
    std::array<double, kPredictors> right{};
    for (std::size_t i = 0; i < kPredictors; ++i) {
        right[i] = system[i][kPredictors];
        system[i][i] = (1 + 1e-9) * system[i][i] + 1e-9;  // a DEM may have no cast shadow
    }
    for (std::size_t i = 0; i < kPredictors; ++i)
        for (std::size_t other = 0; other < kPredictors; ++other) {
            if (other == i) continue;
            const double factor = system[other][i] / system[i][i];
            for (std::size_t j = i; j <= kPredictors; ++j)
                system[other][j] -= factor * system[i][j];
        }
    double sum = 0;
    for (std::size_t i = 0; i < kPredictors; ++i)
        sum += system[i][kPredictors] / system[i][i] * right[i];
    return sum / variance;
}

/// By what light explains of pictures of the climate's ground alone, of the ground that is the
/// default, of white ground and of the paper's.
struct Explained {
    double plain = 0, paper = 0, plain_luma = 0, covered = 0, white = 0;
};

image::Image8 picture_of(Session& session) {
    session.draw();
    return session.picture();
}

Explained explained_of(const std::string& dem, Seen to_see = Seen::Land) {
    scene::Scene scene;
    scene.dems = {dem};
    scene.width_px = scene.height_px = kSide_px;
    scene.view = scene::parse_view("top");
    scene.stamps.legend = false;
    scene.land_cover.climate_alone = true;
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    const image::Image8 picture = picture_of(session);
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    const SeenGround seen(session.camera(), kSide_px, kSide_px, std::move(depths_m));
    const geo::LocalFrame& frame = session.ground().frame;
    const Predictors predictors(*session.dem(), frame,
                                sun::position(session.time(), frame.origin()), to_see);
    std::array<Values, kPredictors> by;
    by.fill(Values(kSide_px, kSide_px, kNone));
    const glm::dvec2 spacing_m = session.dem()->field.grid.post_spacing_m();
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x) {
            const auto point = seen.point(x, y);
            if (!point) continue;
            const double pixel_m = 1 / seen.px_per_m(seen.depth_m(x, y));
            const auto values =
                predictors.at(session.dem()->field.grid.post(frame.to_geodetic(*point)),
                              pixel_m / std::sqrt(spacing_m.x * spacing_m.y));
            for (std::size_t k = 0; k < kPredictors; ++k)
                by[k].at(x, y) = values[k];
        }
    const Values ground = by.front();
    for (Values& one : by)
        one = narrow(one);
    const auto other = [&](const std::function<void(scene::Scene&)>& change) {
        scene::Scene changed = session.scene();
        change(changed);
        FilesInUse more_files;
        Session of(changed, {.device = test::gl_device(), .dem = session.dem()}, more_files);
        test::set_time(of, session.time());
        return lightness_of(picture_of(of));
    };
    const auto of_ground = [&](const Values& values) {
        return explained(narrow(only_where(values, ground)), by);
    };
    return {
        .plain = of_ground(lightness_of(picture)),
        .paper = of_ground(other([](scene::Scene& s) { s.effects.presets = {"paper"}; })),
        .plain_luma = of_ground(lightness_of(picture, Lightness::Luma)),
        .covered = of_ground(other([](scene::Scene& s) { s.land_cover.climate_alone = false; })),
        .white = of_ground(other([](scene::Scene& s) {
            s.effects.switches.enable = {"tint"};
            s.effects.switches.disable = {"cover"};
            s.effects.settings = {{"tint.by", "plain"}};
        }))};
}

TEST(Legible, WhatIsSeenFromAboveIsRelief) {
    SKIP_WITHOUT_TEST_DATA(data);
    Explained mean;
    const std::vector<std::string> names{
        "N42E001.hgt",         "mt_rainier_90m.tif", "srtm_bigtujunga30m_utm11.tif",
        "SainteHelens.dem",    "rmnp/rmnp-dem.tif",  "colorado_tut_relief.nc",
        "missoula_valley.img", "holyroodpark.tif",   "swellendam/srtm_41_19_4326.tif",
        "hawaii_rotated20.tif"};
    for (const std::string& name : names) {
        const Explained one = explained_of((data / "dem" / name).string());
        fmt::print(
            "[ accuracy ] {}: light explains {:.0f} % of the paper's picture, {:.0f} % of the "
            "climate's, {:.0f} % of its luma, {:.0f} % of that with land cover, {:.0f} % on "
            "white\n",
            name, 100 * one.paper, 100 * one.plain, 100 * one.plain_luma, 100 * one.covered,
            100 * one.white);
        EXPECT_GT(one.plain, 0.3) << name;
        EXPECT_GT(one.covered, 0.2) << name;
        EXPECT_GT(one.white, 0.6) << name;
        mean.paper += one.paper / static_cast<double>(names.size());
        mean.plain += one.plain / static_cast<double>(names.size());
        mean.plain_luma += one.plain_luma / static_cast<double>(names.size());
        mean.covered += one.covered / static_cast<double>(names.size());
    }
    fmt::print("[ accuracy ] in the mean {:.0f} %, {:.0f} %, {:.0f} % and {:.0f} %\n",
               100 * mean.paper, 100 * mean.plain, 100 * mean.plain_luma, 100 * mean.covered);
    EXPECT_GE(mean.covered, 0.5);
    EXPECT_GE(mean.plain, 0.6);
    EXPECT_GE(mean.plain_luma, 0.6);
    EXPECT_LE(1 - mean.plain, 0.5 * (1 - mean.paper));
}

/// A DEM of 240 x 240 posts.
/// @param height_m  at x, y of -1..1 from west to east and from north to south
std::string scripted(const std::string& name, double spacing_m,
                     const std::function<double(double x, double y)>& height_m) {
    test::Raster raster;
    raster.columns = raster.rows = 240;
    raster.geotransform = {{500000, spacing_m, 0, 5200000, 0, -spacing_m}};
    raster.value = [&](int column, int row, int) {
        // Gullies of some posts, as on all slopes; less of them on level ground.
        const double x = column / 120.0 - 1, y = row / 120.0 - 1;
        const double gullies = std::sin(92 * x + 5 * std::sin(7 * y)) * std::sin(97 * y + 4 * x);
        return height_m(x, y) + 0.4 * spacing_m * gullies;
    };
    return test::write_raster(test::scratch_dir("floor_" + name) / (name + ".tif"), raster);
}

TEST(Legible, TheFloorOfTheSeaIsSeen) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::vector<std::string> dems{
        (data / "dem/HI_topo_04.nc").string(), (data / "dem/monterey_bay_topobathy.tif").string(),
        scripted("seamount", 500,
                 [](double x, double y) { return -4800 + 3900 * std::exp(-6 * (x * x + y * y)); }),
        scripted("canyon", 200,
                 [](double x, double y) {
                     const double shelf = -120 - 1700 / (1 + std::exp(-9 * (x + 0.1)));
                     const double away = (y - 0.25 * std::sin(4 * x)) / 0.12;
                     return x < -0.9 ? 150.0 : shelf - 700 * std::exp(-away * away);
                 }),
        scripted("fjord", 60, [](double x, double y) {
            const double away = (y - 0.2 * std::sin(3 * x)) / 0.3;
            return 900 - 1300 * std::exp(-away * away);
        })};
    for (const std::string& dem : dems) {
        const Explained one = explained_of(dem, Seen::LandAndFloor);
        fmt::print(
            "[ accuracy ] {}: light explains {:.0f} % of the lightness with the sea's floor, "
            "{:.0f} % of the luma\n",
            std::filesystem::path(dem).filename().string(), 100 * one.plain, 100 * one.plain_luma);
        EXPECT_GE(one.plain, 0.5) << dem;
        EXPECT_GE(one.plain_luma, 0.5) << dem;
    }
}

TEST(Legible, NoSeaLiesInTheShadowOfItsFloor) {
    SKIP_WITHOUT_TEST_DATA(data);
    // Hawaii, 1500 km wide: how high water stands over its floor is found a continent away.
    scene::Scene scene;
    scene.dems = {(data / "dem/HI_topo_04.nc").string()};
    scene.width_px = 320;
    scene.height_px = 200;
    FilesInUse files, more_files;
    Session lit(scene, {.device = test::gl_device()}, files);
    const Values with = lightness_of(picture_of(lit));
    scene = lit.scene();
    scene.effects.switches.disable = {"shadows"};
    Session bare(scene, {.device = test::gl_device(), .dem = lit.dem()}, more_files);
    test::set_time(bare, lit.time());
    const Values without = lightness_of(picture_of(bare));
    int darker = 0;
    for (int y = 0; y < scene.height_px; ++y)
        for (int x = 0; x < scene.width_px; ++x)
            darker += with.at(x, y) < without.at(x, y) - 2;
    fmt::print("[ accuracy ] {:.2f} % of the picture is darker for shadows\n",
               100.0 * darker / (scene.width_px * scene.height_px));
    EXPECT_LT(darker, 0.01 * scene.width_px * scene.height_px);
}

}  // namespace
}  // namespace relevo::session::test_legible
