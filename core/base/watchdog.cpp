#include "base/watchdog.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/text.h"

namespace relevo {
namespace {

constexpr double kPatience_s = 20;

void write_all(const char* text) noexcept {
    std::size_t left = std::strlen(text);
    while (left > 0) {
        const ssize_t written = write(STDERR_FILENO, text, left);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        text += written;
        left -= static_cast<std::size_t>(written);
    }
}

}  // namespace

std::chrono::milliseconds patience() {
    const char* given = std::getenv("RELEVO_PATIENCE_S");
    const std::optional<double> seconds =
        given && *given ? parse_number(given) : std::optional(kPatience_s);
    if (!seconds || !(*seconds >= 0.1 && *seconds <= 1e5))
        bad_usage(fmt::format(
            "RELEVO_PATIENCE_S: expected a number of seconds in [0.1, 100000] but got \"{}\"",
            given));
    return std::chrono::milliseconds(static_cast<long>(*seconds * 1e3));
}

void end_program(const char* message) noexcept {
    // If two threads end the program at once, the second waits.
    static std::atomic_flag ending;
    while (ending.test_and_set())
        ::pause();
    write_all("relevo: error: ");
    write_all(message);
    write_all("\n");
    remove_partial_files();
    // Not exit() or _exit(): threads may hang, and memory may be corrupt.
    while (true)
        syscall(SYS_exit_group, static_cast<int>(ErrorCode::Failed));
}

Watchdog::Watchdog() : thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void Watchdog::start(std::chrono::milliseconds limit, std::string message) {
    {
        const std::lock_guard lock(mutex_);
        message_ = std::move(message);
        deadline_ = Clock::now() + limit;
    }
    changed_.notify_one();
}

void Watchdog::stop() {
    const std::lock_guard lock(mutex_);
    deadline_ = kNever;
    left_.reset();
}

void Watchdog::pause() {
    const std::lock_guard lock(mutex_);
    if (deadline_ == kNever) return;
    left_ = deadline_ - Clock::now();
    deadline_ = kNever;
}

void Watchdog::go_on() {
    {
        const std::lock_guard lock(mutex_);
        if (!left_) return;
        deadline_ = Clock::now() + *left_;
        left_.reset();
    }
    changed_.notify_one();
}

void Watchdog::watch() {
    std::unique_lock lock(mutex_);
    while (!over_) {
        if (deadline_ == kNever)
            changed_.wait(lock);
        else if (changed_.wait_until(lock, deadline_) == std::cv_status::timeout &&
                 Clock::now() >= deadline_)
            end_program(message_.c_str());
    }
}

}  // namespace relevo
