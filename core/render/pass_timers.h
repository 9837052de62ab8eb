#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include "gl/context.h"
#include "gl/handle.h"

namespace relevo::render {

struct PassTime {
    std::string pass;
    double ms = 0;            ///< wall-clock time; of the device, where it measures
    double processor_ms = 0;  ///< of all threads of the process
};
/// Of a frame's passes, in order.
using PassTimes = std::vector<PassTime>;

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
        std::clock_t processor;
        Query stamp;
    };

    gl::Context& context_;
    bool stamps_;
    std::vector<Mark> marks_;
};

}  // namespace relevo::render
