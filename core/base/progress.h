#pragma once

#include <chrono>
#include <cstddef>
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

/// A line on a terminal that says how much of long work is done and how long the rest takes, drawn
/// anew four times a second, and gone with this. Anything but a terminal gets no byte, nor does
/// anything with -q. Short work, of less than a second, has no word. What is logged meanwhile takes
/// the line's place. Safe on several threads at once.
class ProgressBar {
  public:
    /// Whether bars that are made from now on are lines for other programs, on any stream and also
    /// with -q: "progress 0.342", the share that is done, four times a second at most.
    static void use_lines(bool on);

    /// @param what        is done, before the bar; may be empty
    /// @param descriptor  of the stream, standard error
    explicit ProgressBar(std::string what = {}, int descriptor = 2);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// @param share  that is done, 0 to 1
    void show(double share);
    /// The same for things that can be counted: "3 of 96" instead of "3 %".
    void show(std::size_t done, std::size_t total);

  private:
    void draw(double share, const std::string& words);

    std::string what_;
    int descriptor_;
    bool shown_, drawn_ = false;
    double next_s_;
    std::mutex mutex_;
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

/// "12 s", "3 min", "2 h".
std::string duration_text(double seconds);

}  // namespace relevo
