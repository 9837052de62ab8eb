#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

// The same ground, written in several ways, is the same picture.

namespace relevo::test::test_dialects {
namespace {

constexpr int kPosts = 97;
constexpr double kCell = 0.001;

/// Mountains without any symmetry [m], on degrees east and north of the south-west corner.
double ground_m(double east, double north) {
    const double ridge = std::exp(-std::pow((north - 0.03 - 0.5 * east) / 0.012, 2));
    const double peak =
        std::exp(-(std::pow((east - 0.07) / 0.01, 2) + std::pow((north - 0.02) / 0.015, 2)));
    return 800 + 9000 * east * north + 900 * ridge + 1400 * peak;
}

bool is_hole(double east, double north) {
    return std::hypot(east - 0.025, north - 0.07) < 0.008;
}

/// The ground on cells of this geotransform (corners, degrees from the south-west corner).
Raster raster_on(const std::array<double, 6>& g, double lon_deg, double lat_deg, double hole_m) {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = kPosts;
    raster.geotransform = {{lon_deg + g[0], g[1], g[2], lat_deg + g[3], g[4], g[5]}};
    raster.nodata = hole_m;
    raster.value = [=](int column, int row, int) {
        const double c = column + 0.5, r = row + 0.5;
        const double east = g[0] + g[1] * c + g[2] * r, north = g[3] + g[4] * c + g[5] * r;
        return is_hole(east, north) ? hole_m : ground_m(east, north);
    };
    return raster;
}

constexpr double kSide = kPosts * kCell;
constexpr std::array<double, 6> kNorthUp = {0, kCell, 0, kSide, 0, -kCell};

class DialectPicture : public testing::Test {
  protected:
    std::filesystem::path dir_ = scratch_dir("cli_dialects");

    /// Of the bare ground: patterns of materials begin at the first post.
    image::Image8 picture(const std::vector<std::string>& dems,
                          const std::vector<std::string>& more = {}) {
        const std::string out = (dir_ / fmt::format("{}.png", ++count_)).string();
        std::vector<std::string> arguments{"-q", "capture", "--holes", "cut"};
        arguments.insert(arguments.end(), dems.begin(), dems.end());
        arguments.insert(arguments.end(),
                         {"-o", out, "--size", "400x300", "--time", "2026-06-21T07:00Z", "--device",
                          "software", "--only", ""});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(out);
    }
    std::string written(const char* name, const Raster& raster) {
        return write_raster(dir_ / name, raster);
    }

    int count_ = 0;
};

TEST_F(DialectPicture, WhicheverWayRowsAndColumnsRun) {
    // An orbit is fitted to some thousand posts, counted from the first.
    const std::vector<std::string> view{"--eye", "46.93,10.93,6000", "--look-at",
                                        "47.05,11.05,900"};
    const image::Image8 north_up =
        picture({written("north_up.tif", raster_on(kNorthUp, 11, 47, -9999))}, view);
    const struct {
        const char* name;
        std::array<double, 6> g;
    } ways[] = {{"south_up.tif", {0, kCell, 0, 0, 0, kCell}},
                {"westward.tif", {kSide, -kCell, 0, kSide, 0, -kCell}},
                {"columns_south.tif", {0, 0, kCell, kSide, -kCell, 0}},
                {"columns_north.tif", {kSide, 0, -kCell, 0, kCell, 0}}};
    for (const auto& way : ways) {
        const image::Image8 other =
            picture({written(way.name, raster_on(way.g, 11, 47, -9999))}, view);
        const double psnr_db = image::compare(north_up, other).psnr_db;
        fmt::print("[ accuracy ] {}: {:.1f} dB to north up (limit 50)\n", way.name, psnr_db);
        // Triangles are cut along the other diagonal.
        EXPECT_GT(psnr_db, 50) << way.name;
    }
    const image::Image8 mirrored =
        picture({written("mirrored.tif",
                         [&] {
                             Raster raster = raster_on(kNorthUp, 11, 47, -9999);
                             const auto value = raster.value;
                             raster.value = [value](int c, int r, int b) {
                                 return value(c, kPosts - 1 - r, b);
                             };
                             return raster;
                         }())},
                view);
    EXPECT_LT(image::compare(north_up, mirrored).psnr_db, 30);
}

TEST_F(DialectPicture, HolesAreTheSameDeclaredOrNot) {
    const std::vector<std::string> view{"--view", "whole"};  // others cut near corners
    const std::string declared = written("declared.tif", raster_on(kNorthUp, 11, 47, -9999));
    const image::Image8 expected = picture({declared}, view);
    Raster undeclared = raster_on(kNorthUp, 11, 47, -32768);
    undeclared.nodata.reset();
    EXPECT_EQ(
        image::compare(expected, picture({written("undeclared.tif", undeclared)}, view)).worst, 0);
    Raster zero = raster_on(kNorthUp, 11, 47, 0);
    zero.nodata.reset();
    EXPECT_EQ(image::compare(expected, picture({written("zero.tif", zero)}, view)).worst, 0);
    Raster masked = raster_on(kNorthUp, 11, 47, 500);
    masked.nodata.reset();
    masked.mask = [](int c, int r) {
        return !is_hole(kCell * (c + 0.5), kSide - kCell * (r + 0.5));
    };
    EXPECT_EQ(image::compare(expected, picture({written("masked.tif", masked)}, view)).worst, 0);
    // And not those of a DEM without.
    Raster whole = raster_on(kNorthUp, 11, 47, -9999);
    whole.value = [](int c, int r, int) {
        return ground_m(kCell * (c + 0.5), kSide - kCell * (r + 0.5));
    };
    EXPECT_GT(image::compare(expected, picture({written("whole.tif", whole)}, view)).worst, 20);
}

TEST_F(DialectPicture, TilesAreThePictureOfTheWhole) {
    const auto piece = [](int column, int row, int columns, int rows, double lon_deg) {
        Raster raster = raster_on(kNorthUp, lon_deg, -17, -9999);
        raster.columns = columns;
        raster.rows = rows;
        raster.geotransform = {
            {lon_deg + kCell * column, kCell, 0, -17 + kSide - kCell * row, 0, -kCell}};
        const auto value = raster.value;
        raster.value = [=](int c, int r, int b) { return value(c + column, r + row, b); };
        return raster;
    };
    // The antimeridian is 50 columns in; the tiles overlap by one.
    const double lon_deg = 180 - 50 * kCell;
    const image::Image8 whole =
        picture({written("across.tif", piece(0, 0, kPosts, kPosts, lon_deg))});
    const std::string west = written("w.tif", piece(0, 0, 51, kPosts, lon_deg));
    const std::string north_east = written("ne.tif", piece(50, 0, kPosts - 50, 40, lon_deg - 360));
    const std::string south_east =
        written("se.tif", piece(50, 39, kPosts - 50, kPosts - 39, lon_deg - 360));
    // Longitudes of the tiles east of it are rounded on their own.
    EXPECT_GT(image::compare(whole, picture({west, north_east, south_east})).psnr_db, 60);
    EXPECT_GT(image::compare(whole, picture({south_east, west, north_east})).psnr_db, 60);
}

/// Share of a picture that is not the paper it is drawn on.
double drawn_share(const image::Image8& picture) {
    int drawn = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::uint8_t* const pixel = picture.row(y) + x * picture.channels;
            drawn += pixel[0] < 250 || pixel[1] < 250 || pixel[2] < 250;
        }
    return drawn / double(picture.width * picture.height);
}

TEST_F(DialectPicture, MapsOfTheWorldShowTheirGround) {
    // The same hills over the northern hemisphere's middle, on a globe seen from above.
    const auto world = [&](const char* name, const char* crs, double half_width_m,
                           double half_height_m, int columns, int rows) {
        Raster raster;
        raster.crs = crs;
        raster.columns = columns;
        raster.rows = rows;
        raster.geotransform = {{-half_width_m, 2 * half_width_m / columns, 0, half_height_m, 0,
                                -2 * half_height_m / rows}};
        raster.value = [](int column, int row, int) { return 10.0 * ((column + row) % 50); };
        return picture({written(name, raster)}, {"--view", "az=180,el=60,zoom=1"});
    };
    const double orthographic = drawn_share(world(
        "ortho.tif", "+proj=ortho +lat_0=47 +lon_0=11 +R=6371000", 6371000, 6371000, 256, 256));
    const double mollweide =
        drawn_share(world("mollweide.tif", "ESRI:54009", 18040096, 9020048, 512, 256));
    fmt::print("[ share    ] drawn: orthographic {:.3f}, Mollweide {:.3f}\n", orthographic,
               mollweide);
    EXPECT_GT(orthographic, 0.2);
    EXPECT_GT(mollweide, 0.2);
}

}  // namespace
}  // namespace relevo::test::test_dialects
