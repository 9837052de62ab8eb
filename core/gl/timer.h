#pragma once

#include <optional>

#include "gl/handle.h"

namespace relevo::gl {

/// Time that the device spends on the commands between begin() and end() (GL_TIME_ELAPSED).
/// One at a time: timers do not nest.
class Timer {
  public:
    Timer();
    void begin();
    void end();
    /// Milliseconds; waits for the device. Nothing before begin() and end().
    std::optional<double> milliseconds() const;

  private:
    static void destroy(unsigned name);
    Handle<&Timer::destroy> handle_;
    bool ended_ = false;
};

}  // namespace relevo::gl
