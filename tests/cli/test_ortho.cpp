#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>

#include "cli/program.h"
#include "cli/raster.h"
#include "image/image.h"
#include "support/support.h"

// Maps lie on their source. The picture's own file says where its pixels are, GDAL reads it, and
// GDAL says where the posts of the source are: nothing of what places the ground is used here.

namespace relevo::test::test_ortho {
namespace {

using Transform = std::array<double, 6>;
using testing::HasSubstr;

struct Point {
    double x = 0, y = 0;
};

Point transformed(const Transform& t, const Point& at) {
    return {t[0] + t[1] * at.x + t[2] * at.y, t[3] + t[4] * at.x + t[5] * at.y};
}

Transform transform_of(GDALDataset& dataset) {
    Transform t{};
    EXPECT_EQ(dataset.GetGeoTransform(t.data()), CE_None);
    return t;
}

/// Numbers of a grid; NaN where there are none.
struct Field {
    int width = 0, height = 0;
    std::vector<double> values;

    double at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    /// Between the values, which are at whole numbers.
    double between(const Point& p) const {
        const double x = std::floor(p.x), y = std::floor(p.y);
        if (!(x >= 0 && y >= 0 && x + 1 < width && y + 1 < height)) return std::nan("");
        const int i = static_cast<int>(x), j = static_cast<int>(y);
        const double u = p.x - x, v = p.y - y;
        return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
               v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
    }
};

struct Source {
    Field heights_m;
    Transform transform{};
    bool in_degrees = false;

    explicit Source(const std::string& path) {
        const Dataset dataset = opened(path);
        transform = transform_of(*dataset);
        in_degrees = dataset->GetSpatialRef()->IsGeographic() != 0;
        heights_m.width = dataset->GetRasterXSize();
        heights_m.height = dataset->GetRasterYSize();
        heights_m.values.resize(static_cast<std::size_t>(heights_m.width) *
                                static_cast<std::size_t>(heights_m.height));
        GDALRasterBand& band = *dataset->GetRasterBand(1);
        EXPECT_EQ(
            band.RasterIO(GF_Read, 0, 0, heights_m.width, heights_m.height, heights_m.values.data(),
                          heights_m.width, heights_m.height, GDT_Float64, 0, 0, nullptr),
            CE_None);
        int has = 0;
        const double none = band.GetNoDataValue(&has);
        for (double& value : heights_m.values)
            if (has && value == none) value = std::nan("");
    }

    /// Metres of a unit of the CRS along x and y, at a point.
    Point unit_m(const Point& at) const {
        constexpr double kDegree_m = 111195;
        if (!in_degrees) return {1, 1};
        return {kDegree_m * std::cos(at.y * std::numbers::pi / 180), kDegree_m};
    }

    /// Lambert's shade of each post under a sun, 0 to 1.
    Field shade(double azimuth_deg, double elevation_deg) const {
        const double to_rad = std::numbers::pi / 180;
        const double a = azimuth_deg * to_rad, e = elevation_deg * to_rad;
        Field shade{heights_m.width, heights_m.height, heights_m.values};
        std::ranges::fill(shade.values, std::nan(""));
        const double det = transform[1] * transform[5] - transform[2] * transform[4];
        for (int y = 1; y + 1 < heights_m.height; ++y)
            for (int x = 1; x + 1 < heights_m.width; ++x) {
                const double column = 0.5 * (heights_m.at(x + 1, y) - heights_m.at(x - 1, y));
                const double row = 0.5 * (heights_m.at(x, y + 1) - heights_m.at(x, y - 1));
                const Point m = unit_m(transformed(transform, {x + 0.5, y + 0.5}));
                const double east = (transform[5] * column - transform[4] * row) / det / m.x;
                const double north = (transform[1] * row - transform[2] * column) / det / m.y;
                const double lit =
                    std::sin(e) - std::cos(e) * (std::sin(a) * east + std::cos(a) * north);
                shade.values[static_cast<std::size_t>(y * shade.width + x)] =
                    std::max(lit, 0.0) / std::sqrt(1 + east * east + north * north);
            }
        return shade;
    }
};

/// A part of a picture [px].
struct Block {
    int left, top, right, bottom;
};

/// Correlation of a picture's brightness with a function of the pixel, over pixels that have both.
double correlation(const Field& picture, const Block& block,
                   const std::function<double(const Point&)>& of) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (int y = block.top; y < block.bottom; ++y)
        for (int x = block.left; x < block.right; ++x) {
            const double a = picture.at(x, y), b = of({x + 0.5, y + 0.5});
            if (std::isnan(a) || std::isnan(b)) continue;
            ++n;
            sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
        }
    if (n < 400) return std::nan("");
    return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

struct Shift {
    Point px;
    double correlation = 0;
};

/// By how much a picture is off, from the peak of a parabola through the correlations at shifts of
/// one pixel.
Shift shift_of(const Field& picture, const Block& block,
               const std::function<double(const Point&)>& of) {
    const auto at = [&](double dx, double dy) {
        return correlation(picture, block, [&](const Point& p) {
            return of({p.x - dx, p.y - dy});
        });
    };
    const auto peak = [](double before, double here, double after) {
        return 0.5 * (before - after) / (before - 2 * here + after);
    };
    const double here = at(0, 0);
    return {{peak(at(-1, 0), here, at(1, 0)), peak(at(0, -1), here, at(0, 1))}, here};
}

Field brightness_of(const std::filesystem::path& path) {
    const image::ImageF image = image::read_float(path);
    Field field{image.width, image.height, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool hidden = image.channels == 4 && image.at(x, y, 3) < 1;
            field.values.push_back(hidden ? std::nan("") : double{image.at(x, y, 1)});
        }
    return field;
}

struct Sun {
    double azimuth_deg, elevation_deg;
};

class Ortho : public testing::Test {
  protected:
    /// Draws a map of bare ground. @returns its path
    std::filesystem::path draw(const std::string& dem, const std::string& name,
                               std::vector<std::string> more = {}) {
        const std::filesystem::path path = dir_ / name;
        more.insert(more.begin(),
                    {"-q", "capture", dem, "--ortho", "-o", path.string(), "--only", "", "--time",
                     "2026-06-21T16:30", "--tz", "solar", "--sidecar", "--overwrite"});
        const Result run = relevo(more);
        EXPECT_EQ(run.status, 0) << run.err;
        return path;
    }

    static Sun sun(const std::filesystem::path& picture) {
        const std::string text = read_text(picture.string() + ".json");
        const nlohmann::json json = nlohmann::json::parse(text);
        return {json["sun"]["azimuth_deg"], json["sun"]["apparent_elevation_deg"]};
    }

    static std::string read_text(const std::string& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    /// Expects that a map of a DEM lies on it to a tenth of a pixel, in the whole and in each of
    /// its nine parts, and prints by how much it is off.
    void expect_on_source(const std::string& dem, const std::string& name,
                          const std::vector<std::string>& more) {
        const std::filesystem::path path = draw(dem, name, more);
        const Source source(dem);
        const Field shade = source.shade(sun(path).azimuth_deg, sun(path).elevation_deg);
        const Field picture = brightness_of(path);
        const Dataset map = opened(path.string());
        ASSERT_TRUE(map);
        const Transform to_crs = transform_of(*map);
        Transform to_cells{};
        ASSERT_EQ(
            GDALInvGeoTransform(const_cast<double*>(source.transform.data()), to_cells.data()), 1);
        const auto of = [&](const Point& p) {
            const Point cell = transformed(to_cells, transformed(to_crs, p));
            return shade.between({cell.x - 0.5, cell.y - 0.5});
        };
        const Shift whole = shift_of(picture, {0, 0, picture.width, picture.height}, of);
        double worst = 0;
        int parts = 0;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                const Block block{i * picture.width / 3, j * picture.height / 3,
                                  (i + 1) * picture.width / 3, (j + 1) * picture.height / 3};
                const Shift part = shift_of(picture, block, of);
                if (!(part.correlation > 0.5)) continue;
                ++parts;
                worst = std::max({worst, std::abs(part.px.x), std::abs(part.px.y)});
            }
        fmt::print(
            "[ accuracy ] {} {} x {}: off by {:.3f}, {:.3f} px at correlation {:.3f}; worst "
            "of {} parts {:.3f} px (limit 0.1)\n",
            name, picture.width, picture.height, whole.px.x, whole.px.y, whole.correlation, parts,
            worst);
        EXPECT_GT(whole.correlation, 0.8);
        EXPECT_LT(std::hypot(whole.px.x, whole.px.y), 0.1);
        EXPECT_GE(parts, 5);
        EXPECT_LT(worst, 0.1);
    }

    std::filesystem::path dir_ = scratch_dir("cli_ortho");
};

TEST_F(Ortho, LiesOnADemInUtm) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::string dem = (data / "dem/srtm_bigtujunga30m_utm11.tif").string();
    expect_on_source(dem, "utm.tif", {"--size", "900x900"});
    expect_on_source(dem, "utm_fine.png", {"--size", "1500x1500"});
}

TEST_F(Ortho, LiesOnADemInDegreesWithAHighSummit) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::string dem = (data / "dem/mt_rainier_90m.tif").string();
    expect_on_source(dem, "degrees.tif", {"--size", "1000x1000"});
    expect_on_source(dem, "degrees.jpg", {"--size", "700x700", "--exaggerate", "3"});
}

TEST_F(Ortho, LiesOnATurnedDem) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::string dem = (data / "dem/hawaii_rotated20.tif").string();
    expect_on_source(dem, "turned.tif", {"--size", "700x700", "--transparent"});
    expect_on_source(dem, "turned.webp", {"--resolution", "61", "--transparent"});
}

TEST_F(Ortho, TilesAndSamplesLieThere) {
    // 72 million pixels: more than a frame has.
    if (std::getenv("RELEVO_SLOW_TESTS"))
        expect_on_source(bundled_dem(), "large.png", {"--size", "9000x8000"});
    expect_on_source(bundled_dem(), "samples.png", {"--size", "300x300", "--samples", "4"});
}

TEST_F(Ortho, HasTheEdgesOfItsSource) {
    const std::filesystem::path path = draw(bundled_dem(), "edges.tif", {"--size", "500x500"});
    const Dataset map = opened(path.string()), source = opened(bundled_dem());
    const Transform ours = transform_of(*map), theirs = transform_of(*source);
    const auto far = [](GDALDataset& dataset, const Transform& t) {
        return transformed(t, {double(dataset.GetRasterXSize()), double(dataset.GetRasterYSize())});
    };
    EXPECT_NEAR(ours[0], theirs[0], 1e-9);
    EXPECT_NEAR(ours[3], theirs[3], 1e-9);
    EXPECT_NEAR(far(*map, ours).x, far(*source, theirs).x, 1e-9);
    EXPECT_NEAR(far(*map, ours).y, far(*source, theirs).y, 1e-9);
    EXPECT_TRUE(map->GetSpatialRef()->IsSame(source->GetSpatialRef()));
    EXPECT_EQ(map->GetRasterCount(), 3);
    // Ground to the last pixel: no backdrop, which would be as bright in all of them.
    const Field picture = brightness_of(path);
    const Field transparent =
        brightness_of(draw(bundled_dem(), "whole.tif", {"--size", "500x500", "--transparent"}));
    EXPECT_EQ(std::ranges::count_if(transparent.values, [](double v) { return std::isnan(v); }), 0);
}

TEST_F(Ortho, APictureIsMadeAgainFromItsFile) {
    const std::filesystem::path first = draw(bundled_dem(), "first.tif", {"--size", "200x200"});
    const std::filesystem::path again = dir_ / "again.png";
    EXPECT_EQ(
        relevo({"-q", "capture", "--from", first.string(), "-o", again.string(), "--overwrite"})
            .status,
        0);
    EXPECT_EQ(image::compare(image::read(first), image::read(again)).worst, 0);
    EXPECT_TRUE(std::filesystem::exists(dir_ / "again.pgw"));
}

TEST_F(Ortho, AJobMakesMapsAndResumesThem) {
    const std::filesystem::path job = dir_ / "job.json";
    std::ofstream(job) << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                       << R"("]}, "picture": {"ortho": true, "size": [120, 120]},
                       "time": {"at": "10:00", "date": "2026-06-21"}, "effects": {"only": []},
                       "sweep": [{"times": {"from": "10:00", "to": "14:00", "step": "4h"}}],
                       "output": "map_{n}.png"})";
    const Result made = relevo({"run", job.string()});
    EXPECT_EQ(made.status, 0) << made.err;
    for (const char* name : {"map_1.png", "map_1.pgw", "map_1.png.aux.xml", "map_2.pgw"})
        EXPECT_TRUE(std::filesystem::exists(dir_ / name)) << name;
    std::filesystem::remove(dir_ / "map_2.pgw");
    const Result again = relevo({"run", job.string(), "--resume"});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(again.err, HasSubstr("1 pictures in"));
    EXPECT_TRUE(std::filesystem::exists(dir_ / "map_2.pgw"));
}

TEST_F(Ortho, RefusesWhatExcludesIt) {
    const std::string out = (dir_ / "a.png").string();
    const auto expect = [&](std::vector<std::string> more, int status, const std::string& message) {
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", out});
        expect_failure(more, status, message);
    };
    expect({"--ortho", "--view", "top"}, 2,
           "--ortho and the camera of --view, --eye, --look-at, --heading or --pitch exclude each "
           "other; --view top is a picture from above that has a camera");
    expect({"--ortho", "--resolution", "1", "--size", "9x9"}, 2,
           "--resolution and --size exclude each other; use one");
    expect({"--resolution", "1"}, 3,
           "--resolution: needs --ortho; --size is the size of other pictures");
    expect_failure({"-q", "capture", bundled_dem(), "--ortho", "--layers", "all", "-o",
                    (dir_ / "a.exr").string()},
                   3,
                   "--layers: depth: a map of --ortho has no eye to measure from; name the others");
    expect_failure({"-q", "capture", bundled_dem(), "--ortho", "-o", "-", "--format", "png"}, 2,
                   "-o -: the place of a map is in a file next to it; name a file, or add --format "
                   "tif");
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Ortho, ASceneOfAMapRefusesACamera) {
    const std::filesystem::path map = draw(bundled_dem(), "scene.tif", {"--size", "40x40"});
    expect_failure({"-q", "capture", "--from", map.string(), "--view", "top", "-o",
                    (dir_ / "seen.png").string()},
                   2,
                   "--ortho and the camera of --view, --eye, --look-at, --heading or --pitch "
                   "exclude each other; --view top is a picture from above that has a camera");
    const std::filesystem::path job = dir_ / "cameras.json";
    std::ofstream(job) << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                       << R"("]}, "picture": {"ortho": true}, "sweep": [
                       {"cameras": [{"name": "a"}, {"name": "b"}]}], "output": "{camera}.png"})";
    expect_failure({"-q", "run", job.string()}, 3,
                   "job: " + job.string() +
                       ":2: sweep[0].cameras: a map has no camera; remove picture.ortho, or this");
    const std::filesystem::path shots = dir_ / "shots.json";
    std::ofstream(shots) << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                         << R"("]}, "picture": {"ortho": true},
                         "shots": [{"name": "a"}, {"name": "b",
                         "camera": {"orbit": {"azimuth": 90}}}], "output": "{shot}.png"})";
    expect_failure({"-q", "run", shots.string()}, 3,
                   "job: " + shots.string() +
                       ":3: shots[1].camera: a map has no camera; remove picture.ortho, or this");
}

TEST_F(Ortho, LinearLightHasNoMargin) {
    const image::ImageF plain =
        image::read_float(draw(bundled_dem(), "plain.exr", {"--size", "200x90"}));
    const image::ImageF margin =
        image::read_float(draw(bundled_dem(), "margin.exr", {"--size", "200x90", "--margin"}));
    EXPECT_LT(plain.width, 200);
    EXPECT_EQ(margin.width, plain.width);
    EXPECT_EQ(margin.values, plain.values);
}

TEST_F(Ortho, FilesOfAnEarlierMapAreReported) {
    const std::filesystem::path map = draw(bundled_dem(), "again.png", {"--size", "40x40"});
    const auto capture = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"capture", bundled_dem(), "-o", map.string(), "--size", "40x40",
                                   "--overwrite", "--time", "2026-06-21T16:30", "--only", ""});
        const Result run = relevo(more);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.err;
    };
    EXPECT_THAT(capture({"--view", "top"}),
                HasSubstr((dir_ / "again.pgw").string() +
                          ": belongs to another picture, and this one is no map; delete it, or "
                          "GIS programs place this one by it"));
    EXPECT_THAT(capture({"--ortho"}), testing::Not(HasSubstr("belongs to another")));
}

TEST_F(Ortho, OpensItsDemOnce) {
    const std::filesystem::path dem = dir_ / "undeclared.asc";
    std::ofstream file(dem);
    file << "ncols 20\nnrows 20\nxllcorner 500000\nyllcorner 5200000\ncellsize 30\n";
    for (int i = 0; i < 400; ++i)
        file << (i == 150 ? -9999 : 100 + 3 * (i / 20) + 2 * (i % 20)) << '\n';
    file.close();
    const Result run =
        relevo({"-v", "capture", dem.string(), "--crs", "EPSG:32632", "--ortho", "-o",
                (dir_ / "once.png").string(), "--size", "40x40", "--only", "", "--overwrite"});
    EXPECT_EQ(run.status, 0) << run.err;
    const std::string guess = "-9999 is taken as a void";
    const std::size_t first = run.err.find(guess);
    ASSERT_NE(first, std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(guess, first + 1), std::string::npos) << run.err;
}

TEST_F(Ortho, LeavesNothingWhereAFileIsInTheWay) {
    std::ofstream(dir_ / "taken.pgw") << "mine";
    const Result run = relevo({"-q", "capture", bundled_dem(), "--ortho", "-o",
                               (dir_ / "taken.png").string(), "--size", "50x50"});
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr("taken.pgw"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "taken.png"));
    EXPECT_EQ(read_text((dir_ / "taken.pgw").string()), "mine");
}

TEST_F(Ortho, LiesOnTheDemThatComesAlong) {
    expect_on_source(bundled_dem(), "bundled.tif", {"--size", "600x600"});
}

}  // namespace
}  // namespace relevo::test::test_ortho
