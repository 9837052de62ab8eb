#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "gl/context.h"
#include "gl/handle.h"

namespace relevo::render {

/// Milliseconds of the passes of one frame, by their names, in their order.
using PassTimes = std::vector<std::pair<std::string, double>>;

/// Measures passes. On hardware by the device's time stamps, without waiting for it between passes;
/// of a software renderer, whose time stamps leave out the work of vertices, by waiting.
class PassTimers {
  public:
    explicit PassTimers(gl::Context& context);

    /// A pass begins: the one before has ended.
    void begin(const std::string& pass, bool on_host);
    /// The last pass has ended. Waits for the device.
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
    void mark(const std::string& pass, bool on_host);

    gl::Context& context_;
    bool stamps_;
    std::vector<Mark> marks_;
};

}  // namespace relevo::render
