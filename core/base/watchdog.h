#pragma once

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace relevo {

/// How long code of a plugin may take before the program ends: `$RELEVO_PATIENCE_S`, 20 s without.
/// @throws Error (Usage) if the variable is no number from 0.1 to 100000
std::chrono::milliseconds patience();

/// Writes `relevo: error: message` to standard error and ends the program with status 1, without
/// waiting for anything. Removes unfinished files. May be called in a signal's handler.
[[noreturn]] void end_program(const char* message) noexcept;

/// Ends the program if code that nothing else can stop takes too long.
class Watchdog {
  public:
    Watchdog();
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Unless stop() follows within the limit, end_program(message). The limit is wall-clock time
    /// and also the process's processor time, which a busy machine may not give. Code that sleeps
    /// ends after six times the limit.
    void start(std::chrono::milliseconds limit, std::string message);
    void stop();
    /// The time between the two does not count.
    void pause();
    void go_on();

  private:
    using Clock = std::chrono::steady_clock;
    void watch();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string message_;
    static constexpr Clock::time_point kNever = Clock::time_point::max();
    Clock::duration limit_{};
    Clock::time_point deadline_ = kNever, latest_ = kNever;
    std::clock_t used_before_ = 0;  // processor time of the process at the start
    std::optional<std::pair<Clock::time_point, std::clock_t>> paused_;  // since when
    bool over_ = false;
    std::thread thread_;
};

}  // namespace relevo
