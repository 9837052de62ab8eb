#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace relevo {

/// "12 s", "5 min", "3 h".
std::string duration_text(double seconds);

/// A line on a terminal's standard error that grows with the work and tells how long the rest
/// takes; nothing anywhere else, and with -q.
class CountBar {
  public:
    explicit CountBar(std::size_t total);
    ~CountBar();
    CountBar(const CountBar&) = delete;
    CountBar& operator=(const CountBar&) = delete;

    /// One more is done. Safe on several threads at once.
    void add();

  private:
    void show() const;

    std::size_t total_, done_ = 0;
    bool shown_;
    mutable std::mutex mutex_;
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

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

/// A line on a terminal that says how much of long work is done and how long the rest takes, drawn
/// anew four times a second, and gone with this. Anything but a terminal gets no byte. Short work,
/// of less than a second, has no word.
class ProgressBar {
  public:
    /// @param descriptor  of the stream, standard error
    explicit ProgressBar(std::string what, int descriptor = 2);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// @param share  that is done, 0 to 1
    void show(double share);

  private:
    std::string what_;
    int descriptor_;
    bool terminal_, drawn_ = false;
    double next_s_ = 1;
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

/// "12 s", "3 min", "2 h".
std::string duration_text(double seconds);

}  // namespace relevo
