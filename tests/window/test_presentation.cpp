// How frames come to the window, and what happens when the device that draws them is lost.
#include <fstream>

#include "window/viewer_fixture.h"

namespace relevo::test_presentation {
namespace {

/// A window whose scene draws in a context that shares with it.
class SharedFrames : public Viewer {
  protected:
    SharedFrames() { environment_.push_back("RELEVO_PRESENT=shared"); }
    bool says(const std::string& text) const {
        return program_->output().find(text) != std::string::npos;
    }
};

TEST_F(SharedFrames, APictureIsWhatACaptureOfItsSceneIs) {
    open({"-v", dem_, "--time", "2026-06-21T22:30Z"});
    EXPECT_TRUE(says("view: frames stay on the device")) << program_->output();
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 90, 30); }));
    expect_picture_is_its_capture();
}

TEST_F(SharedFrames, FollowTheHandTheSunAndTheSizeOfTheWindow) {
    open({dem_, "--time", "2026-06-21T22:30Z"});
    EXPECT_TRUE(changes([&] { drag(1, 900, 500, 150, 40); }));
    EXPECT_TRUE(changes([&] { act({"key", "bracketright"}); }, 0.01));
    EXPECT_TRUE(changes([&] { act({"windowsize", window_id(), "1000", "700"}); }));
    EXPECT_TRUE(changes([&] { drag(1, 700, 300, -100, 20); }));
    // The ground under the cursor is read from the frame on the device.
    EXPECT_TRUE(changes_in({0, 626, 1000, 30}, [&] {
        act({"mousemove", "760", "400", "sleep", "0.3", "mousemove", "764", "406"});
    })) << program_->output();
}

TEST_F(SharedFrames, CompareWithWhatWas) {
    open({dem_, "--time", "2026-06-21T22:30Z"});
    act({"key", "c"});
    ASSERT_TRUE(settles());
    EXPECT_TRUE(changes([&] { act({"key", "bracketright", "bracketright"}); }, 0.01));
    act({"key", "c"});
    EXPECT_TRUE(settles());
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST_F(SharedFrames, AnUnknownWordIsRefused) {
    environment_ = {"RELEVO_PRESENT=teleport"};
    start({dem_});
    EXPECT_EQ(program_->status(), 2);
    EXPECT_TRUE(says("RELEVO_PRESENT: expected shared, copy or auto but got \"teleport\""))
        << program_->output();
}

class LostDevice : public Viewer {
  protected:
    LostDevice() {
        environment_ = {
            "LD_PRELOAD=" + (test::build_dir() / "tests/modules/lost_device.so").string(),
            "RELEVO_TEST_LOSE=" + lose_.string()};
    }
    const std::filesystem::path lose_ = folder_ / "lose";
};

TEST_F(LostDevice, TheWindowBeginsAgainWithTheSameScene) {
    for (const char* const presentation : {"copy", "shared"}) {
        environment_.push_back(fmt::format("RELEVO_PRESENT={}", presentation));
        open({dem_, "--time", "2026-06-21T22:30Z"});
        ASSERT_TRUE(changes([&] { drag(1, 900, 500, 150, 40); }));
        std::this_thread::sleep_for(std::chrono::seconds(5));  // else it is lost again too soon
        const nlohmann::json before = resting_scene();
        std::ofstream(lose_).put('x');
        act({"mousemove", "910", "520"});
        const auto says = [&](const char* text) {
            return program_->output().find(text) != std::string::npos;
        };
        EXPECT_TRUE(wait([&] { return says("was lost: its driver has reset it"); }))
            << program_->output();
        EXPECT_TRUE(says("llvmpipe"));
        ASSERT_TRUE(settles()) << program_->output();
        const nlohmann::json after = resting_scene();
        EXPECT_EQ(after["time"], before["time"]);
        for (const char* const name : {"heading", "pitch", "fov"})
            EXPECT_NEAR(double(after["camera"][name]), before["camera"][name], 1e-9);
        for (const int i : {0, 1, 2})
            EXPECT_NEAR(double(after["camera"]["eye"][i]), before["camera"]["eye"][i], 1e-8);
        act({"key", "ctrl+q"});
        EXPECT_EQ(program_->status(), 0) << program_->output();
        program_.reset();
    }
}

TEST_F(LostDevice, OneThatIsLostAgainAtOnceIsAnError) {
    open({dem_});
    std::ofstream(lose_).put('x');
    act({"mousemove", "910", "520"});
    EXPECT_EQ(program_->status(), 4) << program_->output();
}

}  // namespace
}  // namespace relevo::test_presentation
