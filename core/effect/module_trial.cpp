#include "effect/module_trial.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/fatal_signals.h"
#include "base/paths.h"
#include "base/watchdog.h"
#include "effect/trial_report.h"

extern char** environ;

namespace relevo::effect {
namespace {

using Clock = std::chrono::steady_clock;

/// Closed at the end of its scope.
struct Descriptor {
    int fd = -1;
    ~Descriptor() { reset(); }
    void reset() {
        if (fd >= 0) close(std::exchange(fd, -1));
    }
};

/// The parameters in a file without a name, a line each: `haze.density 0 0.08 0 0 0`, where the
/// first number is the kind of trial_report.h. Texts are empty in a trial.
int parameter_file(const shader::ParamStore& values) {
    std::string text;
    for (const shader::Param* param : values.params()) {
        const shader::ParamValue value = values.value(param->address);
        text +=
            fmt::format("{} {} {} {} {} {}\n", param->address, param->is_host ? kHostValue : kValue,
                        value[0], value[1], value[2], value[3]);
    }
    for (const shader::TextParam* param : values.texts())
        text += fmt::format("{} {} 0 0 0 0\n", param->address, kText);
    const int fd = memfd_create("parameters", MFD_CLOEXEC);
    if (fd < 0) return fd;
    for (std::string_view left = text; !left.empty();) {
        const ssize_t count = write(fd, left.data(), left.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        left.remove_prefix(static_cast<std::size_t>(count));
    }
    lseek(fd, 0, SEEK_SET);
    return fd;
}

/// A child process in a group of its own, which ends with this.
class Child {
  public:
    /// Standard input is `input`, standard output `output`; standard error is away.
    Child(const std::filesystem::path& program, std::vector<std::string> arguments, int input,
          int output) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        arguments.insert(arguments.begin(), program.string());
        std::vector<char*> argv;
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        if (posix_spawn(&id_, program.c_str(), &actions, &attributes, argv.data(), environ) != 0)
            id_ = 0;
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
    }
    ~Child() {
        if (started()) end();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    bool started() const { return id_ > 0; }

    /// Its status if it ends by itself until then.
    std::optional<int> wait_until(Clock::time_point deadline) {
        while (true) {
            siginfo_t ended{};
            if (waitid(P_PID, static_cast<id_t>(id_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                ended.si_pid == id_)
                return end();
            if (Clock::now() >= deadline) return std::nullopt;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

  private:
    /// Ends it and what it started. @returns its status
    int end() {
        // As long as it has not been waited for, the group's number is nobody else's.
        kill(-id_, SIGKILL);
        int status = 0;
        while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = 0;
        return status;
    }

    pid_t id_ = 0;
};

/// What the child said. Of a module that writes on and on, no more is kept than a report may have.
struct Heard {
    std::string text;
    bool in_time = true;
};

Heard listen(int fd, Clock::time_point deadline) {
    Heard heard;
    std::array<char, 512> buffer;
    while (heard.text.size() < kMaxReportBytes &&
           heard.text.find(kReportEnd) == std::string::npos) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
        pollfd ready{fd, POLLIN, 0};
        const int events = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
        if (events < 0 && errno == EINTR) continue;
        heard.in_time = events > 0;
        if (events <= 0) break;
        const ssize_t count = read(fd, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        heard.text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return heard;
}

/// "its prepare()", as the last mark in the report says.
std::string last_stage(std::string_view report) {
    const std::size_t mark = report.rfind(kStageMark);
    if (mark == std::string_view::npos) return "loading it";
    const std::string_view rest = report.substr(mark + 1);
    return std::string(rest.substr(0, rest.find('\n')));
}

std::string ending(int status) {
    if (!WIFSIGNALED(status)) return "ended the process";
    for (const FatalSignal& signal : kFatalSignals)
        if (signal.number == WTERMSIG(status)) return fmt::format("ended in {}", signal.name);
    return fmt::format("ended in signal {}", WTERMSIG(status));
}

}  // namespace

std::string try_module(const std::filesystem::path& library, const std::string& id,
                       const std::filesystem::path& folder, const shader::ParamStore& values) {
    const std::filesystem::path program = module_dir() / "try_module";
    const auto cannot = [&](std::string_view why) {
        bad_input(fmt::format("plugin: {}: it cannot be tried: {}", library.string(), why));
    };
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) cannot(std::strerror(errno));
    const Descriptor reading{ends[0]};
    Descriptor writing{ends[1]};
    const Descriptor parameters{parameter_file(values)};
    if (parameters.fd < 0) cannot(std::strerror(errno));

    const std::chrono::milliseconds limit = patience() / 2;
    const Clock::time_point deadline = Clock::now() + limit;
    Child child(program, {library.string(), id, folder.string()}, parameters.fd, writing.fd);
    if (!child.started())
        cannot(fmt::format("{} does not start; the installation is not whole", program.string()));
    writing.reset();
    const Heard heard = listen(reading.fd, deadline);
    const std::size_t end = heard.text.find(kReportEnd);
    if (end != std::string::npos) {
        const std::size_t verdict = heard.text.rfind(kVerdictMark, end);
        return verdict == std::string::npos ? "its trial's report makes no sense"
                                            : heard.text.substr(verdict + 1, end - verdict - 1);
    }
    const std::string stage = last_stage(heard.text);
    if (heard.text.size() >= kMaxReportBytes)
        return fmt::format("{} wrote into the trial's report", stage);
    const std::optional<int> status =
        heard.in_time ? child.wait_until(deadline) : std::optional<int>();
    if (!status)
        return fmt::format("{} took more than {:g} s", stage,
                           static_cast<double>(limit.count()) / 1e3);
    return fmt::format("{} {}", stage, ending(*status));
}

}  // namespace relevo::effect
