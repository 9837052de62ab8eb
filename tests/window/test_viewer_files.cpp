// The window's points, files, and what it remembers.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/ranges.h>

#include "viewer/fonts.h"
#include "window/viewer_fixture.h"

namespace relevo::test_viewer_files {
namespace {

TEST_F(Viewer, AClickShowsThePointsHorizonAndYearForTheShownDate) {
    // Chart and panel colours: the day's way, first and last light; direct sun through the year.
    constexpr glm::ivec3 kDay{0xe0, 0x7b, 0x12}, kSun{0xff, 0xd2, 0x4a};
    constexpr int kTab = 615;
    constexpr glm::ivec4 kChart{368, 628, 904, 122};
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
    EXPECT_GT(highest(display_.screen()), highest(summer) + 15);
    // The year: a click on it goes to that day and hour.
    act({"mousemove", "450", std::to_string(kTab)});
    act({"click", "1"});
    ASSERT_TRUE(wait([&] { return count_near(display_.screen(), kChart, kSun) > 5000; }));
    ASSERT_TRUE(settles());
    act({"mousemove", "425", "690"});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    act({"click", "1"});
    act({"mousemove", "900", "350"});
    ASSERT_TRUE(settles());
    EXPECT_THAT(scene()["time"]["at"].get<std::string>(), testing::StartsWith("2026-01-"));
    act({"key", "p"});
    EXPECT_TRUE(wait([&] { return count_near(display_.screen(), kChart, kSun) == 0; }));
}

TEST_F(Viewer, ChartsTakeARowOfTheirOwnAndTheSidesOfABlockAreNoGround) {
    constexpr glm::ivec3 kDay{0xe0, 0x7b, 0x12};
    constexpr glm::ivec4 kRow{368, 600, 904, 150};
    open({dem_, "--view", "az=165,el=28", "--time", "2026-06-21T18:00:00Z", "--disable", "haze"});
    const auto click = [&](const char* x, const char* y) {
        act({"mousemove", x, y});
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        act({"click", "1"});
    };
    const auto ways = [&] { return count_near(display_.screen(), kRow, kDay); };
    // The cut side in front, whose upper edge is where a post is.
    click("700", "480");
    ASSERT_TRUE(settles());
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_EQ(ways(), 0);
    click("900", "350");
    ASSERT_TRUE(wait([&] { return ways() > 500; }));
    ASSERT_TRUE(settles());
    // Their upper edge can be dragged. It is where it was after the panels were hidden.
    const auto is_higher = [&] {
        return count_near(display_.screen(), {500, 505, 700, 10}, {21, 23, 27}, 3) > 6000;
    };
    EXPECT_FALSE(is_higher());
    drag(1, 800, 597, 0, -100);
    EXPECT_TRUE(wait(is_higher));
    act({"key", "p"});
    ASSERT_TRUE(wait([&] { return !is_higher() && ways() == 0; }));
    act({"key", "p"});
    EXPECT_TRUE(wait(is_higher));
}

TEST_F(Viewer, OpensADemByItsNameAtTheSameHourOfItsOwnClocks) {
    // No file dialog of a desktop but the list of the window's own.
    std::filesystem::create_directories(folder_ / "maps/west");
    const std::filesystem::path data = test::source_dir() / "data/dem";
    std::filesystem::copy_file(data / "jacksboro.tif", folder_ / "maps/a.tif");
    std::filesystem::copy_file(data / "vancouver-island.tif", folder_ / "maps/west/b.tif");
    open({(folder_ / "maps/a.tif").string(), "--only", "--time", "2026-06-21T15:00:00"});
    EXPECT_EQ(scene()["time"]["at"], "2026-06-21T15:00:00-04:00");
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+o"}); }, 0.02));
    act({"type", "--delay", "60", "west"});
    act({"key", "Return"});
    ASSERT_TRUE(settles());
    act({"type", "--delay", "60", "b.tif"});
    act({"key", "Return"});
    ASSERT_TRUE(wait([&] { return program_->title().find("b.tif") != std::string::npos; }))
        << program_->output();
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene()["time"]["at"], "2026-06-21T15:00:00-07:00");
}

TEST_F(Viewer, MeasuresFromThePointToTheCursor) {
    constexpr glm::ivec3 kLine{255, 80, 60};
    constexpr glm::ivec4 kAbove{820, 260, 90, 50}, kBelow{820, 350, 90, 50};
    open({dem_, "--view", "az=165,el=28", "--only", "--time", "2026-06-21T18:00:00Z"});
    const auto red = [&](glm::ivec4 area) { return count_near(display_.screen(), area, kLine); };
    act({"key", "p", "mousemove", "760", "330"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    act({"click", "1"});
    ASSERT_TRUE(wait([&] { return red({750, 320, 20, 20}) > 20; }));
    ASSERT_EQ(red(kAbove) + red(kBelow), 0);
    act({"key", "m", "mousemove", "950", "440"});
    EXPECT_TRUE(wait([&] { return red(kBelow) > 50 && red(kAbove) == 0; }));
    act({"mousemove", "950", "250"});
    EXPECT_TRUE(wait([&] { return red(kAbove) > 50 && red(kBelow) == 0; }));
    // From then on it stays, and a click is another point.
    act({"key", "m", "mousemove", "950", "440"});
    ASSERT_TRUE(settles());
    EXPECT_GT(red(kAbove), 50);
    EXPECT_EQ(red(kBelow), 0);
    act({"click", "1"});
    EXPECT_TRUE(wait([&] { return red(kAbove) == 0 && red({940, 430, 20, 20}) > 20; }));
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
    const glm::ivec4 menu{20, 90, 150, 60}, list{340, 45, 200, 15}, second{340, 65, 200, 15};
    ASSERT_TRUE(changes_in(menu, [&] { act({"mousemove", "23", "11", "click", "1"}); }));
    ASSERT_TRUE(changes_in(list, [&] { act({"mousemove", "60", "52"}); }));
    ASSERT_TRUE(changes_in(list, [&] { act({"mousemove", "330", "52"}); }));
    ASSERT_TRUE(changes_in(second, [&] { act({"mousemove", "330", "72"}); }));
    act({"click", "1"});
    EXPECT_TRUE(shows("a.tif"));
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

TEST_F(Viewer, ShowsNamesInTheLettersOfTheirScript) {
    if (viewer::fonts_with({U'山'}).empty())
        GTEST_SKIP() << "not run: no font has Chinese or Japanese here";
    // Two names of the same length: without their letters both would be the same marks.
    const auto name_of = [&](const std::string& name) {
        std::filesystem::create_directories(plugins_ / "aname");
        std::ofstream(plugins_ / "aname/plugin.json")
            << R"({"format": 1, "id": "aname", "group": "ground", "name": "0)" << name
            << R"(", "description": "A name", "version": "1.0.0"})";
        std::ofstream(plugins_ / "aname/aname.glsl")
            << "void aname_on_lit(in Surface s, inout vec3 radiance) {}\n";
    };
    name_of("雪雪雪");
    std::filesystem::create_directories(folder_ / "地形");
    const auto dem = folder_ / "地形/山岳.tif";
    std::filesystem::copy_file(dem_, dem);
    open({dem.string(), "--only", "aname", "--plugin-path", plugins_.string()});
    EXPECT_THAT(program_->title(), testing::HasSubstr("山岳.tif"));
    const image::Image8 before = display_.screen();
    constexpr glm::ivec4 kPanel{50, 439, 280, 25};  // of the first effect of the first group
    const auto differing = [&] {
        const image::Image8 now = display_.screen();
        int count = 0;
        for (int y = kPanel.y; y < kPanel.y + kPanel.w; ++y)
            for (int x = kPanel.x; x < kPanel.x + kPanel.z; ++x)
                count += std::abs(now.row(y)[3 * x] - before.row(y)[3 * x]) > 60;
        return count;
    };
    name_of("山山山");
    EXPECT_TRUE(wait([&] { return differing() > 40; }));
    EXPECT_LT(differing(), 1500);  // three letters
}

TEST_F(Viewer, AFileThatCannotBeOpenedLeavesWhatWasThere) {
    std::filesystem::create_directories(folder_ / "maps");
    std::filesystem::copy_file(dem_, folder_ / "maps/a.tif");
    std::ofstream(folder_ / "maps/b.tif") << "no DEM";
    open({(folder_ / "maps/a.tif").string(), "--only", "--time", "2026-06-21T18:00:00Z"});
    ASSERT_TRUE(changes([&] { drag(3, 800, 400, 90, 30); }));
    ASSERT_TRUE(changes([&] { act({"key", "o"}); }, 0.01));  // an overlay of the sun
    const nlohmann::json before = resting_scene();
    constexpr glm::ivec4 kImage{500, 150, 650, 500}, kMessage{400, 25, 700, 60};
    act({"mousemove", "800", "700"});  // its pointer is part of the screen
    ASSERT_TRUE(settles());
    const image::Image8 image = display_.screen();
    ASSERT_TRUE(changes_in(kMessage, [&] { act({"key", "ctrl+Next"}); }));
    for (int look = 0; look < 5; ++look) {
        EXPECT_LT(count_other(image, display_.screen(), kImage), 100);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(scene(), before);
    // Also the steps of undo.
    ASSERT_TRUE(changes([&] { act({"key", "ctrl+z", "ctrl+z"}); }));
    EXPECT_NE(resting_scene()["camera"], before["camera"]);
}

TEST_F(Viewer, AnotherDemIsShownInSunlightUnlessTheTimeIsPinned) {
    std::filesystem::create_directories(folder_ / "maps");
    const std::filesystem::path data = test::source_dir() / "data/dem";
    for (const char* name : {"jacksboro.tif", "vancouver-island.tif"})
        std::filesystem::copy_file(data / name, folder_ / "maps" / name);
    const std::string first = (folder_ / "maps/jacksboro.tif").string();
    const auto next = [&] {
        act({"key", "ctrl+Next"});
        ASSERT_TRUE(wait([&] { return program_->title().find("vancouver") != std::string::npos; }));
        ASSERT_TRUE(settles());
    };
    open({first, "--only"});
    act({"key", "--repeat", "28", "--delay", "20", "bracketleft"});
    ASSERT_THAT(scene()["time"]["at"].get<std::string>(), testing::HasSubstr("T0"));
    next();
    // At 50 degrees north the sun of June is 10 degrees high at about a quarter past six.
    EXPECT_THAT(scene()["time"]["at"].get<std::string>(), testing::HasSubstr("T06:"));
    act({"key", "ctrl+q"});
    ASSERT_EQ(program_->status(), 0) << program_->output();
    // A time that was asked for is pinned.
    open({first, "--only", "--tz", "auto", "--time", "2026-06-21T02:00"});
    next();
    EXPECT_EQ(scene()["time"]["at"], "2026-06-21T02:00:00-07:00");
}

TEST_F(Viewer, WalksAtTheClickedPointElseInTheMiddleOfThePicture) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    const auto eye = [&] { return resting_scene()["camera"]["eye"]; };
    const auto above = eye();
    ASSERT_TRUE(changes([&] { act({"key", "g"}); }));
    const auto middle = eye();
    EXPECT_LT(middle[2].get<double>(), above[2].get<double>() - 500);
    // Flying low it walks where it is.
    act({"key", "g"});
    act({"key", "g"});
    const auto there = eye();
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(there[i].get<double>(), middle[i].get<double>(), 1e-9);
    ASSERT_TRUE(changes([&] { act({"key", "g", "Home"}); }));
    resting_scene();  // a click while the view glides home takes no point
    act({"mousemove", "700", "330"});
    ASSERT_TRUE(settles());
    ASSERT_TRUE(changes([&] { act({"click", "1"}); }, 1e-5));
    ASSERT_TRUE(changes([&] { act({"key", "g"}); }));
    EXPECT_GT(std::abs(eye()[1].get<double>() - middle[1].get<double>()), 0.01);
}

TEST_F(Viewer, EscGivesUpOpeningADem) {
    const std::filesystem::path slow = slow_dem(folder_, dem_);
    std::filesystem::create_directories(folder_ / "bin");
    std::ofstream(folder_ / "bin/zenity") << "#!/bin/sh\necho '" << slow.string() << "'\n";
    std::filesystem::permissions(folder_ / "bin/zenity", std::filesystem::perms::owner_all);
    open({dem_, "--only", "--memory", "64"});
    constexpr glm::ivec4 kStatus{0, 721, 1280, 30};
    const nlohmann::json before = scene();
    // The scene that is open stays, and can be worked with.
    ASSERT_TRUE(changes_in(kStatus, [&] { act({"key", "ctrl+o"}); }));
    EXPECT_EQ(scene(), before);
    ASSERT_TRUE(changes_in({500, 200, 700, 400}, [&] { act({"key", "t"}); }));
    ASSERT_TRUE(changes_in(kStatus, [&] { act({"key", "Escape"}); }));
    EXPECT_THAT(program_->title(), testing::HasSubstr("jacksboro.tif"));
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
}

TEST_F(Viewer, PagedThroughDemsGiveTheirMemoryBack) {
    std::filesystem::create_directories(folder_ / "maps");
    constexpr int kDems = 7;
    test::WindowedProgram make(display_, test::build_dir() / "bin/make_dem",
                               {dem_, "1600", "1600", (folder_ / "maps/0.tif").string()});
    ASSERT_EQ(make.status(120), 0) << make.output();
    for (int i = 1; i < kDems; ++i)
        std::filesystem::copy_file(folder_ / "maps/0.tif", folder_ / fmt::format("maps/{}.tif", i));
    open({(folder_ / "maps/0.tif").string()});
    const auto resident_mib = [&] {
        std::ifstream status(fmt::format("/proc/{}/status", program_->process()));
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("RssAnon:")) return std::stoi(line.substr(8)) / 1024;
        return -1;
    };
    std::vector<int> held_mib{resident_mib()};
    for (int i = 1; i < kDems; ++i) {
        act({"key", "ctrl+Next"});
        ASSERT_TRUE(wait(
            [&] { return program_->title().find(fmt::format("{}.tif", i)) != std::string::npos; }));
        ASSERT_TRUE(settles());
        held_mib.push_back(resident_mib());
    }
    fmt::print("[ measured ] MiB after each DEM: {}\n", fmt::join(held_mib, ", "));
    ASSERT_GT(held_mib.front(), 0);
    // Each DEM leaves some 25 MiB, and 1.2 GiB were held before memory was given back.
    EXPECT_LT(held_mib.back(), held_mib[0] + 300);
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
    // How far the ground glides on depends on the time that pictures take. On a round Earth a level
    // way rises a little.
    const auto changed = [&](int k) {
        return after["eye"][k].get<double>() - before["eye"][k].get<double>();
    };
    const double way_m = 111e3 * std::hypot(changed(0), changed(1) * 0.8);
    EXPECT_GT(way_m, 1000);
    EXPECT_LT(std::abs(changed(2)), way_m / 100);
}

TEST_F(Viewer, NeverWaitsForADemThatIsStillBeingRead) {
    const std::filesystem::path slow = slow_dem(folder_, dem_);
    // What a file dialog would give, one after the other.
    std::filesystem::create_directories(folder_ / "bin");
    std::ofstream(folder_ / "bin/zenity")
        << "#!/bin/sh\ncat '" << (folder_ / "choice").string() << "'\n";
    std::filesystem::permissions(folder_ / "bin/zenity", std::filesystem::perms::owner_all);
    open({dem_, "--only", "--memory", "64", "--view", "az=210,el=30", "--time",
          "2026-06-21T14:36:59Z"});
    const auto choose = [&](const std::string& dem) {
        std::ofstream(folder_ / "choice") << dem << "\n";
        act({"key", "ctrl+o"});
    };
    // The status line ends in "Esc cancels"; "drawing ..." would not reach so far.
    const auto is_opening = [&] {
        return count_near(display_.screen(), {550, 726, 200, 20}, {255, 255, 255}, 60) > 30;
    };
    act({"mousemove", "500", "60"});  // no ground, a short status line
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
        test::WindowedProgram info(
            display_, test::build_dir() / "bin/relevo",
            {"-q", "capture", slow.string(), "--only", "--memory", "128", "--view", "whole",
             "--size", "32x32", "-o", (folder_ / "slow.png").string()});
        EXPECT_EQ(info.status(120), 0) << info.output();
    });
    fmt::print("[ measured ] replaced after {:.1f} s, closed after {:.1f} s; read in {:.1f} s\n",
               replaced_s, closed_s, read_s);
    EXPECT_LT(replaced_s, read_s);
    EXPECT_LT(closed_s, read_s);
    ASSERT_GT(read_s, 2) << "too soon to tell";
}

}  // namespace
}  // namespace relevo::test_viewer_files
