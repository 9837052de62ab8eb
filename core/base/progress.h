#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace relevo {

/// Tells of long work with log::info: after ten seconds how much is done and about how long the
/// rest takes, then whenever as much time again has passed. Short work has no word.
/// Safe on several threads at once.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;

    /// @param what   what is said before it: "alps.tif: read"
    /// @param total  of the work, in any unit
    /// @param patience_s  before the first word
    Progress(std::string what, double total, double patience_s = 10);

    /// More of it is done.
    void add(double work);

  private:
    std::mutex mutex_;
    std::string what_;
    double total_;
    double done_ = 0;
    double next_s_;
    Clock::time_point began_ = Clock::now();
};

}  // namespace relevo
