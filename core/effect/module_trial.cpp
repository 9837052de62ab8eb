#include "effect/module_trial.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/fatal_signals.h"
#include "base/paths.h"
#include "base/watchdog.h"
#include "shader/param_store.h"

extern char** environ;

namespace relevo::effect {
namespace {

using Clock = std::chrono::steady_clock;

/// A file without a name, in memory.
struct MemoryFile {
    int fd = memfd_create("report", MFD_CLOEXEC);
    MemoryFile() = default;
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(fd); }
};

/// Starts a program in a process group of its own. Its standard input and error are /dev/null.
/// @returns its id; 0 if it does not start
pid_t start(std::vector<std::string> command, int output) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<char*> argv;
    for (std::string& word : command)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t id = 0;
    if (posix_spawn(&id, argv[0], &actions, &attributes, argv.data(), environ) != 0) id = 0;
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return id;
}

/// Waits for a process, and then ends it and what it started.
/// @returns its status; none if it ran until the deadline
std::optional<int> status_at(Clock::time_point deadline, pid_t id) {
    bool ended = false;
    while (!ended && Clock::now() < deadline) {
        siginfo_t info{};
        ended = waitid(P_PID, static_cast<id_t>(id), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                info.si_pid == id;
        if (!ended) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    // Before waitpid() no other process can have the group's number.
    kill(-id, SIGKILL);
    int status = 0;
    while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
    }
    return ended ? std::optional(status) : std::nullopt;
}

std::string ending(int status) {
    if (!WIFSIGNALED(status)) return "ended the process";
    for (const FatalSignal& signal : kFatalSignals)
        if (signal.number == WTERMSIG(status)) return fmt::format("ended in {}", signal.name);
    return fmt::format("ended in signal {}", WTERMSIG(status));
}

template <std::size_t N>
std::string text_of(const std::array<char, N>& bytes) {
    return {bytes.data(), strnlen(bytes.data(), N)};
}

}  // namespace

std::string try_module(const std::filesystem::path& library, const std::string& id,
                       const std::filesystem::path& folder, const shader::ParamStore& values,
                       const std::vector<std::string>& marks) {
    std::vector<std::string> command{(module_dir() / "try_module").string(), library.string(), id,
                                     folder.string()};
    for (const shader::Param* param : values.params()) {
        const shader::ParamValue v = values.value(param->address);
        command.push_back(fmt::format("{} {} {} {} {} {}", param->is_host ? "host" : "value",
                                      param->address, v[0], v[1], v[2], v[3]));
    }
    for (const shader::TextParam* param : values.texts())
        command.push_back("text " + param->address);
    for (const std::string& list : marks)
        command.push_back("marks " + list);

    const std::chrono::milliseconds limit = patience() / 2;
    const Clock::time_point deadline = Clock::now() + limit;
    const MemoryFile file;
    const pid_t child = file.fd < 0 ? 0 : start(command, file.fd);
    if (child == 0)
        bad_input(
            fmt::format("plugin: {}: it cannot be tried: {} does not start; the installation "
                        "is not whole",
                        library.string(), command[0]));
    const std::optional<int> status = status_at(deadline, child);

    TrialReport report;
    if (pread(file.fd, &report, sizeof report, 0) == sizeof report && report.is_complete)
        return text_of(report.reason);
    std::string function = text_of(report.function);
    if (function.empty()) function = "loading it";
    if (status) return fmt::format("{} {}", function, ending(*status));
    return fmt::format("{} took more than {:g} s", function,
                       static_cast<double>(limit.count()) / 1e3);
}

}  // namespace relevo::effect
