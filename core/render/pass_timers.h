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

/// Measures passes: on hardware by the device's time stamps, which need no wait between passes. A
/// software renderer is waited for after each pass, as its time stamps do not count vertex work.
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

    gl::Context& context_;
    bool stamps_;
    std::vector<Mark> marks_;
};

}  // namespace relevo::render
