// A DEM that takes long to read: what stands in for it, and what waits for all of its posts.
#include <memory>

#include <glm/geometric.hpp>

#include "image/image.h"
#include "session/session.h"
#include "viewer/scene_thread.h"
#include "window/viewer_fixture.h"

namespace relevo {
namespace {

/// 4104 x 4100 posts, few more than are read at once, with overviews.
void make_large_dem(const test::Display& display, const std::filesystem::path& file) {
    test::WindowedProgram make(display, test::build_dir() / "bin/make_dem",
                               {(test::source_dir() / "data/dem/jacksboro.tif").string(), "4104",
                                "4100", file.string(), "--overviews"});
    ASSERT_EQ(make.status(120), 0) << make.output();
}

image::Image8 image_of(const viewer::Picture& picture) {
    return image::from_device(picture.width_px, picture.height_px, picture.rgba);
}

TEST_F(Viewer, MeansStandInForALargeDemUntilItIsRead) {
    const auto dem = folder_ / "large.tif";
    make_large_dem(display_, dem);
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.width_px = 320;
    scene.height_px = 200;
    viewer::SceneThread thread(scene, "software", [] {});
    viewer::Wanted wanted;
    wanted.width_px = scene.width_px;
    wanted.height_px = scene.height_px;
    thread.want(wanted);
    ASSERT_TRUE(wait([&] { return thread.opened() != nullptr; }));
    const auto first = thread.opened();
    EXPECT_TRUE(first->dem->stands_in);
    EXPECT_EQ(first->dem->field.reduction, 4);
    // What is told of a place is of the posts all the same.
    const geo::Geodetic place = first->dem->source->grid().place(1001.25, 2001.5);
    const double height_m = first->dem->height_m(place);

    std::shared_ptr<const viewer::Picture> picture;
    bool stood_in = false;
    ASSERT_TRUE(test::WindowedProgram::wait(
        [&] {
            const bool stands_in = thread.opened()->dem->stands_in;
            if (const auto newer = thread.newer_than(picture ? picture->number : 0))
                picture = newer;
            stood_in = stood_in || (picture && stands_in);
            return picture && picture->sharp;
        },
        120));
    EXPECT_TRUE(stood_in);  // there was a picture before
    const auto whole = thread.opened();
    EXPECT_FALSE(whole->dem->stands_in);
    EXPECT_EQ(whole->dem->field.reduction, 1);
    EXPECT_NEAR(whole->dem->height_m(place), height_m, 1e-4);
    const geo::Geodetic before = first->ground.frame.origin(), after = whole->ground.frame.origin();
    EXPECT_EQ(before.lat_rad, after.lat_rad);
    EXPECT_EQ(before.lon_rad, after.lon_rad);

    FilesInUse files;
    session::Session session(scene, {.device = "software"}, files);
    EXPECT_FALSE(session.dem()->stands_in);  // captures wait
    EXPECT_EQ(session.moment(), whole->utc);
    EXPECT_LT(distance(session.camera().eye_m, whole->camera.eye_m), 1e-6);
    session.draw();
    EXPECT_LE(test::difference(image_of(*picture), session.picture(), 1), 2e-4);
}

TEST_F(Viewer, APictureOfALargeDemWaitsForAllOfIt) {
    const auto dem = folder_ / "large.tif";
    make_large_dem(display_, dem);
    start({dem.string(), "--disable", "haze", "--time", "2026-06-21T20:00:00Z"});
    ASSERT_TRUE(wait([&] { return program_->title().find("large") != std::string::npos; }))
        << program_->output();
    act({"mousemove", "900", "500", "key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(test::WindowedProgram::wait([&] { return std::filesystem::exists(taken); }, 120))
        << program_->output();
    const auto captured = folder_ / "captured.png";
    test::WindowedProgram capture(
        display_, test::build_dir() / "bin/relevo",
        {"-q", "capture", "--from", taken.string(), "-o", captured.string()});
    ASSERT_EQ(capture.status(120), 0) << capture.output();
    EXPECT_LE(test::difference(image::read(taken), image::read(captured), 1), 2e-4);
}

}  // namespace
}  // namespace relevo
