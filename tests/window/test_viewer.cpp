// The window of `relevo DEM`, driven by a mouse and keys on a display of the tests' own.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <unistd.h>

#include "base/units.h"
#include "geo/geodetic.h"
#include "image/image.h"
#include "window/viewer_fixture.h"

namespace relevo::test_viewer {
namespace {

using testing::HasSubstr;

TEST_F(Viewer, TurnsPansZoomsAndGoesHome) {
    open({dem_});
    const nlohmann::json home = scene();
    const auto camera = [&] { return resting_scene()["camera"]; };
    EXPECT_EQ(home["camera"]["eye_above_ground"], false);
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 150, 60); }));
    const auto turned = camera();
    EXPECT_GT(std::abs(turned["heading"].get<double>() - home["camera"]["heading"].get<double>()),
              10);
    EXPECT_LT(turned["pitch"].get<double>(), home["camera"]["pitch"].get<double>() - 2);
    // Every notch of the wheel counts, however few of them fall on a frame of the window.
    const auto way_m = [&](const nlohmann::json& from, const nlohmann::json& to) {
        glm::dvec3 by{0};
        for (int i = 0; i < 3; ++i)
            by[i] = to["eye"][i].get<double>() - from["eye"][i].get<double>();
        return length(by);
    };
    ASSERT_TRUE(changes([&] { act({"click", "4"}); }));
    const double notch_m = way_m(turned, camera());
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z"}); }));
    ASSERT_TRUE(changes([&] { act({"click", "--repeat", "6", "--delay", "60", "4"}); }));
    const auto nearer = camera();
    // The ground it goes to may be drawn more finely by now. Five notches would be 3.23 of one.
    EXPECT_NEAR(way_m(turned, nearer) / notch_m, (1 - std::exp(-6 * 0.25)) / (1 - std::exp(-0.25)),
                0.12);
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

/// Where a picture has edges: from the leftmost to the rightmost [px], from the uppermost to the
/// lowest. The backdrop of a block and its shadow have none.
glm::ivec4 edges_of(const image::Image8& picture) {
    glm::ivec4 box(picture.width, 0, picture.height, 0);
    const auto green = [&](int x, int y) {
        return static_cast<int>(
            picture
                .values[static_cast<std::size_t>((y * picture.width + x) * picture.channels + 1)]);
    };
    for (int y = 0; y < picture.height; ++y)
        for (int x = 1; x < picture.width; ++x)
            if (std::abs(green(x, y) - green(x - 1, y)) > 16)
                box = {std::min(box[0], x), std::max(box[1], x), std::min(box[2], y),
                       std::max(box[3], y)};
    return box;
}

// Whatever the picture takes, the first thing on the screen says what is opened.
TEST_F(Viewer, BeginsWithItsNameAndAProgressBar) {
    start({dem_});
    image::Image8 first;
    ASSERT_TRUE(wait([&] {
        first = display_.screen();
        return count_near(first, {0, 0, 1280, 800}, {0, 0, 0}, 4) < 1000 * 800;
    }));
    // Letters, and a piece of the bar, which no panel covers.
    constexpr glm::ivec4 kCard{580, 330, 500, 120};
    EXPECT_GT(count_near(first, kCard, {232, 234, 237}, 30), 100);
    EXPECT_GT(count_near(first, kCard, {242, 184, 75}, 20), 100);
}

TEST_F(Viewer, ShowsTheWholeDemBesideThePanels) {
    open({dem_, "--view", "az=165,el=28"});
    const auto taken = [&](int number) {
        act({"key", "F12"});
        const auto name = folder_ / fmt::format("relevo-{}.png", number);
        EXPECT_TRUE(wait([&] { return std::filesystem::exists(name); }));
        return edges_of(image::read(name));
    };
    // The panel ends 360 px from the left, the menu 22 px from the top.
    const auto fills_the_room = [](const glm::ivec4& box) {
        EXPECT_GE(box[0], 358);
        EXPECT_LE(box[1], 1275);
        EXPECT_GE(box[2], 20);
        EXPECT_LE(box[3], 756);
        const double wide = (box[1] - box[0]) / 920.0, high = (box[3] - box[2]) / 734.0;
        EXPECT_NEAR(std::max(wide, high), 0.95, 0.02) << wide << " " << high;
    };
    fills_the_room(taken(1));
    const nlohmann::json first = scene();
    ASSERT_TRUE(changes([&] { act({"key", "t"}); }));
    EXPECT_EQ(scene()["camera"]["pitch"], -90);
    fills_the_room(taken(2));
    // What is asked for in a window lower than its menu is somewhere, too.
    const std::string id = window_id();
    const auto resize = [&](const char* width, const char* height) {
        act({"windowsize", id, width, height, "sleep", "0.5"});
    };
    resize("300", "30");
    act({"key", "Home", "sleep", "0.5"});
    EXPECT_TRUE(scene()["camera"]["eye"][2].is_number());
    act({"key", "t", "sleep", "0.5"});
    EXPECT_TRUE(scene()["camera"]["eye"][2].is_number());
    resize("1280", "800");
    act({"key", "Home", "sleep", "0.5"});
    EXPECT_EQ(resting_scene()["camera"]["eye"], first["camera"]["eye"]);
    // The camera at home stays there when the window is resized: the DEM fills it again.
    resize("900", "700");
    ASSERT_TRUE(settles());
    const auto resized = resting_scene()["camera"];
    EXPECT_NE(resized["eye"], first["camera"]["eye"]);
    act({"key", "Home", "sleep", "0.5"});
    EXPECT_EQ(resting_scene()["camera"], resized);
    resize("1280", "800");
    ASSERT_TRUE(settles());
    EXPECT_EQ(resting_scene()["camera"]["eye"], first["camera"]["eye"]);
    // Of the whole window where there are none.
    ASSERT_TRUE(changes([&] { act({"key", "Tab"}); }));
    ASSERT_TRUE(changes([&] { act({"key", "Home"}); }));
    const glm::ivec4 alone = taken(3);
    EXPECT_NEAR(alone[0] + alone[1], 1280, 15);
    EXPECT_NEAR(std::max((alone[1] - alone[0]) / 1280.0, (alone[3] - alone[2]) / 800.0), 0.95,
                0.02);
    // From near by, from above is of what is in the middle.
    act({"click", "--repeat", "8", "--delay", "60", "4"});
    ASSERT_TRUE(changes([&] { act({"key", "t"}); }));
    EXPECT_EQ(scene()["camera"]["pitch"], -90);
    EXPECT_LT(scene()["camera"]["eye"][2], 20000);
    // And a walk begins with a look ahead.
    ASSERT_TRUE(changes([&] { act({"key", "g"}); }));
    EXPECT_EQ(scene()["camera"]["pitch"], 0);
}

TEST_F(Viewer, TheWholeDemStaysInViewAsItsHeightsBecomeTrue) {
    open({dem_});
    const nlohmann::json first = resting_scene();
    ASSERT_GT(first["exaggeration"].get<double>(), 1);
    act({"key", "bracketright"});
    ASSERT_TRUE(settles());
    const nlohmann::json then = resting_scene();
    EXPECT_EQ(then.value("exaggeration", 1.0), 1);
    EXPECT_NE(then["camera"], first["camera"]);
    act({"key", "Home", "sleep", "0.5"});
    EXPECT_EQ(resting_scene()["camera"], then["camera"]);
}

TEST_F(Viewer, AViewOfOnesOwnStaysAsHeightsBecomeTrue) {
    open({dem_});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 150, 60); }));
    const nlohmann::json first = resting_scene();
    act({"key", "bracketright"});
    ASSERT_TRUE(settles());
    const nlohmann::json then = resting_scene();
    EXPECT_EQ(then.value("exaggeration", 1.0), 1);
    EXPECT_EQ(then["camera"]["heading"], first["camera"]["heading"]);
    for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(then["camera"]["eye"][i].get<double>(), first["camera"]["eye"][i].get<double>(),
                    1e-6);
}

// It goes without any input, and is in no picture.
TEST_F(Viewer, SaysForSomeSecondsWhatWasUndone) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    constexpr glm::ivec4 kMessage{400, 25, 800, 60};
    const auto before = display_.screen();
    act({"key", "bracketright", "sleep", "1"});
    EXPECT_TRUE(changes_in(kMessage, [&] { act({"key", "ctrl+z"}); }));
    act({"key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); }));
    EXPECT_TRUE(test::WindowedProgram::wait(
        [&] { return count_other(before, display_.screen(), kMessage) < 30; }, 15));
    const image::Image8 picture = image::read(taken);
    EXPECT_LT(count_other(before, picture, kMessage), 30);
}

TEST_F(Viewer, IsSharpWhileTheHandHoldsStill) {
    open({dem_, "--time", "2026-06-21T20:00:00Z"});
    // Whether the picture of a hand that holds still for so many looks is that of one that let go.
    const auto is_sharp = [&](int x, int y, int looks) {
        act({"mousemove", "850", "400", "sleep", "0.3", "mousedown", "3"});
        act({"mousemove", std::to_string(850 + x / 2), std::to_string(400 + y / 2), "sleep", "0.1",
             "mousemove", std::to_string(850 + x), std::to_string(400 + y)});
        EXPECT_TRUE(settles(looks));
        const image::Image8 held = display_.screen();
        act({"mouseup", "3"});
        EXPECT_TRUE(settles(looks));
        return test::difference(display_.screen(), held) < 1e-4;
    };
    // On a machine with other work a frame may take seconds, and nothing changes meanwhile.
    for (const auto& [x, y] : {std::pair{60, 30}, {-85, 11}, {37, -23}, {101, 17}})
        EXPECT_TRUE(is_sharp(x, y, 8) || is_sharp(x, y, 25) || is_sharp(x, y, 60)) << x << " " << y;
}

/// 150 posts from 36.3 N, 84.2 W, back along where it looks.
void expect_view_of_place(const nlohmann::json& camera) {
    const geo::Geodetic eye =
        geo::geodetic_deg(camera["eye"][0].get<double>(), camera["eye"][1].get<double>(), 0);
    const geo::Geodesic back = geo::geodesic(eye, geo::geodetic_deg(36.3, -84.2, 0));
    EXPECT_NEAR(std::remainder(degrees(back.azimuth_rad) - camera["heading"].get<double>(), 360), 0,
                0.1);
    EXPECT_NEAR(std::hypot(back.distance_m, camera["eye"][2].get<double>() - 375), 150 * 80.5, 500);
}

TEST_F(Viewer, GoesToAPlaceThatIsWritten) {
    open({dem_, "--only"});
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+f"}); }, 0.005));
    // However soon the key is let go.
    act({"type", "--delay", "60", "36.3, -84.2"});
    ASSERT_TRUE(changes([&] { act({"key", "Return"}); }));
    expect_view_of_place(resting_scene()["camera"]);
}

// Everything is typed before the window has its next frame.
TEST_F(Viewer, LosesNoKeyThatIsTypedWithinAFrame) {
    open({dem_, "--only"});
    EXPECT_TRUE(changes([&] {
        ::kill(program_->process(), SIGSTOP);
        act({"key", "ctrl+f", "type", "--delay", "1", "nowhere at all"});
        act({"key", "ctrl+a", "BackSpace", "type", "--delay", "1", "36.33, -84.2"});
        // GLFW takes a key that is pressed again within 20 ms for one that is held.
        act({"key", "--delay", "80", "Left", "Left", "Left", "Left", "Left", "Left", "Left",
             "BackSpace", "Return"});
        ::kill(program_->process(), SIGCONT);
    }));
    expect_view_of_place(resting_scene()["camera"]);
}

// Elsewhere in the panel it edits a slider's number.
TEST_F(Viewer, ADoubleClickInATextFieldSelectsItsWord) {
    open({dem_, "--only"});
    act({"mousemove", "170", "401", "sleep", "0.3", "click", "1", "sleep", "0.5"});
    EXPECT_TRUE(changes([&] { act({"type", "haze"}); }, 0.01)) << "the list has one effect";
    act({"click", "--repeat", "2", "--delay", "60", "1", "sleep", "1"});
    EXPECT_TRUE(changes([&] { act({"key", "BackSpace"}); }, 0.01)) << program_->output();
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
    expect_picture_is_its_capture();
}

TEST_F(Viewer, TheDayIsSavedAsAJobThatRuns) {
    // By the clocks of Tokyo the sun of Tennessee sets before it rises.
    open({dem_, "--time", "2026-06-21T20:00:00Z", "--tz", "Asia/Tokyo", "--disable", "haze"});
    act({"key", "ctrl+j"});
    const auto name = folder_ / "relevo-1.json";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(name); })) << program_->output();
    const auto job = nlohmann::json::parse(read_text(name, "test"));
    EXPECT_EQ(job["time"], nlohmann::json::parse(
                               R"({"at": "00:00", "date": "2026-06-22", "zone": "Asia/Tokyo"})"));
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0);

    open({dem_, "--time", "2026-06-21T20:00:00Z", "--disable", "haze"});
    act({"key", "ctrl+j"});
    const auto day = folder_ / "relevo-2.json";
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(day); })) << program_->output();
    const auto saved = nlohmann::json::parse(read_text(day, "test"));
    EXPECT_EQ(saved["sweep"], nlohmann::json::parse(R"([{"times": {"from": "sunrise",
                              "to": "sunset", "step": "1h"}}])"));
    ++saved_;
    nlohmann::json shown = scene(), of_job = saved;
    for (const char* key : {"time", "sweep", "output"}) {
        shown.erase(key);
        of_job.erase(key);
    }
    EXPECT_EQ(of_job, shown);
    test::WindowedProgram schema(
        display_, "/usr/bin/python3",
        {(test::source_dir() / "tests/check_schema.py").string(), test::source_dir().string(),
         "--jobs", name.string(), day.string()});
    EXPECT_EQ(schema.status(), 0) << schema.output();
    test::WindowedProgram run(display_, test::build_dir() / "bin/relevo",
                              {"run", day.string(), "--dry-run", "--size", "64x48"});
    ASSERT_EQ(run.status(), 0) << run.output();
    // The sun is up from 06:19 to 20:53.
    const std::string stem = (folder_ / std::filesystem::path(dem_).stem()).string();
    EXPECT_THAT(run.output(), testing::HasSubstr(stem + "_20260621T0619.png\n"));
    EXPECT_THAT(run.output(), testing::HasSubstr(stem + "_20260621T2019.png\n"));
    EXPECT_THAT(run.output(), testing::HasSubstr("relevo: 15 pictures would take"));
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
    const nlohmann::json home = scene();
    act({"key", "Tab"});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 150, 60); }));
    const nlohmann::json turned = resting_scene();
    // Below the messages, which come and go.
    const image::Image8 whole = display_.screen();
    const auto is_whole = [&] {
        constexpr glm::ivec4 kPicture{0, 60, 1280, 740};
        return count_other(display_.screen(), whole, kPicture) < kPicture.z * kPicture.w / 50;
    };
    // No DEM any more: it says so, and waits.
    ASSERT_TRUE(changes([&] { std::ofstream(dem) << "no DEM"; }, 0.001));
    EXPECT_TRUE(program_->is_running());
    // Another one: the same ground, and seen from where it was.
    EXPECT_TRUE(changes_in({400, 25, 500, 60}, [&] {
        std::filesystem::copy_file(dem_, dem, std::filesystem::copy_options::overwrite_existing);
    }));
    ASSERT_TRUE(settles());
    EXPECT_NEAR(scene()["camera"]["heading"].get<double>(),
                turned["camera"]["heading"].get<double>(), 1e-9);
    // And the whole of it is what it was.
    act({"key", "Tab"});
    ASSERT_TRUE(changes([&] { act({"key", "Home"}); }));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(scene()["camera"]["eye"][i].get<double>(),
                    home["camera"]["eye"][i].get<double>(), 1e-6);
    act({"key", "ctrl+z", "key", "Tab"});
    ASSERT_TRUE(wait(is_whole));
    std::filesystem::remove(dem);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_TRUE(program_->is_running());
    EXPECT_TRUE(is_whole());
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
    ASSERT_TRUE(settles());
    // The line is dragged: more of it stays as it was.
    ASSERT_TRUE(changes([&] { drag(1, 640, 300, 400, 0); }, 0.01));
    EXPECT_TRUE(wait([&] {
        return half_differs(display_.screen(), 0, 1000) < half_differs(after, 0, 1000) / 4;
    }));
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
    // The line and its names, and no message: both halves are the same.
    ASSERT_TRUE(changes([] {}, 1e-4));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_LT(test::difference(display_.screen(), alone), 0.01);
    EXPECT_GT(test::difference(display_.screen(), alone), 0.0005);
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
    // Refinement may still be under way: on a slow machine it pauses longer than settles() waits.
    EXPECT_TRUE(wait([&] {
        const double before_s = processor_s();
        std::this_thread::sleep_for(std::chrono::seconds(5));
        const double share = (processor_s() - before_s) / 5;
        fmt::print("[ measured ] idle: {:.2f} % of a processor (limit 2)\n", 100 * share);
        return share < 0.02;
    }));
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST(WithoutADisplay, OneLineNamesTheWayWithoutOne) {
    const test::Display display;  // that the program is not told of
    test::WindowedProgram program(display, test::build_dir() / "bin/relevo", {"view"},
                                  {"DISPLAY="});
    EXPECT_EQ(program.status(), 4);
    EXPECT_EQ(program.output(),
              "relevo: error: view: no display to open a window on; relevo capture takes "
              "a picture without one\n");
}

}  // namespace
}  // namespace relevo::test_viewer
