// Level ground at the height of a contour line: a line along its edge, none within.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_contour_shores {
namespace {

/// Where contours change a top view, at posts of the DEM.
class Lines {
  public:
    Lines(const std::string& name, double pixel_error)
        : session_(scene(name, pixel_error), {.device = test::gl_device()}, files_) {
        session_.draw();
        with_ = session_.picture();
        std::vector<float> depths_m;
        session_.read_depths(depths_m);
        seen_.emplace(session_.camera(), with_.width, with_.height, std::move(depths_m));
        session_.set("contours.opacity", "0");
        session_.draw();
        without_ = session_.picture();
    }

    const Array2d<float>& height_m() const { return session_.dem()->field.height_m; }

    /// The largest change of a channel within so many pixels of a post.
    int change(int column, int row, int reach_px) const {
        const auto place = session_.dem()->field.place(column, row);
        const auto at = seen_->project(session_.ground().frame.to_local(place));
        int largest = 0;
        for (int y = static_cast<int>(at->y) - reach_px; y <= at->y + reach_px; ++y)
            for (int x = static_cast<int>(at->x) - reach_px; x <= at->x + reach_px; ++x)
                for (int i = 0; i < 3; ++i)
                    largest = std::max(
                        largest, std::abs(with_.row(y)[3 * x + i] - without_.row(y)[3 * x + i]));
        return largest;
    }

  private:
    static scene::Scene scene(const std::string& name, double pixel_error) {
        scene::Scene scene;
        scene.dems = {(test::source_dir() / "tests/data/cases/contour_plateau" / name).string()};
        scene.view = scene::parse_view("top");
        scene.time.at = "2026-06-21T12:00Z";
        scene.width_px = scene.height_px = 500;
        scene.pixel_error = pixel_error;
        scene.effects.switches.enable = {"contours"};
        scene.effects.settings = {{"contours.labels", "false"}, {"contours.opacity", "1"}};
        return scene;
    }

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

void expect_shores(const std::string& name, float level_m, int reach_px) {
    for (const double pixel_error : {0.0, 4.0, 30.0}) {
        const Lines lines(name, pixel_error);
        const Array2d<float>& height_m = lines.height_m();
        int within = 0, filled = 0, shore = 0, lined = 0;
        for (int row = 4; row + 4 < height_m.height(); ++row)
            for (int column = 4; column + 4 < height_m.width(); ++column) {
                if (is_level(height_m, column, row, 2, level_m)) {
                    ++within;
                    filled += lines.change(column, row, 0) > 0;
                } else if (is_level(height_m, column, row, 1, level_m)) {
                    // One post from land.
                    ++shore;
                    lined += lines.change(column, row, reach_px) > 20;
                }
            }
        EXPECT_GE(within, 70);
        EXPECT_EQ(filled, 0) << name << ' ' << pixel_error << " of " << within;
        EXPECT_GT(lined, 0.97 * shore) << name << ' ' << pixel_error << " of " << shore;
        fmt::print(
            "[ shores ] {}, pixel error {}: {} of {} posts within on a line, {} of {} next to "
            "the shore near one\n",
            name, pixel_error, filled, within, lined, shore);
    }
}

TEST(ContourShores, HaveOneLineAndTheWaterNone) {
    expect_shores("loch_lyon_srtm3.tif", 340, 20);
    expect_shores("mull_sea_srtm3.tif", 0, 8);
}

}  // namespace
}  // namespace relevo::session::test_contour_shores
