// Whether a stereo pair has the disparities of its formula, and what is made of it.
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "../dem/fixture.h"
#include "scene/stereo.h"
#include "session/session.h"
#include "session/stereo_image.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_stereo {
namespace {

constexpr int kWidth_px = 1200, kHeight_px = 500;
constexpr double kEyes_m = 40;
const std::vector<glm::ivec2> kSummits{{85, 150}, {100, 120}, {125, 60}};  // column, row

/// Three summits on a plain, before an eye in the south that looks north.
scene::Scene scene_of(scene::Stereo stereo) {
    scene::Scene scene;
    scene.dems = {
        test::write_raster(test::folder() / "summits.tif",
                           {.columns = 201, .rows = 201, .value = [](int column, int row, int) {
                                for (const glm::ivec2& summit : kSummits)
                                    if (summit == glm::ivec2(column, row)) return 1000.0;
                                return 100.0 + 0.01 * column;
                            }})};
    scene.time.at = "2026-06-21T10:00:00Z";
    scene.view.eye = {.place = geo::geodetic_deg(46.9017, 9.0396, 700)};
    scene.view.pitch_deg = 2;
    scene.view.stereo = stereo;
    scene.view.eye_distance_m = kEyes_m;
    scene.width_px = kWidth_px;
    scene.height_px = kHeight_px;
    scene.pixel_error = 0;
    return scene;
}

/// Where a picture is highest opaque near a column: the mean of the columns of its highest rows.
double summit_px(const image::Image8& picture, int left, int right) {
    constexpr int kRows = 6;
    double sum = 0, weight = 0;
    for (int y = 0, first = picture.height; y < std::min(first + kRows, picture.height); ++y)
        for (int x = left; x < right; ++x) {
            const double alpha = picture.at(x, y, 3);
            if (alpha > 0) first = std::min(first, y);
            sum += alpha * (x + 0.5);
            weight += alpha;
        }
    return sum / weight;
}

TEST(Stereo, DisparityIsThatOfTheFormula) {
    FilesInUse files;
    scene::Scene scene = scene_of(scene::Stereo::Parallel);
    scene.transparent = true;
    scene.samples = 32;
    Session session(scene,
                    {.device = test::gl_device(), .format = PictureFormat{}, .allow_unmet = true},
                    files);
    const image::Picture pair = session.make_picture();
    const auto& picture = std::get<image::Image8>(pair.pixels);
    ASSERT_EQ(picture.width, kWidth_px);
    // The same view as one picture, for its depths.
    scene::Scene one = scene;
    one.view.stereo = scene::Stereo::None;
    one.width_px = kWidth_px / 2;
    Session middle(one, {.device = test::gl_device(), .allow_unmet = true}, files);
    middle.draw();
    std::vector<float> depths_m;
    middle.read_depths(depths_m);
    const scene::StereoPair eyes = scene::stereo_pair(kEyes_m, depths_m);

    const scene::Camera& camera = session.camera();
    const double focal_px = 0.5 * kHeight_px / std::tan(camera.fov_y_rad / 2);
    const glm::dvec3 right = cross(camera.forward, camera.up);
    for (const glm::ivec2& summit : kSummits) {
        geo::Geodetic place = session.dem()->field.grid.place(summit.x, summit.y);
        place.height_m = 1000;
        const glm::dvec3 way = session.ground().frame.to_local(place) - camera.eye_m;
        const double depth_m = dot(way, camera.forward);
        const double expected_px = eyes.disparity_px(depth_m, focal_px);
        const double at_px = 0.25 * kWidth_px + focal_px * dot(way, right) / depth_m;
        const auto found = [&](double half, double side) {
            const int near =
                static_cast<int>(at_px + half * 0.5 * kWidth_px + 0.5 * side * expected_px);
            return summit_px(picture, near - 12, near + 12) - half * 0.5 * kWidth_px;
        };
        const double left_px = found(0, 1), right_px = found(1, -1);
        fmt::print("{:.0f} m: {:.2f} px, expected {:.2f}\n", depth_m, left_px - right_px,
                   expected_px);
        EXPECT_NEAR(left_px - right_px, expected_px, 0.7);
        EXPECT_NEAR(0.5 * (left_px + right_px), at_px, 0.5);
    }
}

TEST(Stereo, CrossEyedIsParallelWithItsHalvesSwapped) {
    FilesInUse files;
    const auto drawn = [&](scene::Stereo stereo) {
        Session session(
            scene_of(stereo),
            {.device = test::gl_device(), .format = PictureFormat{}, .allow_unmet = true}, files);
        return std::get<image::Image8>(session.make_picture().pixels);
    };
    const image::Image8 parallel = drawn(scene::Stereo::Parallel);
    const image::Image8 crossed = drawn(scene::Stereo::CrossEyed);
    for (int y = 0; y < kHeight_px; ++y)
        for (int x = 0; x < kWidth_px; ++x)
            ASSERT_EQ(parallel.at(x, y, 1), crossed.at((x + kWidth_px / 2) % kWidth_px, y, 1));
}

TEST(Stereo, EyesTooFarApartAreRefused) {
    FilesInUse files;
    scene::Scene scene = scene_of(scene::Stereo::Anaglyph);
    scene.view.eye_distance_m = 1e6;
    Session session(scene,
                    {.device = test::gl_device(), .format = PictureFormat{}, .allow_unmet = true},
                    files);
    const std::string error = test::error_of([&] { session.make_picture(); });
    EXPECT_TRUE(error.starts_with("exit 3: --eye-distance: moves the frames by ")) << error;
    EXPECT_TRUE(error.ends_with(" px, more than their width of 1200 px; use a smaller one"))
        << error;
}

TEST(Stereo, EyesAreAThirtiethOfTheNearGroundsDistanceApart) {
    std::vector<float> depths_m(1000, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < 500; ++i)
        depths_m[i] = 300.0F + static_cast<float>(i);
    const scene::StereoPair eyes = scene::stereo_pair(0, depths_m);
    EXPECT_DOUBLE_EQ(eyes.window_m, 310);  // 2 % of the ground are nearer
    EXPECT_DOUBLE_EQ(eyes.eye_distance_m, 310.0 / 30);
    EXPECT_EQ(eyes.disparity_px(310, 1000), 0);
    EXPECT_NEAR(eyes.disparity_px(1e12, 1000), -1000.0 / 30, 1e-6);
}

TEST(Stereo, AnaglyphOfGreyIsGreyAndShowsEachEyeInItsColour) {
    const auto filled = [](std::uint16_t value) {
        image::Image16 image(1, 1, 3);
        image.values = {value, value, value};
        return image::Picture{image};
    };
    const auto grey = std::get<image::Image16>(anaglyph(filled(30000), filled(30000)).pixels);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(grey.at(0, 0, c), 30000, 60);
    const auto left = std::get<image::Image16>(anaglyph(filled(60000), filled(0)).pixels);
    EXPECT_GT(left.at(0, 0, 0), 55000);
    EXPECT_EQ(left.at(0, 0, 1), 0);
    EXPECT_EQ(left.at(0, 0, 2), 0);
}

}  // namespace
}  // namespace relevo::session::test_stereo
