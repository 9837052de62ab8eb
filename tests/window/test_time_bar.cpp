// The bar of date, time and the day's light along the lower edge.
#include <array>

#include "sun/time.h"
#include "window/viewer_fixture.h"

namespace relevo::test_time_bar {
namespace {

constexpr int kStrip_y = 765, kRow_y = 783;

class TimeBar : public Viewer {
  protected:
    std::string time() { return scene()["time"]["at"]; }
    bool becomes(const std::string& at) {
        return wait([&] { return time() == at; });
    }
    void click(int x, int y) {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        act({"click", "1"});
    }
};

TEST_F(TimeBar, HasTheDaysLightFromMidnightToMidnight) {
    open({dem_, "--only", "--time", "2026-12-21T17:00:00Z"});
    const image::Image8 screen = display_.screen();
    const auto blue_less_red = [&](double hour) {
        const int x = static_cast<int>(14 + hour / 24 * 1252);
        const std::uint8_t* const pixel = screen.row(kStrip_y) + 3 * x;
        return std::array<int, 2>{pixel[2] - pixel[0], pixel[0]};
    };
    // Sunrise is at 07:46, sunset at 17:27; astronomical twilight begins at 06:11.
    EXPECT_LT(blue_less_red(3)[1], 40);
    EXPECT_LT(blue_less_red(23)[1], 40);
    EXPECT_GT(blue_less_red(7.5)[0], 30);    // twilight
    EXPECT_LT(blue_less_red(8.2)[0], -100);  // the golden hour is orange
    EXPECT_GT(blue_less_red(10)[1], 220);
    EXPECT_GT(blue_less_red(17.2)[1], 200);
    EXPECT_GT(blue_less_red(17.7)[0], 30);
}

TEST_F(TimeBar, TakesDragsWheelStepsAndWords) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    EXPECT_EQ(time(), "2026-06-21T14:00:00-04:00");
    act({"mousemove", "640", std::to_string(kStrip_y)});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    act({"click", "4"});
    EXPECT_TRUE(becomes("2026-06-21T14:10:00-04:00")) << time();
    act({"click", "5"});
    EXPECT_TRUE(becomes("2026-06-21T14:00:00-04:00")) << time();
    ASSERT_TRUE(changes([&] { drag(1, 744, kStrip_y, -208, 0); }, 0.01));
    const sun::Instant dragged = sun::parse_time(time()).utc;
    const sun::Instant ten = sun::parse_time("2026-06-21T10:00:00-04:00").utc;
    EXPECT_LT(std::abs(dragged - ten), 240) << time();
    act({"key", "ctrl+z"});
    EXPECT_TRUE(becomes("2026-06-21T14:00:00-04:00")) << time();
    // A month, a week and a day there.
    click(24, kRow_y);
    EXPECT_TRUE(becomes("2026-05-21T14:00:00-04:00")) << time();
    click(69, kRow_y);
    EXPECT_TRUE(becomes("2026-05-14T14:00:00-04:00")) << time();
    click(309, kRow_y);
    EXPECT_TRUE(becomes("2026-05-15T14:00:00-04:00")) << time();
    click(460, kRow_y);
    act({"type", "--delay", "60", "0735"});
    act({"key", "Return"});
    ASSERT_TRUE(settles());  // until then keys are text
    EXPECT_TRUE(becomes("2026-05-15T07:35:00-04:00")) << time();
    // No clock shows this: the time stays.
    click(460, kRow_y);
    act({"type", "--delay", "60", "25:10"});
    act({"key", "Return"});
    ASSERT_TRUE(settles());
    act({"key", "Escape"});
    EXPECT_TRUE(becomes("2026-05-15T07:35:00-04:00")) << time();
}

TEST_F(TimeBar, ShowsWhereGroundHidesTheSunFromThePoint) {
    open({dem_, "--only", "--time", "2026-12-21T17:00:00Z"});
    const auto dark = [&] {
        const image::Image8 screen = display_.screen();
        int count = 0;
        for (int x = 420; x < 920; ++x) {  // with the sun up
            const std::uint8_t* const pixel = screen.row(kStrip_y + 4) + 3 * x;
            count += std::abs(pixel[0] - 70) < 8 && std::abs(pixel[2] - 74) < 8;
        }
        return count;
    };
    EXPECT_EQ(dark(), 0);
    click(800, 480);
    EXPECT_TRUE(wait([&] { return dark() > 5; })) << dark();
}

TEST_F(Viewer, TheYearOfAPointSaysWhatItsColoursAre) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    act({"mousemove", "800", "500", "click", "1"});
    constexpr glm::ivec4 kTabs{900, 600, 370, 28};
    const auto sunny = [&] { return count_near(display_.screen(), kTabs, {255, 210, 74}); };
    ASSERT_TRUE(settles());
    EXPECT_EQ(sunny(), 0);
    act({"mousemove", "450", "615", "click", "1"});
    EXPECT_TRUE(wait([&] { return sunny() > 100; }));
}

}  // namespace
}  // namespace relevo::test_time_bar
