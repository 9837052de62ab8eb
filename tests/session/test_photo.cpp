// Where a photograph lies on the ground: against GDAL's warp.
#include <cmath>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gdal_utils.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "dem/pyramid.h"
#include "dem/source.h"
#include "overlay/photo.h"
#include "render/overlay_raster.h"
#include "render/pages.h"
#include "session/overlay.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_photo {
namespace {

namespace fs = std::filesystem;

/// Warps a raster by GDAL. @returns the new file
std::string warped(const std::string& file, const std::string& name,
                   const std::vector<std::string>& arguments) {
    GDALAllRegister();
    CPLStringList words;
    for (const std::string& word : arguments)
        words.AddString(word.c_str());
    const std::string path = (test::scratch_dir("photos") / name).string();
    GDALDatasetH source = GDALOpen(file.c_str(), GA_ReadOnly);
    GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(words.List(), nullptr);
    int failed_at_usage = 0;
    GDALDatasetH result = GDALWarp(path.c_str(), nullptr, 1, &source, options, &failed_at_usage);
    GDALWarpAppOptionsFree(options);
    GDALClose(source);
    if (!result) failed("GDALWarp: no result");
    GDALClose(result);
    return path;
}

/// Colours in degrees, as GDAL's warp makes them.
class Reference {
  public:
    explicit Reference(const std::string& file) {
        const std::string path =
            warped(file, "reference.tif", {"-t_srs", "EPSG:4326", "-r", "bilinear", "-overwrite"});
        GDALDatasetH dataset = GDALOpen(path.c_str(), GA_ReadOnly);
        GDALGetGeoTransform(dataset, transform_.data());
        width_ = GDALGetRasterXSize(dataset);
        height_ = GDALGetRasterYSize(dataset);
        for (int k = 0; k < 3; ++k) {
            bands_[k].resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
            if (GDALRasterIO(GDALGetRasterBand(dataset, k + 1), GF_Read, 0, 0, width_, height_,
                             bands_[k].data(), width_, height_, GDT_Float32, 0, 0) != CE_None)
                failed("reference: not read");
        }
        GDALClose(dataset);
    }

    /// Pixel of a place, with fractions; integers are centres.
    glm::dvec2 pixel(const geo::Geodetic& at) const {
        return {(degrees(at.lon_rad) - transform_[0]) / transform_[1] - 0.5,
                (degrees(at.lat_rad) - transform_[3]) / transform_[5] - 0.5};
    }
    geo::Geodetic place(const glm::dvec2& pixel) const {
        return {radians(transform_[3] + (pixel.y + 0.5) * transform_[5]),
                radians(transform_[0] + (pixel.x + 0.5) * transform_[1]), 0};
    }
    glm::dvec2 middle() const { return {0.5 * width_, 0.5 * height_}; }

    double at(const glm::dvec2& pixel, int k) const {
        const int column = static_cast<int>(pixel.x), row = static_cast<int>(pixel.y);
        const double u = pixel.x - column, v = pixel.y - row;
        const auto value = [&](int i, int j) {
            return double{
                bands_[k][static_cast<std::size_t>(row + j) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(column + i)]};
        };
        return (1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) +
               v * ((1 - u) * value(0, 1) + u * value(1, 1));
    }

  private:
    std::array<double, 6> transform_{};
    int width_ = 0, height_ = 0;
    std::array<std::vector<float>, 3> bands_;
};

struct Found {
    double shift_px;  ///< of the image's pixels
    double mean_off;  ///< of colours, 0 to 255
};

/// The shift that explains best how drawn colours differ from the reference, by its gradients.
/// @param dem    over which the photo lies
/// @param px_m       a pixel of the photo on the ground
/// @param as_effect  drawn by the effect drape instead of as an overlay
Found off_the_reference(const std::string& dem, const std::string& photo,
                        const Reference& reference, double px_m, bool as_effect) {
    constexpr int kSide = 256;
    scene::Scene scene;
    scene.dems = {dem};
    scene.time.at = "2026-06-21T18:00Z";
    scene.effects.switches.only = std::vector<std::string>{};
    scene.width_px = scene.height_px = kSide;
    if (as_effect) {
        scene.effects.switches.only = std::vector<std::string>{"drape"};
        scene.effects.settings = {{"drape.file", photo}, {"drape.light", "flat"}};
    } else {
        scene.overlay = scene::Overlay{.file = photo};
    }
    geo::Geodetic eye = reference.place(reference.middle());
    // A pixel of the photo has two of the picture.
    eye.height_m = 2000 + 0.5 * kSide * px_m / (2 * std::tan(radians(10)));
    scene.view = {.eye = scene::Standpoint{eye}, .heading_deg = 0, .pitch_deg = -90};
    scene.view.fov_y_rad = radians(20);
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 picture = session.picture();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    const SeenGround seen(session.camera(), kSide, kSide, depths_m);
    double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0, off = 0;
    int count = 0;
    for (int y = 8; y < kSide - 8; ++y)
        for (int x = 8; x < kSide - 8; ++x) {
            if (!seen.point(x, y)) continue;
            const glm::dvec2 at =
                reference.pixel(session.ground().frame.to_geodetic(*seen.point(x, y)));
            for (int k = 0; k < 3; ++k) {
                const double gx = reference.at(at + glm::dvec2(1, 0), k) -
                                  reference.at(at - glm::dvec2(1, 0), k),
                             gy = reference.at(at + glm::dvec2(0, 1), k) -
                                  reference.at(at - glm::dvec2(0, 1), k);
                const double d = picture.at(x, y, k) - reference.at(at, k);
                xx += gx * gx / 4;
                xy += gx * gy / 4;
                yy += gy * gy / 4;
                xd += gx * d / 2;
                yd += gy * d / 2;
                off += std::abs(d);
                ++count;
            }
        }
    EXPECT_GT(count, 3 * 200 * 200);
    const double det = xx * yy - xy * xy;
    const glm::dvec2 shift((yy * xd - xy * yd) / det, (xx * yd - xy * xd) / det);
    return {length(shift), off / count};
}

struct Pair {
    const char* dem;
    const char* photo;
    const char* other_crs;
    double px_m;
};

class PhotoOnGround : public testing::TestWithParam<Pair> {};

TEST_P(PhotoOnGround, LiesWhereGdalsWarpPutsIt) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Pair& pair = GetParam();
    const std::string dem = (data / "dem" / pair.dem).string(),
                      photo = (data / "dem" / pair.photo).string();
    const Reference reference(photo);
    const std::string other = warped(
        photo, "other.tif", {"-t_srs", pair.other_crs, "-r", "cubic", "-dstalpha", "-overwrite"});
    for (const std::string& file : {photo, other})
        for (const bool as_effect : {false, true}) {
            const Found found = off_the_reference(dem, file, reference, pair.px_m, as_effect);
            fmt::print("[ accuracy ] {}, {}: shift {:.3f} px, colours {:.1f} of 255\n",
                       fs::path(file).filename().string(), as_effect ? "drape" : "overlay",
                       found.shift_px, found.mean_off);
            EXPECT_LT(found.shift_px, 0.3) << file;
            EXPECT_LT(found.mean_off, 12) << file;
        }
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, PhotoOnGround,
    testing::Values(Pair{"rmnp/rmnp-dem.tif", "rmnp/rmnp-rgb.tif", "EPSG:32613", 150},
                    Pair{"swellendam/srtm_41_19_4326.tif",
                         "swellendam/3320D_2010_315_RGB_LATLNG.tif", "EPSG:32734", 2.5}));

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// An image of one colour over the bundled DEM, whose western half is transparent.
std::string write_half(const char* type) {
    const dem::Grid dem = dem::Source::open(jacksboro()).grid();
    const dem::Affine& a = dem.affine();
    test::Raster raster{.type = type, .columns = 40, .rows = 40, .bands = 4};
    const double x = a.x_column * dem.columns() / 40, y = a.y_row * dem.rows() / 40;
    raster.geotransform = {{a.x0 - 0.5 * a.x_column, x, 0, a.y0 - 0.5 * a.y_row, 0, y}};
    raster.crs = dem.crs().text();
    raster.pictures = true;
    raster.value = [](int column, int, int band) {
        return band < 4 ? 60.0 * band : column < 20 ? 0.0 : 255.0;
    };
    return test::write_raster(test::folder() / "half.tif", raster);
}

image::Image8 from_above(const scene::Overlay& overlay, const char* time) {
    scene::Scene scene;
    scene.dems = {jacksboro()};
    scene.time.at = time;
    scene.effects.switches.only = std::vector<std::string>{};
    scene.width_px = 320;
    scene.height_px = 256;
    scene.view.orbit = {180, 89.9, 1};
    scene.overlay = overlay;
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    EXPECT_FALSE(session.overlay_legend()) << "colours without a meaning";
    session.draw();
    return session.picture();
}

/// Least and most red among pixels of the middle of a half.
std::pair<int, int> reds(const image::Image8& picture, int left) {
    std::pair<int, int> found{255, 0};
    for (int y = 60; y < 190; ++y)
        for (int x = left; x < left + 80; ++x) {
            found.first = std::min(found.first, int{picture.at(x, y, 0)});
            found.second = std::max(found.second, int{picture.at(x, y, 0)});
        }
    return found;
}

TEST(PhotoLight, FlatHasTheImagesColoursAndLitThoseThatTheSunMakes) {
    constexpr int kWest = 70, kEast = 175;
    const char* const morning = "2026-06-21T12:00Z";
    const char* const noon = "2026-06-21T17:30Z";
    const std::string file = write_half("Byte");
    for (const char* time : {morning, noon}) {
        const image::Image8 flat = from_above({.file = file}, time);
        EXPECT_EQ(reds(flat, kEast), std::pair(60, 60)) << time;
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(flat.at(200, 128, k), 60 * (k + 1));
        EXPECT_NE(reds(flat, kWest), std::pair(60, 60)) << "ground, where it is transparent";
    }
    const image::Image8 lit = from_above({.file = file, .lit = true}, morning);
    const auto [low, high] = reds(lit, kEast);
    EXPECT_GT(high, low + 20);
    EXPECT_NE(reds(from_above({.file = file, .lit = true}, noon), kEast), reds(lit, kEast));
    EXPECT_EQ(reds(lit, kWest), reds(from_above({.file = file}, morning), kWest));
    // Its hue stays: blue over red.
    EXPECT_GT(lit.at(200, 128, 2), lit.at(200, 128, 0) + 20);
    // Half opaque, over the same ground.
    const image::Image8 half = from_above({.file = file, .opacity = 0.5}, noon);
    EXPECT_NE(reds(half, kEast), std::pair(60, 60));
}

TEST(PhotoLight, ColoursOfMoreThan8BitsAreRefusedAndABandOfThemIsDrawn) {
    const std::string file = write_half("UInt16");
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    EXPECT_EQ(test::error_of([&] { read_overlay({.file = file}, grid); }),
              "exit 3: " + file +
                  ": red, green and blue of more than 8 bits, expected 8; convert the overlay with "
                  "gdal_translate -ot Byte -scale, or name colours for one band with "
                  "--overlay-colours");
    EXPECT_TRUE(read_overlay({.file = file, .colours = "grey"}, grid).legend);
    EXPECT_TRUE(read_overlay({.file = file, .band = 4}, grid).legend);
}

TEST(WidePhoto, OfMorePixelsThanTheLimitCoversAllOfItsGround) {
    constexpr int kColumns = 300000;
    const dem::Grid grid(41, 31, {500015, 30, 0, 5199985, 0, -30},
                         geo::Crs::parse("EPSG:32632", "test"));
    const std::string path = test::write_raster(
        test::folder() / "wide.tif",
        {.type = "Byte",
         .columns = kColumns,
         .rows = 4,
         .bands = 3,
         .geotransform = {{500000, 1230.0 / kColumns, 0, 5200000, 0, -232.5}},
         .value = [](int column, int, int) { return column < kColumns / 2 ? 50.0 : 200.0; }});
    const render::OverlayRaster raster{.photo = overlay::Photo::open(path, grid)};
    const Array2d<float> heights(41, 31, 100.0F);
    const dem::Pyramid pyramid{heights};
    const render::OverlayTexels texels = render::overlay_texels(raster, pyramid);
    EXPECT_LE(texels.count.x, (1 << 18) + 1);
    EXPECT_GT(texels.count.x, 1 << 17);
    EXPECT_NEAR(texels.first_post.x + (texels.count.x - 1) / texels.per_post.x,
                raster.photo->last_post().x, 1e-3);
    // The last page of the finest level.
    const int last = (texels.count.x - 2) / render::kNormalNodes;
    const std::vector<std::uint32_t> page = render::overlay_page(raster, pyramid, 0, {last, 0});
    EXPECT_EQ(page[render::kNormalPage_px + 1], 0xffc8c8c8U);
}

}  // namespace
}  // namespace relevo::session::test_photo
