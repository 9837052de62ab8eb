#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "support/support.h"
#include "window/display.h"

namespace relevo {

/// Pixels of an area that differ to the eye.
inline int count_other(const image::Image8& one, const image::Image8& other, glm::ivec4 area) {
    constexpr int kSeen = 8;
    int count = 0;
    for (int y = area.y; y < area.y + area.w; ++y)
        for (int x = 3 * area.x; x < 3 * (area.x + area.z); x += 3) {
            const std::uint8_t *a = one.row(y) + x, *b = other.row(y) + x;
            count += std::abs(a[0] - b[0]) > kSeen || std::abs(a[1] - b[1]) > kSeen ||
                     std::abs(a[2] - b[2]) > kSeen;
        }
    return count;
}

/// What an area of the screen has of a colour, by less than `by` in each channel.
inline int count_near(const image::Image8& screen, glm::ivec4 area, glm::ivec3 colour,
                      int by = 12) {
    int count = 0;
    for (int y = area.y; y < area.y + area.w; ++y)
        for (int x = area.x; x < area.x + area.z; ++x) {
            const std::uint8_t* at = screen.row(y) + 3 * x;
            count += std::abs(at[0] - colour.x) < by && std::abs(at[1] - colour.y) < by &&
                     std::abs(at[2] - colour.z) < by;
        }
    return count;
}

/// The window of `relevo DEM`, driven by a mouse and keys on a display of the tests' own.
class Viewer : public testing::Test {
  protected:
    /// Starts the program, which remembers nothing outside of the test's folder.
    void start(const std::vector<std::string>& arguments) {
        std::vector<std::string> environment{
            "XDG_CONFIG_HOME=" + (folder_ / "config").string(),
            "XDG_STATE_HOME=" + (folder_ / "state").string(),
            "PATH=" + (folder_ / "bin").string() + ":" + std::getenv("PATH")};
        environment.insert(environment.end(), environment_.begin(), environment_.end());
        program_.emplace(display_, test::build_dir() / "bin/relevo", arguments, environment,
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
    /// As xdotool has it.
    std::string window_id() const {
        const std::string windows =
            display_.act({"search", "--onlyvisible", "--pid", std::to_string(program_->process())});
        return windows.substr(0, windows.find('\n'));
    }
    /// Whether a window is there, and more than the dusk before its first picture.
    static bool shows_picture(const image::Image8& screen) {
        const auto is_dusk = [&](int y) {
            const glm::ivec3 dusk(22 + 96 * y / 800, 34 + 62 * y / 800, 58 + 38 * y / 800);
            return count_near(screen, {1274, y, 1, 1}, dusk, 4) == 1;
        };
        return test::brightness(screen) > 30 && !(is_dusk(200) && is_dusk(400) && is_dusk(600));
    }
    /// Waits until the screen shows a picture, and the same for a while.
    /// @param looks  so many in a row, 150 ms apart: a slow window has no frame every 60 ms
    bool settles(int looks = 6) {
        image::Image8 before = display_.screen();
        int same = 0;
        return wait([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(150));
            image::Image8 now = display_.screen();
            same = test::difference(now, before) < 1e-4 && shows_picture(now) ? same + 1 : 0;
            before = std::move(now);
            return same >= looks;
        });
    }
    /// Whether doing it makes another picture, of which this share differs at least.
    bool changes(const std::function<void()>& act, double share = 0.05) {
        const image::Image8 before = display_.screen();
        act();
        if (!wait([&] { return test::difference(display_.screen(), before) > share; }))
            return false;
        return settles();
    }
    /// Whether doing it changes a part of the screen, however slowly the window goes on meanwhile.
    bool changes_in(const glm::ivec4& area, const std::function<void()>& act) {
        constexpr int kSome = 30;  // pixels
        const image::Image8 before = display_.screen();
        act();
        return wait([&] { return count_other(before, display_.screen(), area) > kSome; });
    }
    /// The scene as Ctrl+S saves it now.
    nlohmann::json scene() {
        const auto name = folder_ / fmt::format("relevo-{}.json", ++saved_);
        act({"key", "ctrl+s"});
        EXPECT_TRUE(wait([&] { return std::filesystem::exists(name); })) << program_->output();
        return nlohmann::json::parse(read_text(name, "test"));
    }
    /// The scene when its view has stopped gliding, which a slow machine may not show on the
    /// screen.
    nlohmann::json resting_scene() {
        nlohmann::json before, now = scene();
        do
            before = std::exchange(now, scene());
        while (before["camera"] != now["camera"]);
        return now;
    }
    /// The picture that F12 saves is what `relevo capture` draws of the scene that Ctrl+S saves.
    void expect_picture_is_its_capture() {
        resting_scene();
        act({"key", "F12"});
        const auto taken = folder_ / "relevo-1.png", captured = folder_ / "captured.png";
        ASSERT_TRUE(wait([&] { return std::filesystem::exists(taken); })) << program_->output();
        const auto scene_file = folder_ / fmt::format("relevo-{}.json", saved_);
        test::WindowedProgram capture(
            display_, test::build_dir() / "bin/relevo",
            {"-q", "capture", "--scene", scene_file.string(), "-o", captured.string()});
        ASSERT_EQ(capture.status(), 0) << capture.output();
        const image::Image8 a = image::read(taken), b = image::read(captured);
        EXPECT_LE(test::difference(a, b, 1), 2e-4);
        EXPECT_EQ(test::difference(a, b, 3), 0);
    }
    void drag(int button, int x, int y, int dx, int dy) {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
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
    std::vector<std::string> environment_;  // of the program: "NAME=value"
    const std::string dem_ = (test::source_dir() / "data/dem/jacksboro.tif").string();
    test::Display display_{1280, 800};
    std::optional<test::WindowedProgram> program_;
    int saved_ = 0;
};

}  // namespace relevo
