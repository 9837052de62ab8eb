#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "gl/context.h"
#include "gl/handle.h"

namespace relevo::render {

/// Durations of a frame's passes [ms] by name, in order.
using PassTimes = std::vector<std::pair<std::string, double>>;

/// Measures passes. On hardware uses the device's time stamps, which need no waiting. On software
/// renderers waits for the device after each pass, because their time stamps exclude vertex work.
class PassTimers {
  public:
    explicit PassTimers(gl::Context& context);

    /// Starts a pass and ends the one before. @param on_host  measures CPU time
    void begin(const std::string& pass, bool on_host);
    /// Ends the last pass. Waits for the device.
    PassTimes end();

  private:
    using Clock = std::chrono::steady_clock;
    static void destroy(unsigned name);
    using Query = gl::Handle<&PassTimers::destroy>;
    struct Mark {
        std::string pass;
        bool on_host;
        Clock::time_point at;
        Query stamp;
    };

    gl::Context& context_;
    bool stamps_;
    std::vector<Mark> marks_;
};

}  // namespace relevo::render
