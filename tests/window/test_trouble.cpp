// The window where what it stands on goes: the display, the folder, a name for its picture.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/support.h"
#include "window/display.h"

namespace relevo::test_trouble {
namespace {

class Trouble : public testing::Test {
  protected:
    test::WindowedProgram open(const std::string& dem, const std::filesystem::path& folder) {
        return {display_, test::build_dir() / "bin/relevo", {dem}, {}, folder};
    }
    static bool opens(test::WindowedProgram& window) {
        return test::WindowedProgram::wait(
            [&] { return window.title().find(" - Relevo") != std::string::npos; });
    }
    void press(const test::WindowedProgram& window, const std::string& key) const {
        const std::string windows =
            display_.act({"search", "--onlyvisible", "--pid", std::to_string(window.process())});
        display_.act({"windowfocus", windows.substr(0, windows.find('\n'))});
        display_.act({"key", key});
    }
    static std::ptrdiff_t count(const std::filesystem::path& folder) {
        return std::distance(std::filesystem::directory_iterator(folder), {});
    }

    const std::filesystem::path folder_ = test::scratch_dir("trouble");
    const std::string dem_ = (test::source_dir() / "data/dem/jacksboro.tif").string();
    test::Display display_{640, 400};
};

TEST_F(Trouble, WithoutADisplayAnyMoreItEndsAndSaysSo) {
    test::WindowedProgram window = open(dem_, folder_);
    ASSERT_TRUE(opens(window)) << window.output();
    display_.vanish();
    EXPECT_EQ(window.status(), 1);
    EXPECT_EQ(window.output(), "relevo: error: view: the connection to the display was lost\n");
}

TEST_F(Trouble, ADisplayThatDoesNotAnswerIsNotWaitedForForEver) {
    display_.stop();
    test::WindowedProgram window(display_, test::build_dir() / "bin/relevo", {dem_},
                                 {"RELEVO_PATIENCE_S=1"}, folder_);
    EXPECT_EQ(window.status(), 1);
    EXPECT_EQ(window.output(),
              "relevo: error: view: the display does not answer; relevo capture takes a picture "
              "without one\n");
}

TEST_F(Trouble, TwoWindowsThatTakePicturesAtOnceTakeTwo) {
    test::WindowedProgram one = open(dem_, folder_), other = open(dem_, folder_);
    ASSERT_TRUE(opens(one) && opens(other)) << other.output();
    for (int pictures = 2; pictures <= 6; pictures += 2) {
        // Both find the key when they go on, and the same name free.
        for (const auto* window : {&one, &other})
            kill(window->process(), SIGSTOP);
        for (const auto* window : {&one, &other})
            press(*window, "F12");
        for (const auto* window : {&one, &other})
            kill(window->process(), SIGCONT);
        EXPECT_TRUE(test::WindowedProgram::wait([&] { return count(folder_) == pictures; }, 10))
            << count(folder_) << " of " << pictures;
    }
}

TEST_F(Trouble, APictureOfWhatIsNoNumberIsNotTaken) {
    const std::filesystem::path plugin = folder_ / "plugins/sick";
    std::filesystem::create_directories(plugin);
    std::ofstream(plugin / "plugin.json")
        << R"({"format": 1, "id": "sick", "name": "sick", "version": "1"})";
    std::ofstream(plugin / "sick.glsl")
        << "uniform float sick_zero = 0.0; //@ range(-1, 1)\n"
           "void sick_on_lit(in Surface s, inout vec3 radiance) { radiance /= sick_zero; }\n";
    test::WindowedProgram window(
        display_, test::build_dir() / "bin/relevo",
        {dem_, "--only", "sick", "--plugin-path", (folder_ / "plugins").string()}, {}, folder_);
    ASSERT_TRUE(opens(window)) << window.output();
    press(window, "F12");
    EXPECT_TRUE(test::WindowedProgram::wait([&] {
        return window.output().find("pixels are NaN or infinite") != std::string::npos;
    })) << window.output();
    EXPECT_EQ(count(folder_), 1);  // the plugins
}

TEST_F(Trouble, WithoutItsFolderItGoesOn) {
    const std::filesystem::path gone = folder_ / "gone";
    std::filesystem::create_directory(gone);
    std::filesystem::copy_file(dem_, folder_ / "dem.tif");
    test::WindowedProgram window = open("../dem.tif", gone);
    ASSERT_TRUE(opens(window)) << window.output();
    std::filesystem::remove(gone);
    press(window, "ctrl+s");
    press(window, "F12");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    press(window, "ctrl+q");
    EXPECT_EQ(window.status(), 0) << window.output();
}

}  // namespace
}  // namespace relevo::test_trouble
