// The least front end does what a window has to, on a display.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/text.h"
#include "support/support.h"
#include "window/display.h"

namespace relevo::test_example {
namespace {

TEST(Window, OrbitsMovesTheSunDragsASliderAndSurvivesABrokenShader) {
    if (!std::filesystem::exists(test::source_dir() / "plugins/haze"))
        GTEST_SKIP() << "haze, which the slider is for, is not there";
    // A plugin of its own, which the test breaks and mends.
    const std::filesystem::path folder = test::scratch_dir("window_plugins");
    std::filesystem::create_directories(folder / "paint");
    std::ofstream(folder / "paint/plugin.json")
        << R"({"format": 1, "id": "paint", "name": "Paint", "description": "Reddens",)"
           R"( "version": "1.0.0"})";
    const auto write = [&](const char* body) {
        std::ofstream(folder / "paint/paint.glsl")
            << "void paint_on_lit(in Surface s, inout vec3 radiance) {\n"
            << body << "\n}\n";
    };
    write("radiance.r += 0.2;");
    std::ofstream(folder / "scene.json") << "{\"format\": 1, \"dem\": {\"files\": ["
                                         << (test::source_dir() / "data/dem/jacksboro.tif")
                                         << "]}, \"time\": {\"at\": \"2026-06-21T14:36:59Z\"}, "
                                            "\"camera\": {\"orbit\": {\"azimuth\": 210, "
                                            "\"elevation\": 30}}, \"effects\": {\"only\": "
                                            "[\"haze\", \"paint\"], \"plugin_path\": [\".\"]}}";

    const test::Display display;
    test::WindowedProgram window(display, test::build_dir() / "bin/example_window",
                                 {(folder / "scene.json").string()});
    const auto title_has = [&](const char* text) {
        return test::WindowedProgram::wait(
            [&] { return window.title().find(text) != std::string::npos; });
    };
    ASSERT_TRUE(title_has("azimuth 95.28, elevation 48.95")) << window.output();
    image::Image8 before = display.screen();
    /// Whether the picture becomes another one, and stays so.
    const auto changes = [&](const std::vector<std::string>& act) {
        before = display.screen();
        display.act(act);
        return test::WindowedProgram::wait(
            [&] { return test::difference(display.screen(), before) > 0.02; });
    };
    // Orbit.
    display.act({"mousemove", "700", "500", "mousedown", "1"});
    EXPECT_TRUE(changes({"mousemove_relative", "--sync", "60", "20"}));
    display.act({"mouseup", "1"});
    // The sun.
    EXPECT_TRUE(changes({"key", "--repeat", "4", "Right"}));
    EXPECT_TRUE(title_has("azimuth 129.68"));
    // A slider of 300 px or so, whose right half is thick haze.
    display.act({"mousemove", "90", "97", "mousedown", "1"});
    EXPECT_TRUE(changes({"mousemove_relative", "--sync", "200", "0"}));
    display.act({"mouseup", "1", "mousemove", "700", "500"});
    // A shader that no driver takes: the last good picture stays, and says so.
    EXPECT_TRUE(test::WindowedProgram::wait([&] {
        before = display.screen();
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        return test::difference(display.screen(), before) == 0;
    }));
    write("radiance.r += no_such_name;");
    display.act({"key", "r"});
    EXPECT_TRUE(title_has("paint.glsl:2")) << window.title() << window.output();
    EXPECT_LT(test::difference(display.screen(), before), 0.02);
    EXPECT_TRUE(window.is_running());
    // And mended.
    write("radiance.b += 0.2;");
    EXPECT_TRUE(changes({"key", "r"})) << window.title();
    EXPECT_TRUE(title_has("effects read again"));
}

}  // namespace
}  // namespace relevo::test_example
