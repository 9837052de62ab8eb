#include "base/watchdog.h"

#include <algorithm>
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
constexpr int kSleeping = 6;  // a process may have little processor time for so many limits

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
        limit_ = limit;
        deadline_ = Clock::now() + limit;
        latest_ = deadline_ + (kSleeping - 1) * limit_;
        used_before_ = std::clock();
        paused_.reset();
    }
    changed_.notify_one();
}

void Watchdog::stop() {
    const std::lock_guard lock(mutex_);
    deadline_ = kNever;
    paused_.reset();
}

void Watchdog::pause() {
    const std::lock_guard lock(mutex_);
    if (deadline_ != kNever && !paused_) paused_.emplace(Clock::now(), std::clock());
}

void Watchdog::go_on() {
    {
        const std::lock_guard lock(mutex_);
        if (!paused_) return;
        const Clock::duration away = Clock::now() - paused_->first;
        deadline_ += away;
        latest_ += away;
        used_before_ += std::clock() - paused_->second;
        paused_.reset();
    }
    changed_.notify_one();
}

void Watchdog::watch() {
    std::unique_lock lock(mutex_);
    while (!over_) {
        if (deadline_ == kNever || paused_) {
            changed_.wait(lock);
            continue;
        }
        // A copy: the member may change while this waits.
        const Clock::time_point deadline = deadline_;
        changed_.wait_until(lock, deadline);
        const Clock::time_point now = Clock::now();
        if (over_ || paused_ || now < deadline_) continue;
        const std::chrono::duration<double> used(double(std::clock() - used_before_) /
                                                 CLOCKS_PER_SEC);
        if (used >= limit_ || now >= latest_) end_program(message_.c_str());
        deadline_ = std::min(latest_, now + limit_ / 20);
    }
}

}  // namespace relevo
