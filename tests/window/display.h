#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "image/image.h"

/// A display that nobody looks at, and programs with windows on it.
namespace relevo::test {

/// How long is waited for what has to come: only a test that fails waits so long [s].
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kPatience_s = 240;
#else
constexpr double kPatience_s = 60;
#endif

/// What `relevo -q ARGUMENTS` prints, as JSON.
nlohmann::json answer_of(const std::string& arguments);

/// An X server of its own (Xvfb), whose screen is a file.
class Display {
  public:
    /// @throws Error (Failed) where Xvfb does not start
    explicit Display(int width_px = 1280, int height_px = 800);
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    ~Display();

    const std::string& name() const { return name_; }  ///< ":57"
    /// Ends the server under its programs.
    void vanish();
    /// Has the server stand still, to the end.
    void stop();
    /// What is on the screen now, RGB.
    image::Image8 screen() const;
    /// Runs xdotool: {"mousemove", "100", "200"}. @returns what it prints
    /// @throws Error (Failed) with what it says
    std::string act(const std::vector<std::string>& arguments) const;

  private:
    std::filesystem::path folder_;
    pid_t server_ = -1;
    std::string name_;
};

/// A program on a display. Ends with this.
class WindowedProgram {
  public:
    /// @param environment  "NAME=value"; a DISPLAY of its own takes the place of the display's
    /// @param folder       where it runs; empty: where the test does
    WindowedProgram(const Display& display, const std::filesystem::path& program,
                    const std::vector<std::string>& arguments,
                    const std::vector<std::string>& environment = {},
                    const std::filesystem::path& folder = {});
    WindowedProgram(const WindowedProgram&) = delete;
    WindowedProgram& operator=(const WindowedProgram&) = delete;
    ~WindowedProgram();

    std::string title() const;  ///< of its window; empty while there is none
    /// Waits until it holds. @returns whether it did within the time
    static bool wait(const std::function<bool()>& holds, double at_most_s = kPatience_s);
    bool is_running();
    /// Waits for its end. @returns its exit status; -1 if not in time, minus its signal
    int status(double at_most_s = kPatience_s);
    std::string output() const;  ///< standard output and error so far
    pid_t process() const { return process_; }

  private:
    const Display& display_;
    std::filesystem::path output_;
    pid_t process_ = -1;
    int status_ = -1;
    bool ended_ = false;
};

/// The picture in an X window dump of 32 bits a pixel, RGB.
image::Image8 picture_of_dump(const std::string& dump);

/// Mean of the values.
double brightness(const image::Image8& picture);

/// Share of the values that differ by more than `by` between two pictures of one size.
double difference(const image::Image8& a, const image::Image8& b, int by = 2);

}  // namespace relevo::test
