#include "window/display.h"

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/text.h"
#include "support/support.h"

namespace relevo::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Starts a program with its output and error in a file.
pid_t start(const std::vector<std::string>& line, const std::vector<std::string>& environment,
            const std::filesystem::path& output, const std::filesystem::path& folder = {},
            int keep = -1) {
    std::vector<char*> arguments;
    for (const std::string& word : line)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(127);
    for (const std::string& setting : environment) {
        const std::size_t equals = setting.find('=');
        setenv(setting.substr(0, equals).c_str(), setting.substr(equals + 1).c_str(), 1);
    }
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    for (int descriptor = 3; descriptor < 64; ++descriptor)
        if (descriptor != keep) close(descriptor);
    execvp(arguments[0], arguments.data());
    _exit(127);
}

void end(pid_t process) {
    if (process <= 0) return;
    kill(process, SIGTERM);
    kill(process, SIGCONT);  // who stands still does not end
    waitpid(process, nullptr, 0);
}

/// A folder of this display's or window's own: a test may have several, and each empties its own.
std::filesystem::path own_folder(std::string_view kind) {
    static std::atomic<int> count = 0;
    return scratch_dir(fmt::format("{}_{}_{}", kind, getpid(), ++count));
}

}  // namespace

nlohmann::json answer_of(const std::string& arguments) {
    const std::string command =
        fmt::format("{} -q {} 2>/dev/null", (build_dir() / "bin/relevo").string(), arguments);
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string text(1 << 16, ' ');
    text.resize(std::fread(text.data(), 1, text.size(), pipe));
    pclose(pipe);
    return nlohmann::json::parse(text);
}

Display::Display(int width_px, int height_px) : folder_(own_folder("display")) {
    std::array<int, 2> tube{};
    if (pipe(tube.data()) != 0) failed("test: no pipe");
    // It takes a number that is free, and says which when it is ready.
    server_ = start({"Xvfb", "-displayfd", std::to_string(tube[1]), "-screen", "0",
                     fmt::format("{}x{}x24", width_px, height_px), "-fbdir", folder_.string(),
                     "-nolisten", "tcp", "-noreset"},
                    {}, folder_ / "server.txt", {}, tube[1]);
    close(tube[1]);
    std::string number;
    for (char c = 0; read(tube[0], &c, 1) == 1 && c != '\n';)
        number += c;
    close(tube[0]);
    if (number.empty())
        failed("test: Xvfb does not start: " + read_text(folder_ / "server.txt", "test"));
    name_ = ":" + number;
}

Display::~Display() {
    vanish();
}

void Display::stop() {
    kill(server_, SIGSTOP);
}

void Display::vanish() {
    end(std::exchange(server_, -1));
}

image::Image8 Display::screen() const {
    return picture_of_dump(read_text(folder_ / "Xvfb_screen0", "test"));
}

std::string Display::act(const std::vector<std::string>& arguments) const {
    std::vector<std::string> line{"xdotool"};
    line.insert(line.end(), arguments.begin(), arguments.end());
    const std::filesystem::path output = folder_ / "xdotool.txt";
    const pid_t process = start(line, {"DISPLAY=" + name_}, output);
    int status = 0;
    waitpid(process, &status, 0);
    const std::string text = read_text(output, "test");
    if (status != 0) failed(fmt::format("test: xdotool {}: {}", arguments.front(), text));
    return text;
}

WindowedProgram::WindowedProgram(const Display& display, const std::filesystem::path& program,
                                 const std::vector<std::string>& arguments,
                                 const std::vector<std::string>& environment,
                                 const std::filesystem::path& folder)
    : display_(display), output_(own_folder("window") / "output.txt") {
    std::vector<std::string> line{program.string()};
    line.insert(line.end(), arguments.begin(), arguments.end());
    // Whoever runs the tests has settings and recent files of their own.
    const std::string own = output_.parent_path().string();
    std::vector<std::string> settings{"DISPLAY=" + display.name(),
                                      "WAYLAND_DISPLAY=", "XDG_CONFIG_HOME=" + own + "/config",
                                      "XDG_STATE_HOME=" + own + "/state"};
    settings.insert(settings.end(), environment.begin(), environment.end());
    process_ = start(line, settings, output_, folder);
}

WindowedProgram::~WindowedProgram() {
    if (is_running()) end(process_);
}

std::string WindowedProgram::title() const {
    try {
        const std::string window =
            display_.act({"search", "--onlyvisible", "--pid", std::to_string(process_)});
        return std::string(
            trimmed(display_.act({"getwindowname", window.substr(0, window.find('\n'))})));
    } catch (const Error&) {
        return {};
    }
}

bool WindowedProgram::wait(const std::function<bool()>& holds, double at_most_s) {
    const auto until = Clock::now() + std::chrono::duration<double>(at_most_s);
    while (!holds()) {
        if (Clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

bool WindowedProgram::is_running() {
    if (ended_) return false;
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) == 0) return true;
    ended_ = true;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return false;
}

int WindowedProgram::status(double at_most_s) {
    wait([&] { return !is_running(); }, at_most_s);
    return status_;
}

std::string WindowedProgram::output() const {
    return read_text(output_, "test");
}

}  // namespace relevo::test
