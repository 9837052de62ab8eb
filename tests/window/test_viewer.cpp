// The window of `relevo DEM`, driven by a mouse and keys on a display of the tests' own.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/text.h"
#include "image/image.h"
#include "support/support.h"
#include "window/display.h"

namespace relevo {
namespace {

using testing::HasSubstr;

class Viewer : public testing::Test {
  protected:
    /// Starts the program, which remembers nothing outside of the test's folder.
    void start(const std::vector<std::string>& arguments) {
        program_.emplace(display_, test::build_dir() / "bin/relevo", arguments,
                         std::vector<std::string>{
                             "XDG_CONFIG_HOME=" + (folder_ / "config").string(),
                             "XDG_STATE_HOME=" + (folder_ / "state").string(),
                             "PATH=" + (folder_ / "bin").string() + ":" + std::getenv("PATH")},
                         folder_);
    }
    /// Opens the window in a folder of its own, without panels over the picture.
    void open(const std::vector<std::string>& arguments) {
        start(arguments);
        ASSERT_TRUE(wait([&] { return program_->title().find("Relevo") != std::string::npos; }))
            << program_->output();
        act({"mousemove", "900", "500"});
        ASSERT_TRUE(settles()) << program_->output();
    }
    static bool wait(const std::function<bool()>& holds) {
        return test::WindowedProgram::wait(holds);
    }
    void act(const std::vector<std::string>& arguments) const { display_.act(arguments); }
    /// Waits until the screen shows something, and the same for a while.
    bool settles() {
        image::Image8 before = display_.screen();
        int same = 0;
        return wait([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
            image::Image8 now = display_.screen();
            same = test::difference(now, before) < 1e-4 && brightness(now) > 30 ? same + 1 : 0;
            before = std::move(now);
            return same >= 6;
        });
    }
    static double brightness(const image::Image8& picture) {
        double sum = 0;
        for (const std::uint8_t value : picture.values)
            sum += value;
        return sum / static_cast<double>(picture.values.size());
    }
    /// Whether doing it makes another picture, of which this share differs at least.
    bool changes(const std::function<void()>& act, double share = 0.05) {
        const image::Image8 before = display_.screen();
        act();
        if (!wait([&] { return test::difference(display_.screen(), before) > share; }))
            return false;
        return settles();
    }
    /// The scene as Ctrl+S saves it now.
    nlohmann::json scene() {
        const auto name = folder_ / fmt::format("relevo-{}.json", ++saved_);
        act({"key", "ctrl+s"});
        EXPECT_TRUE(wait([&] { return std::filesystem::exists(name); })) << program_->output();
        return nlohmann::json::parse(read_text(name, "test"));
    }
    void drag(int button, int x, int y, int dx, int dy) {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        act({"mousedown", std::to_string(button)});
        for (int step = 1; step <= 5; ++step) {
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
            act({"mousemove", std::to_string(x + dx * step / 5),
                 std::to_string(y + dy * step / 5)});
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        act({"mouseup", std::to_string(button)});
    }

    /// Writes a plugin of the test's own that changes the light of the ground.
    void paint(const std::string& body) const {
        std::filesystem::create_directories(plugins_ / "paint");
        std::ofstream(plugins_ / "paint/plugin.json")
            << R"({"format": 1, "id": "paint", "name": "Paint", "description": "One colour",)"
               R"( "version": "1.0.0"})";
        std::ofstream(plugins_ / "paint/paint.glsl")
            << "void paint_on_lit(in Surface s, inout vec3 radiance) { " << body << " }\n";
    }

    const std::filesystem::path folder_ = test::scratch_dir("viewer");
    const std::filesystem::path plugins_ = folder_ / "plugins";
    const std::string dem_ = (test::source_dir() / "data/dem/jacksboro.tif").string();
    test::Display display_{1280, 800};
    std::optional<test::WindowedProgram> program_;
    int saved_ = 0;
    static constexpr int tab_y_ = 477;  // of the tabs of the point's charts
};

TEST_F(Viewer, TurnsPansZoomsAndGoesHome) {
    open({dem_});
    const nlohmann::json home = scene();
    const auto camera = [&] { return scene()["camera"]; };
    EXPECT_EQ(home["camera"]["eye_above_ground"], false);
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 150, 60); }));
    const auto turned = camera();
    EXPECT_GT(std::abs(turned["heading"].get<double>() - home["camera"]["heading"].get<double>()),
              10);
    EXPECT_LT(turned["pitch"].get<double>(), home["camera"]["pitch"].get<double>() - 2);
    ASSERT_TRUE(changes([&] { act({"click", "--repeat", "6", "--delay", "60", "4"}); }));
    const auto nearer = camera();
    EXPECT_LT(nearer["eye"][2].get<double>(), 0.6 * turned["eye"][2].get<double>());
    // A wheel's turn is a step as well.
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z"}); }));
    EXPECT_EQ(camera()["eye"], turned["eye"]);
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+y"}); }));
    ASSERT_TRUE(changes([&] { drag(1, 850, 450, -120, 80); }));
    const auto panned = camera();
    EXPECT_EQ(panned["heading"], nearer["heading"]);
    EXPECT_NE(panned["eye"][0], nearer["eye"][0]);
    ASSERT_TRUE(changes([&] { act({"key", "Home"}); }));
    EXPECT_EQ(camera()["eye"], home["camera"]["eye"]);
    // And everything back again.
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z"}); }));
    EXPECT_EQ(camera()["eye"], panned["eye"]);
}

TEST_F(Viewer, MovesTheSunByKeysAndLetsTheDayPass) {
    open({dem_, "--time", "2026-06-21T18:00:00Z"});
    ASSERT_TRUE(changes(
        [&] {
            act({"key", "--repeat", "8", "--delay", "80", "bracketright"});
        },
        0.01));
    EXPECT_THAT(
        scene()["time"]["at"].get<std::string>(),
        testing::AnyOf(HasSubstr("2026-06-21T22:00:00Z"), HasSubstr("2026-06-21T16:00:00-06:00"),
                       HasSubstr("2026-06-21T18:00:00-04:00")));
    act({"key", "space"});
    std::this_thread::sleep_for(std::chrono::milliseconds(800));
    act({"key", "space"});
    EXPECT_NE(scene()["time"]["at"].get<std::string>().substr(13), ":00:00-06:00");
}

TEST_F(Viewer, ShowsTimesInTheZoneThatIsAskedFor) {
    open({dem_, "--tz", "Asia/Tokyo"});
    EXPECT_THAT(scene()["time"]["at"].get<std::string>(), testing::EndsWith("+09:00"));
}

TEST_F(Viewer, APictureIsWhatACaptureOfItsSceneIs) {
    open({dem_, "--time", "2026-06-21T20:00:00Z"});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 90, 30); }));
    scene();
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); })) << program_->output();
    const auto captured = folder_ / "captured.png";
    test::WindowedProgram capture(display_, test::build_dir() / "bin/relevo",
                                  {"-q", "capture", "--scene", (folder_ / "relevo-1.json").string(),
                                   "-o", captured.string()});
    ASSERT_EQ(capture.status(), 0) << capture.output();
    const image::Image8 a = image::read(taken), b = image::read(captured);
    EXPECT_LE(test::difference(a, b, 1), 2e-4);
    EXPECT_EQ(test::difference(a, b, 3), 0);
}

TEST_F(Viewer, TheCopiedCommandTakesThePicture) {
    open({dem_, "--time", "2026-06-21T20:00:00Z", "--disable", "haze"});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 90, 30); }));
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); }));
    // The picture says how it was taken.
    const std::string bytes = read_text(taken, "test");
    const std::size_t begin = bytes.find("relevo capture ");
    ASSERT_NE(begin, std::string::npos);
    std::string command =
        bytes.substr(begin + 7, bytes.find("picture.png", begin) + 11 - begin - 7);
    EXPECT_THAT(command, HasSubstr("--disable haze"));
    EXPECT_THAT(command, HasSubstr("--eye 3"));
    test::WindowedProgram capture(
        display_, "/bin/sh", {"-c", (test::build_dir() / "bin/relevo").string() + " -q " + command},
        {}, folder_);
    ASSERT_EQ(capture.status(), 0) << capture.output();
    EXPECT_LE(test::difference(image::read(taken), image::read(folder_ / "picture.png"), 3), 2e-4);
}

TEST_F(Viewer, ReadsEffectsAgainWhenTheirFilesAreWritten) {
    paint("radiance.r += 0.1;");
    open({dem_, "--only", "paint", "--plugin-path", plugins_.string()});
    EXPECT_TRUE(changes([&] { paint("radiance.b += 0.3;"); }));
    const image::Image8 good = display_.screen();
    paint("radiance.b += nothing;");
    std::this_thread::sleep_for(std::chrono::seconds(4));
    EXPECT_TRUE(program_->is_running());
    EXPECT_LT(test::difference(display_.screen(), good), 0.08);  // but for the message
    EXPECT_TRUE(changes([&] { paint("radiance.g += 0.3;"); }));
}

TEST_F(Viewer, ReadsTheDemAgainWhenItIsWrittenAndStandsItsLoss) {
    const auto dem = folder_ / "mine.tif";
    std::filesystem::copy_file(dem_, dem);
    open({dem.string(), "--only"});
    act({"key", "Tab"});
    ASSERT_TRUE(settles());
    const image::Image8 whole = display_.screen();
    // No DEM any more: it says so, and waits.
    ASSERT_TRUE(changes([&] { std::ofstream(dem) << "no DEM"; }, 0.001));
    EXPECT_TRUE(program_->is_running());
    // Another one: the same ground, and seen from where it was.
    std::filesystem::copy_file(dem_, dem, std::filesystem::copy_options::overwrite_existing);
    EXPECT_TRUE(wait([&] { return test::difference(display_.screen(), whole) < 0.01; }));
    std::filesystem::remove(dem);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_TRUE(program_->is_running());
    EXPECT_LT(test::difference(display_.screen(), whole), 0.01);
}

TEST_F(Viewer, ComparesWithWhatWas) {
    paint("radiance.r += 0.1;");
    open({dem_, "--only", "paint", "--plugin-path", plugins_.string()});
    act({"key", "Tab"});
    ASSERT_TRUE(settles());
    act({"key", "c"});
    ASSERT_TRUE(changes([] {}, 1e-4));  // the line
    const image::Image8 before = display_.screen();
    ASSERT_TRUE(changes([&] { paint("radiance.b += 0.3;"); }, 0.02));
    const auto half_differs = [&](const image::Image8& a, int from, int to) {
        int count = 0;
        for (int y = 100; y < 600; ++y)
            for (int x = from; x < to; ++x)
                count += std::abs(a.row(y)[3 * x + 2] - before.row(y)[3 * x + 2]) > 8;
        return count;
    };
    const image::Image8 after = display_.screen();
    EXPECT_EQ(half_differs(after, 0, 600), 0);
    EXPECT_GT(half_differs(after, 660, 1200), 10000);
    // The line is dragged: more of it stays as it was.
    ASSERT_TRUE(changes([&] { drag(1, 640, 300, 400, 0); }, 0.01));
    EXPECT_LT(half_differs(display_.screen(), 0, 1000), half_differs(after, 0, 1000) / 4);
}

TEST_F(Viewer, ComparesWithoutReadingTheDemAgain) {
    const auto dem = folder_ / "mine.tif";
    std::filesystem::copy_file(dem_, dem);
    open({dem.string(), "--only"});
    act({"key", "Tab"});
    ASSERT_TRUE(settles());
    std::filesystem::remove(dem);
    const image::Image8 alone = display_.screen();
    act({"key", "c"});
    // The line, and no message: both halves are the same.
    ASSERT_TRUE(changes([] {}, 1e-4));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_LT(test::difference(display_.screen(), alone), 0.004);
    EXPECT_GT(test::difference(display_.screen(), alone), 0.0005);
}

/// What an area of the screen has of a colour, by less than `by` in each channel.
int count_near(const image::Image8& screen, glm::ivec4 area, glm::ivec3 colour, int by = 12) {
    int count = 0;
    for (int y = area.y; y < area.y + area.w; ++y)
        for (int x = area.x; x < area.x + area.z; ++x) {
            const std::uint8_t* at = screen.row(y) + 3 * x;
            count += std::abs(at[0] - colour.x) < by && std::abs(at[1] - colour.y) < by &&
                     std::abs(at[2] - colour.z) < by;
        }
    return count;
}

TEST_F(Viewer, AClickShowsThePointsHorizonAndYearForTheShownDate) {
    // Chart and panel colours: the day's way, first and last light; direct sun through the year.
    constexpr glm::ivec3 kDay{0xe0, 0x7b, 0x12}, kSun{0xff, 0xd2, 0x4a};
    constexpr glm::ivec4 kChart{410, 495, 850, 240};
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    EXPECT_EQ(count_near(display_.screen(), kChart, kDay), 0);
    act({"mousemove", "900", "350"});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    act({"click", "1"});
    ASSERT_TRUE(wait([&] { return count_near(display_.screen(), kChart, kDay) > 1000; }));
    ASSERT_TRUE(settles());
    const image::Image8 summer = display_.screen();
    // Another date: another way of the sun, lower in the sky.
    act({"key", "--repeat", "120", "--delay", "10", "shift+bracketright"});
    ASSERT_TRUE(settles());
    const auto highest = [&](const image::Image8& screen) {
        for (int y = kChart.y; y < kChart.y + kChart.w; ++y)
            if (count_near(screen, {kChart.x, y, kChart.z, 1}, kDay) > 5) return y;
        return 0;
    };
    EXPECT_GT(highest(display_.screen()), highest(summer) + 30);
    // The year: a click on it goes to that day and hour.
    act({"mousemove", "490", std::to_string(tab_y_)});
    act({"click", "1"});
    ASSERT_TRUE(wait([&] { return count_near(display_.screen(), kChart, kSun) > 20000; }));
    ASSERT_TRUE(settles());
    act({"mousemove", "520", "590"});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    act({"click", "1"});
    act({"mousemove", "900", "350"});
    ASSERT_TRUE(settles());
    EXPECT_THAT(scene()["time"]["at"].get<std::string>(), testing::StartsWith("2026-01-"));
    act({"key", "p"});
    EXPECT_TRUE(wait([&] { return count_near(display_.screen(), kChart, kSun) == 0; }));
}

TEST_F(Viewer, GoesToTheNextDemOfTheFolderAndRemembersWhatWasOpen) {
    std::filesystem::create_directories(folder_ / "maps");
    for (const char* name : {"a.tif", "c.tif"})
        std::filesystem::copy_file(dem_, folder_ / "maps" / name);
    std::ofstream(folder_ / "maps/b.tif") << "no DEM";
    std::ofstream(folder_ / "maps/readme.txt") << "no DEM";
    open({(folder_ / "maps/a.tif").string(), "--only"});
    const auto shows = [&](const char* name) {
        return wait([&] { return program_->title().find(name) != std::string::npos; });
    };
    // One that cannot be opened is told of, and is not the end of the way.
    const image::Image8 before = display_.screen();
    act({"key", "ctrl+Next"});
    ASSERT_TRUE(wait([&] {
        return program_->output().find("b.tif") != std::string::npos ||
               test::difference(display_.screen(), before) > 0.005;
    }));
    ASSERT_TRUE(settles());
    EXPECT_TRUE(shows("a.tif"));
    act({"key", "ctrl+Next"});
    EXPECT_TRUE(shows("c.tif"));
    act({"key", "ctrl+Next"});
    EXPECT_TRUE(shows("a.tif"));
    act({"key", "ctrl+Prior"});
    EXPECT_TRUE(shows("c.tif"));
    ASSERT_TRUE(settles());
    const auto recent = nlohmann::json::parse(read_text(folder_ / "state/relevo/recent.json", ""));
    ASSERT_EQ(recent.size(), 2u);
    EXPECT_EQ(recent[0][0], (folder_ / "maps/c.tif").string());
    EXPECT_EQ(recent[1][0], (folder_ / "maps/a.tif").string());
    // From the menu: File, Open again, the second.
    act({"mousemove", "23", "11", "click", "1"});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    act({"mousemove", "60", "52"});
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    act({"mousemove", "330", "52"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    act({"mousemove", "330", "72"});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    act({"click", "1"});
    EXPECT_TRUE(shows("a.tif"));
}

TEST_F(Viewer, KeepsViewsAndSettingsTillTheNextTime) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    act({"key", "Home"});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 90, 30); }));
    const nlohmann::json kept = scene();
    act({"key", "b"});
    act({"key", "Tab"});  // without panels, also the next time
    ASSERT_TRUE(changes([&] { act({"key", "t"}); }));
    EXPECT_NE(scene()["camera"]["eye"], kept["camera"]["eye"]);
    ASSERT_TRUE(changes([&] { act({"key", "1"}); }));
    const auto is_kept = [&](const nlohmann::json& now) {
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(now["camera"]["eye"][i], kept["camera"]["eye"][i], 1e-3) << i;
        EXPECT_NEAR(now["camera"]["heading"], kept["camera"]["heading"], 1e-6);
        EXPECT_EQ(now["time"], kept["time"]);
    };
    is_kept(scene());
    // Back, as any other step.
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z"}); }));
    act({"key", "ctrl+q"});
    ASSERT_EQ(program_->status(), 0) << program_->output();
    open({dem_, "--only"});
    EXPECT_EQ(count_near(display_.screen(), {0, 0, 600, 20}, {36, 36, 36}, 4), 0);  // no menu
    ASSERT_TRUE(changes([&] { act({"key", "1"}); }));
    is_kept(scene());
    act({"key", "ctrl+q"});
    ASSERT_EQ(program_->status(), 0);
    // Whatever has become of the files.
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder_ / "config"))
        if (file.is_regular_file()) std::ofstream(file.path()) << "{\"views\": [[], 7";
    std::ofstream(folder_ / "state/relevo/recent.json") << "[[1, {}], \xff";
    open({dem_, "--only"});
    EXPECT_GT(count_near(display_.screen(), {0, 0, 600, 20}, {36, 36, 36}, 4), 5000);
    act({"key", "1"});
    EXPECT_TRUE(settles());
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST_F(Viewer, HasALightStyleAndLargerLetters) {
    std::filesystem::create_directories(folder_ / "config/relevo");
    std::ofstream(folder_ / "config/relevo/settings.json")
        << R"({"style": "light", "text_px": 24, "coordinates": "mgrs"})";
    open({dem_, "--only"});
    const image::Image8 screen = display_.screen();
    EXPECT_GT(count_near(screen, {0, 0, 1200, 30}, {219, 219, 219}, 16), 20000);     // the menu
    EXPECT_GT(count_near(screen, {400, 60, 100, 600}, {240, 240, 240}, 30), 10000);  // the panel
    act({"key", "ctrl+q"});
    ASSERT_EQ(program_->status(), 0) << program_->output();
    const auto settings =
        nlohmann::json::parse(read_text(folder_ / "config/relevo/settings.json", ""));
    EXPECT_EQ(settings["coordinates"], "mgrs");
}

TEST_F(Viewer, ScrollingWithShiftMovesTheGround) {
    open({dem_, "--only"});
    const auto camera = [&] { return scene()["camera"]; };
    const auto before = camera();
    act({"keydown", "shift"});
    ASSERT_TRUE(changes([&] { act({"click", "--repeat", "4", "--delay", "60", "5"}); }));
    act({"keyup", "shift"});
    const auto after = camera();
    EXPECT_EQ(after["heading"], before["heading"]);
    EXPECT_EQ(after["pitch"], before["pitch"]);
    EXPECT_NEAR(after["eye"][2], before["eye"][2], 30);  // level, on a round Earth
    EXPECT_GT(std::abs(after["eye"][0].get<double>() - before["eye"][0].get<double>()), 0.01);
}

/// A DEM that takes seconds to read: one of many posts, which come from a small one.
std::filesystem::path slow_dem(const std::filesystem::path& folder, const std::string& from) {
    const auto file = folder / "slow.vrt";
    constexpr int kPosts = 24000;
    std::ofstream(file) << fmt::format(
        R"(<VRTDataset rasterXSize="{0}" rasterYSize="{0}"><SRS>EPSG:4326</SRS>)"
        R"(<GeoTransform>-84.4,1e-5,0,36.4,0,-1e-5</GeoTransform>)"
        R"(<VRTRasterBand dataType="Float32" band="1" ><SimpleSource>)"
        R"(<SourceFilename>{1}</SourceFilename><SrcRect xOff="0" yOff="0" xSize="400" ySize="340"/>)"
        R"(<DstRect xOff="0" yOff="0" xSize="{0}" ySize="{0}"/></SimpleSource></VRTRasterBand>)"
        R"(</VRTDataset>)",
        kPosts, from);
    return file;
}

TEST_F(Viewer, NeverWaitsForADemThatIsStillBeingRead) {
    const std::filesystem::path slow = slow_dem(folder_, dem_);
    // What a file dialog would give, one after the other.
    std::filesystem::create_directories(folder_ / "bin");
    std::ofstream(folder_ / "bin/zenity")
        << "#!/bin/sh\ncat '" << (folder_ / "choice").string() << "'\n";
    std::filesystem::permissions(folder_ / "bin/zenity", std::filesystem::perms::owner_all);
    open({dem_, "--only", "--memory", "64"});
    const auto choose = [&](const std::string& dem) {
        std::ofstream(folder_ / "choice") << dem << "\n";
        act({"key", "ctrl+o"});
    };
    // There is no panel then, but the empty part of the picture before.
    const auto is_opening = [&] {
        return count_near(display_.screen(), {20, 600, 100, 120}, {176, 178, 196}) > 10000;
    };
    const auto seconds = [](const std::function<void()>& act) {
        const auto began = std::chrono::steady_clock::now();
        act();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    choose(slow.string());
    ASSERT_TRUE(wait([&] { return is_opening(); }));
    // Another one instead, at once.
    const double replaced_s = seconds([&] {
        choose(dem_);
        EXPECT_TRUE(wait([&] { return !is_opening(); }));
    });
    EXPECT_TRUE(settles());
    choose(slow.string());
    ASSERT_TRUE(wait([&] { return is_opening(); }));
    const double closed_s = seconds([&] {
        act({"key", "ctrl+q"});
        EXPECT_EQ(program_->status(), 0) << program_->output();
    });
    const double read_s = seconds([&] {
        test::WindowedProgram info(display_, test::build_dir() / "bin/relevo",
                                   {"-q", "capture", slow.string(), "--only", "--memory", "64",
                                    "--size", "32x32", "-o", (folder_ / "slow.png").string()});
        EXPECT_EQ(info.status(120), 0) << info.output();
    });
    fmt::print("[ measured ] replaced after {:.1f} s, closed after {:.1f} s; read in {:.1f} s\n",
               replaced_s, closed_s, read_s);
    EXPECT_LT(replaced_s, 0.5 * read_s);
    EXPECT_LT(closed_s, 3);
    EXPECT_GT(read_s, 5);
}

TEST_F(Viewer, EndsWithItsWindowAndRestsWhenNothingChanges) {
    open({dem_});
    const auto processor_s = [&] {
        std::ifstream stat(fmt::format("/proc/{}/stat", program_->process()));
        const std::string text{std::istreambuf_iterator<char>(stat), {}};
        const std::vector<std::string> words = split(text.substr(text.rfind(')') + 2), ' ');
        return (std::stod(words.at(11)) + std::stod(words.at(12))) /
               static_cast<double>(sysconf(_SC_CLK_TCK));
    };
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double before_s = processor_s();
    std::this_thread::sleep_for(std::chrono::seconds(5));
    const double share = (processor_s() - before_s) / 5;
    fmt::print("[ measured ] idle: {:.2f} % of a processor (limit 2)\n", 100 * share);
    EXPECT_LT(share, 0.02);
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

/// Whatever a hand does, for as long as RELEVO_SOAK_S says (25 s): the window stays, says nothing
/// of GL, and its memory does not grow.
TEST_F(Viewer, StandsWhateverIsDoneToIt) {
    paint("radiance.r += 0.1;");
    open({dem_, "--plugin-path", plugins_.string()});
    const std::string window =
        display_.act({"search", "--onlyvisible", "--pid", std::to_string(program_->process())});
    const std::string id = window.substr(0, window.find('\n'));
    const auto memory_mib = [&] {
        std::ifstream status(fmt::format("/proc/{}/statm", program_->process()));
        double pages = 0, resident = 0;
        status >> pages >> resident;
        return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
    };
    const char* const given = std::getenv("RELEVO_SOAK_S");
    const double length_s = given ? std::atof(given) : 25;
    std::mt19937 random(7);
    const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const std::vector<std::string> keys = {
        "t",           "n",      "g",  "w",    "a",   "d", "e",  "bracketright",
        "bracketleft", "space",  "c",  "Tab",  "h",   "m", "F5", "ctrl+z",
        "ctrl+y",      "ctrl+c", "Up", "Left", "Home"};
    double settled_mib = 0;
    int acts = 0;
    const auto began = std::chrono::steady_clock::now();
    const auto passed_s = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    for (; passed_s() < length_s && program_->is_running(); ++acts) {
        const int what = upto(10);
        if (what < 3) {
            drag(1 + upto(3), 450 + upto(700), 100 + upto(600), upto(400) - 200, upto(300) - 150);
        } else if (what < 5) {
            act({"click", "--repeat", "5", "--delay", "20", upto(2) ? "4" : "5"});
        } else if (what < 9) {
            act({"key", keys[static_cast<std::size_t>(upto(static_cast<int>(keys.size())))]});
        } else if (upto(2)) {
            paint(upto(2) ? "radiance.b += 0.2;" : "radiance.b += nothing;");
        } else {
            const bool tiny = upto(2) != 0;
            act({"windowsize", id, tiny ? "1" : "1000", tiny ? "1" : "700"});
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
            act({"windowsize", id, "1280", "800"});
        }
        if (settled_mib == 0 && passed_s() > length_s / 2) settled_mib = memory_mib();
    }
    ASSERT_TRUE(program_->is_running()) << program_->output();
    fmt::print("[ measured ] {} acts; memory {:.0f} MiB half way, {:.0f} MiB at the end\n", acts,
               settled_mib, memory_mib());
    EXPECT_LT(memory_mib(), 1.5 * settled_mib + 200);  // a comparison has a second scene
    EXPECT_THAT(program_->output(), testing::Not(HasSubstr("gl:")));
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST(WithoutADisplay, OneLineNamesTheWayWithoutOne) {
    const test::Display display;  // that the program is not told of
    test::WindowedProgram program(display, test::build_dir() / "bin/relevo", {"view"},
                                  {"DISPLAY="});
    EXPECT_EQ(program.status(), 4);
    EXPECT_EQ(program.output(),
              "relevo: error: view: there is no display to open a window on; relevo capture takes "
              "a picture without one\n");
}

}  // namespace
}  // namespace relevo
