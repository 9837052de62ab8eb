// What --resume keeps is what would be drawn again, whatever became of the files it is drawn from.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_resume_inputs {
namespace {

namespace fs = std::filesystem;

class ResumeInputs : public testing::Test {
  protected:
    /// A hill; written again it is another one, and newer than all that was drawn of it.
    void write_dem(const std::string& name, double height_m) const {
        Raster raster;
        raster.columns = raster.rows = 40;
        raster.value = [height_m](int column, int row, int) {
            return height_m * std::exp(-0.01 * (std::pow(column - 20, 2) + std::pow(row - 15, 2)));
        };
        const fs::path path = dir_ / name;
        const bool again = fs::exists(path);
        write_raster(path, raster);
        if (again)
            fs::last_write_time(path, fs::file_time_type::clock::now() + std::chrono::seconds(9));
    }
    Result run(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"run", (dir_ / "job.json").string()});
        return relevo(more);
    }

    fs::path dir_ = scratch_dir("resume_inputs");
};

TEST_F(ResumeInputs, APictureOfADemThatChangedIsNotKept) {
    write_dem("a.tif", 300);
    std::ofstream(dir_ / "job.json")
        << R"({"format": 1, "dem": {"files": ["a.tif"]}, "time": {"at": "2026-06-21T16:00Z"},
               "effects": {"only": ["shadows"]}, "picture": {"size": [96, 64]},
               "output": "{dem}.png"})";
    const Result first = run();
    ASSERT_EQ(first.status, 0) << first.err;
    const auto picture = [&] { return image::read(dir_ / "a.png").values; };
    const auto old = picture();
    // Nothing has changed.
    const Result nothing = run({"--resume"});
    EXPECT_EQ(nothing.status, 0) << nothing.err;
    write_dem("a.tif", 700);
    const Result again = run({"--resume", "--overwrite"});
    EXPECT_EQ(again.status, 0) << again.err;
    const auto resumed = picture();
    EXPECT_NE(resumed, old);
    ASSERT_EQ(run({"--overwrite"}).status, 0);
    EXPECT_EQ(picture(), resumed);
}

}  // namespace
}  // namespace relevo::test::test_resume_inputs
