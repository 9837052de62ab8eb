// Effects that move: the window draws on by itself, and a saved picture is of the time that is
// seen.
#include <nlohmann/json.hpp>

#include "window/viewer_fixture.h"

namespace relevo::test_motion {
namespace {

class Motion : public Viewer {
  protected:
    /// Opens the window before snow falls, which never settles.
    void open_in_snow(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{
            dem_,        "--time", "2026-01-21T18:30Z", "--eye",   "36.35,-84.23,60agl",
            "--heading", "60",     "--enable",          "snowfall"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        start(arguments);
        ASSERT_TRUE(wait([&] { return program_->title().find("Relevo") != std::string::npos; }))
            << program_->output();
        ASSERT_TRUE(wait([&] { return shows_picture(display_.screen()); }));
    }
    /// Whether the picture changes without input.
    bool moves() {
        const image::Image8 before = display_.screen();
        return test::WindowedProgram::wait(
            [&] {
                return count_other(before, display_.screen(), {500, 100, 700, 500}) > 100;
            },
            10);
    }
};

TEST_F(Motion, SnowFallsWithoutInputAndASavedPictureIsOfItsTime) {
    open_in_snow();
    EXPECT_TRUE(moves());
    EXPECT_TRUE(moves());
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png", captured = folder_ / "captured.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); })) << program_->output();
    test::WindowedProgram capture(
        display_, test::build_dir() / "bin/relevo",
        {"-q", "capture", "--from", taken.string(), "-o", captured.string()});
    ASSERT_EQ(capture.status(), 0) << capture.output();
    EXPECT_LE(test::difference(image::read(taken), image::read(captured), 1), 2e-4);
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST_F(Motion, WithoutSuchAnEffectTheWindowRests) {
    open({dem_, "--time", "2026-01-21T18:30Z", "--eye", "36.35,-84.23,60agl", "--heading", "60"});
    // Refinement may still be under way: on a slow machine it pauses longer than settles() waits.
    EXPECT_TRUE(wait([&] {
        const image::Image8 before = display_.screen();
        std::this_thread::sleep_for(std::chrono::seconds(2));
        return test::difference(before, display_.screen()) == 0;
    }));
}

}  // namespace
}  // namespace relevo::test_motion
