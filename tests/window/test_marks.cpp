// Marks over the window: as in its picture, through moves of the camera and beside a comparison.
#include <fstream>

#include "base/units.h"
#include "dem/source.h"
#include "image/image.h"
#include "window/viewer_fixture.h"

namespace relevo::test_marks {
namespace {

/// A name over the middle of the DEM in a colour that ground does not have.
class MarksInTheWindow : public Viewer {
  protected:
    std::vector<std::string> arguments() const {
        const dem::Grid grid = dem::Source::open(dem_).grid();
        std::ofstream csv(folder_ / "places.csv");
        csv << "name,lat,lon\n";
        for (const double column : {100.0, 200.0}) {
            const geo::Geodetic at = grid.place(column, 150);
            csv << fmt::format("MMMMMM,{:.8f},{:.8f}\n", degrees(at.lat_rad), degrees(at.lon_rad));
        }
        return {dem_,
                "--enable",
                "labels",
                "--set",
                "labels.file=" + (folder_ / "places.csv").string(),
                "--set",
                "labels.colour=#ff00ff",
                "--set",
                "labels.halo=#ff00ff",
                "--set",
                "labels.size_px=24",
                "--view",
                "el=70"};
    }
    int names() const { return count_near(display_.screen(), kImage, {255, 0, 255}); }

    static constexpr glm::ivec4 kImage{0, 0, 1280, 800};
};

TEST_F(MarksInTheWindow, AreThoseOfItsPicture) {
    open(arguments());
    EXPECT_GT(names(), 1000);
    expect_picture_is_its_capture();
    const image::Image8 taken = image::read(folder_ / "relevo-1.png");
    const int in_picture = count_near(taken, kImage, {255, 0, 255});
    EXPECT_NEAR(names(), in_picture, 0.03 * in_picture);
    // They follow the camera.
    const image::Image8 before = display_.screen();
    ASSERT_TRUE(changes([&] { drag(1, 850, 450, -120, 80); }));
    EXPECT_GT(names(), 1000);
    EXPECT_GT(test::difference(display_.screen(), before), 0.01);
}

TEST_F(MarksInTheWindow, AreOverFramesThatStayOnTheDevice) {
    environment_ = {"RELEVO_PRESENT=shared"};
    open(arguments());
    EXPECT_GT(names(), 1000);
    expect_picture_is_its_capture();
}

TEST_F(MarksInTheWindow, AreOnBothSidesOfAComparison) {
    open(arguments());
    const int alone = names();
    ASSERT_TRUE(changes_in({0, 0, 1280, 60}, [&] { act({"key", "c"}); }));
    ASSERT_TRUE(settles());
    EXPECT_GT(names(), alone / 3);
}

TEST_F(MarksInTheWindow, HeightsOfContoursAreThoseOfItsPicture) {
    open({dem_, "--enable", "contours", "--set", "contours.colour=#ff00ff", "--set",
          "contours.width_px=0.5", "--set", "contours.opacity=0", "--view",
          "az=170,el=35,zoom=2.5"});
    EXPECT_GT(names(), 30);
    expect_picture_is_its_capture();
    const image::Image8 taken = image::read(folder_ / "relevo-1.png");
    const int in_picture = count_near(taken, kImage, {255, 0, 255});
    EXPECT_NEAR(names(), in_picture, 0.35 * in_picture);  // but for those under the panel
}

}  // namespace
}  // namespace relevo::test_marks
