// The measured line, with mouse and keys.
#include <fstream>

#include "window/viewer_fixture.h"

namespace relevo::test_measuring {
namespace {

constexpr glm::ivec3 kLine{255, 80, 60};
/// Before and after a click, which else is a drag.
constexpr auto kStill = std::chrono::milliseconds(400);

class MeasuredLine : public Viewer {
  protected:
    int red(glm::ivec4 area) { return count_near(display_.screen(), area, kLine); }
    void click(int x, int y, const char* button = "1") {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        std::this_thread::sleep_for(kStill);
        act({"click", button});
        std::this_thread::sleep_for(kStill);
    }
    void begin() {
        open({dem_, "--view", "az=165,el=28", "--only", "--time", "2026-06-21T18:00:00Z"});
        act({"key", "p"});
        click(760, 330);
        ASSERT_TRUE(wait([&] { return red({750, 320, 20, 20}) > 20; }));
        act({"key", "m"});
    }
};

TEST_F(MeasuredLine, HasCornersUntilARightClickAndAProfileAsCsv) {
    begin();
    click(950, 440);
    click(950, 250);
    // A further corner follows the cursor until the right click, and stays there.
    act({"mousemove", "820", "250"});
    constexpr glm::ivec4 kTop{890, 235, 45, 30};
    ASSERT_TRUE(wait([&] { return red(kTop) > 30; }));
    act({"click", "3"});
    std::this_thread::sleep_for(kStill);
    act({"mousemove", "1000", "360"});
    ASSERT_TRUE(settles());
    EXPECT_GT(red(kTop), 30);
    EXPECT_GT(red({940, 300, 20, 90}), 50);
    // Backspace takes corners back one by one; the panel moves up with them.
    act({"key", "BackSpace"});
    EXPECT_TRUE(wait([&] { return red(kTop) == 0; }));
    click(50, 286);
    const auto csv = folder_ / "relevo-1.csv";
    EXPECT_TRUE(wait([&] { return std::filesystem::exists(csv); })) << program_->output();
    std::ifstream rows(csv);
    std::string first;
    std::getline(rows, first);
    EXPECT_EQ(first, "distance_m,latitude_deg,longitude_deg,height_m");
    EXPECT_GT(std::distance(std::istreambuf_iterator<char>(rows), {}), 4000);
}

TEST_F(MeasuredLine, MBeginsAnewFromTheSamePoint) {
    begin();
    act({"mousemove", "950", "440"});
    constexpr glm::ivec4 kBelow{820, 350, 90, 50}, kAbove{820, 260, 90, 50};
    ASSERT_TRUE(wait([&] { return red(kBelow) > 50; }));
    act({"key", "m"});
    ASSERT_TRUE(settles());
    act({"key", "m", "mousemove", "950", "250"});
    EXPECT_TRUE(wait([&] { return red(kAbove) > 50 && red(kBelow) == 0; }));
    act({"key", "Return", "mousemove", "950", "440"});
    ASSERT_TRUE(settles());
    EXPECT_GT(red(kAbove), 50);
}

}  // namespace
}  // namespace relevo::test_measuring
