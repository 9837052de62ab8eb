#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/error.h"
#include "base/fatal_signals.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "dem/object_stores.h"

namespace {

int run(int argc, char** argv) {
    relevo::dem::use_object_stores();
    relevo::cli::run({argv + std::min(argc, 1), argv + argc});
    return 0;
}

/// Has the three standard streams open: the first file to be opened would take the place of one
/// that is closed, and get what is meant for it.
void fill_standard_streams() {
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number)
        if (fcntl(number, F_GETFD) < 0 && errno == EBADF)
            // What writes to standard output still fails; nobody waits for messages.
            open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

/// Writes out what the stream still holds; the reason where some of the output is lost.
/// @param earlier  the reason, where a print has failed already
std::optional<std::string> close_standard_output(const std::string& earlier) {
    const bool was_lost = std::ferror(stdout);
    errno = 0;
    bool lost = std::fflush(stdout) != 0;
    // Network file systems say at a close what has not arrived.
    if (const int copy = dup(STDOUT_FILENO); copy >= 0) lost = close(copy) != 0 || lost;
    if (!was_lost && !lost) return std::nullopt;
    if (!earlier.empty()) return earlier;
    return errno != 0 ? std::strerror(errno) : "some of it is lost";
}

/// What went wrong, as an Error would say it.
struct Failure {
    int status;
    std::string message;
};

Failure out_of_memory() {
    return {1,
            "out of memory; use a smaller --size, a smaller --memory, or fewer DEMs, or raise "
            "ulimit -v"};
}

/// Of errors that are not ours: what the system refuses, and our own mistakes.
Failure failure_of(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return out_of_memory();
    if (dynamic_cast<const std::length_error*>(&error)) return out_of_memory();
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        return {3, fmt::format("{}: cannot be read, {}", relevo::printable(file->path1().string()),
                               file->code().message())};
    if (const auto* system = dynamic_cast<const std::system_error*>(&error)) {
        if (system->code() == std::errc::not_enough_memory) return out_of_memory();
        if (system->code() == std::errc::resource_unavailable_try_again)
            return {1,
                    "the system refuses more threads or processes; end others, or raise ulimit -u"};
        return {1, fmt::format("the system refuses a call, {}; run it again with -v",
                               system->code().message())};
    }
    return {1, fmt::format("a mistake in the program, {}; please report it with the command line",
                           error.what())};
}

/// @param lost_output  where a print to standard output failed, why
int run_and_report(int argc, char** argv, std::string& lost_output) {
    try {
        return run(argc, argv);
    } catch (const relevo::Error& error) {
        relevo::log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        if (std::ferror(stdout)) {
            // fmt throws where it cannot print.
            const auto* print = dynamic_cast<const std::system_error*>(&error);
            lost_output = print ? print->code().message() : error.what();
            return 0;
        }
        const Failure failure = failure_of(error);
        relevo::log::error(failure.message);
        return failure.status;
    }
}

/// What a limit on memory or on stacks leaves a graphics driver ends it by a signal, not an error.
/// Sanitizers say more of it.
int run_guarded(int argc, char** argv, std::string& lost_output) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const relevo::FatalSignalGuard guard([](const char* ending) {
        return fmt::format(
            "the program ended in {}; allow more memory and stack (ulimit -v, "
            "ulimit -s), else report it with the command line",
            ending);
    });
#endif
    return run_and_report(argc, argv, lost_output);
}

/// Does work with stacks of the usual size, its own and those of the threads that it starts, where
/// a limit (ulimit -s) allows the first thread less than drivers need.
int with_usual_stacks(const std::function<int()>& work) {
    constexpr std::size_t kUsualBytes = 8 << 20;
    constexpr rlim_t kEnoughBytes = 1 << 20;
    rlimit limit{};
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= kEnoughBytes) return work();
    pthread_attr_t usual;
    pthread_attr_init(&usual);
    pthread_attr_setstacksize(&usual, kUsualBytes);
    pthread_setattr_default_np(&usual);
    pthread_attr_destroy(&usual);
    int status = 1;
    std::thread([&] { status = work(); }).join();
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    fill_standard_streams();
    relevo::remove_partial_files_at_signals();
    std::string lost_output;
    const int status = with_usual_stacks([&] { return run_guarded(argc, argv, lost_output); });
    const std::optional<std::string> lost = close_standard_output(lost_output);
    if (!lost || status != 0) return status;
    relevo::log::error(fmt::format("standard output: cannot be written, {}", *lost));
    return static_cast<int>(relevo::ErrorCode::Failed);
}
