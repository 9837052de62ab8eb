#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

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

    /// Unless stop() follows within the limit, end_program(message).
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
    Clock::time_point deadline_ = kNever;
    std::optional<Clock::duration> left_;  // while paused
    bool over_ = false;
    std::thread thread_;
};

}  // namespace relevo
