#pragma once

#include <chrono>

namespace relevo::session {

using Clock = std::chrono::steady_clock;

/// Time since an instant [ms].
inline double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

}  // namespace relevo::session
