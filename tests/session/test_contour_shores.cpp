// Level ground at the height of a contour line: a line along its edge, none within.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_contour_shores {
namespace {

/// Where contours change a view, at posts of the DEM.
class Lines {
  public:
    explicit Lines(const scene::Scene& scene)
        : session_(scene, {.device = test::gl_device()}, files_) {
        session_.draw();
        with_ = session_.picture();
        std::vector<float> depths_m;
        session_.read_depths(depths_m);
        seen_.emplace(session_.camera(), with_.width, with_.height, std::move(depths_m));
        test::set(session_, "contours.opacity", "0");
        session_.draw();
        without_ = session_.picture();
    }

    const Array2d<float>& height_m() const { return session_.dem()->field.height_m; }

    /// The largest change of a channel within so many pixels of a post; -1 outside the picture.
    int change(int column, int row, int reach_px) const {
        const auto place = session_.dem()->field.place(column, row);
        const auto at = seen_->project(session_.ground().frame.to_local(place));
        int largest = 0;
        if (!at || at->x < reach_px || at->y < reach_px || at->x + reach_px >= with_.width ||
            at->y + reach_px >= with_.height)
            return -1;
        for (int y = static_cast<int>(at->y) - reach_px; y <= at->y + reach_px; ++y)
            for (int x = static_cast<int>(at->x) - reach_px; x <= at->x + reach_px; ++x)
                for (int i = 0; i < 3; ++i)
                    largest = std::max(
                        largest, std::abs(with_.row(y)[3 * x + i] - without_.row(y)[3 * x + i]));
        return largest;
    }

  private:
    FilesInUse files_;
    Session session_;
    image::Image8 with_, without_;
    std::optional<SeenGround> seen_;
};

/// Whether all posts up to `reach` away have a height.
bool is_level(const Array2d<float>& height_m, int column, int row, int reach, float level_m) {
    for (int y = row - reach; y <= row + reach; ++y)
        for (int x = column - reach; x <= column + reach; ++x)
            if (height_m.at(x, y) != level_m) return false;
    return true;
}

struct Shores {
    std::string dem;
    float level_m = 0;
    scene::View view = scene::parse_view("top");
    std::vector<std::string> disabled = {};
    std::vector<double> pixel_errors = {0, 4, 30};
    int within = 2;    ///< posts so far from the edge have no line
    int reach_px = 0;  ///< from posts at the edge to a line
};

std::string case_of(const std::string& name) {
    return (test::source_dir() / "tests/data/cases/contour_plateau" / name).string();
}

/// A dome whose top is level at 500 m, and a wall around another level at 440 m: its lines are 5 m
/// apart.
std::string plateau() {
    test::Raster raster;
    raster.columns = raster.rows = 200;
    raster.geotransform = {{500000, 10, 0, 5200000, 0, -10}};
    raster.value = [](int column, int row, int) {
        if (std::hypot(column - 40, row - 160) < 15) return 440.0;
        return std::min(560 - 1.5 * std::hypot(column - 99.5, row - 99.5), 500.0);
    };
    return test::write_raster(test::scratch_dir("plateau") / "plateau.tif", raster);
}

void expect_shores(const Shores& shores) {
    scene::Scene scene;
    scene.dems = {shores.dem};
    scene.view = shores.view;
    scene.time.at = "2026-06-21T12:00Z";
    scene.width_px = scene.height_px = 500;
    scene.effects.switches.enable = {"contours"};
    scene.effects.switches.disable = shores.disabled;
    scene.effects.settings = {{"contours.labels", "false"}, {"contours.opacity", "1"}};
    for (const double pixel_error : shores.pixel_errors) {
        scene.pixel_error = pixel_error;
        const Lines lines(scene);
        const Array2d<float>& height_m = lines.height_m();
        const int rim = shores.within + 2;
        int within = 0, filled = 0, shore = 0, lined = 0;
        for (int row = rim; row + rim < height_m.height(); ++row)
            for (int column = rim; column + rim < height_m.width(); ++column) {
                if (is_level(height_m, column, row, shores.within, shores.level_m)) {
                    const int change = lines.change(column, row, 0);
                    within += change >= 0;
                    filled += change > 0;
                } else if (is_level(height_m, column, row, 1, shores.level_m) &&
                           !is_level(height_m, column, row, 2, shores.level_m)) {
                    // One post from the slope.
                    const int change = lines.change(column, row, shores.reach_px);
                    shore += change >= 0;
                    lined += change > 20;
                }
            }
        EXPECT_GE(within, 70);
        EXPECT_EQ(filled, 0) << shores.dem << ' ' << pixel_error << " of " << within;
        EXPECT_GT(lined, 0.97 * shore) << shores.dem << ' ' << pixel_error << " of " << shore;
        fmt::print(
            "[ shores ] {}, pixel error {}: {} of {} posts within on a line, {} of {} next to "
            "the shore near one\n",
            shores.dem, pixel_error, filled, within, lined, shore);
    }
}

TEST(ContourShores, HaveOneLineAndTheWaterNone) {
    expect_shores({.dem = case_of("loch_lyon_srtm3.tif"), .level_m = 340, .reach_px = 20});
    expect_shores({.dem = case_of("mull_sea_srtm3.tif"), .level_m = 0, .reach_px = 8});
}

TEST(ContourShores, WithoutWaterLinesFollowThePosts) {
    const std::vector<std::string> bare = {"sea", "cover", "trees"};
    expect_shores(
        {case_of("loch_lyon_srtm3.tif"), 340, scene::parse_view("top"), bare, {0, 4, 30}, 2, 20});
    expect_shores(
        {case_of("mull_sea_srtm3.tif"), 0, scene::parse_view("top"), bare, {0, 4, 30}, 2, 8});
    const std::string dem = plateau();
    expect_shores({dem, 500, scene::parse_view("top"), bare, {0, 1, 4, 30}, 2, 6});
    // A part of its wall is too steep for lines.
    expect_shores({dem, 440, scene::parse_view("top"), bare, {0, 4, 30}, 2, 9});
    // Coarse ground is drawn off its posts, by up to the error.
    expect_shores({dem, 500, scene::parse_view("az=200,el=35"), bare, {0, 4}, 3, 9});
    scene::View within;
    within.eye = {{radians(46.943), radians(9.0130), 150}, /*above_ground=*/true};
    expect_shores({dem, 500, within, bare, {0, 4}, 3, 9});
}

}  // namespace
}  // namespace relevo::session::test_contour_shores
