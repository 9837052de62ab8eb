#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "viewer/film_plan.h"

namespace relevo::viewer {

/// Draws and encodes a film on a thread and a device of its own, while the window goes on. The file
/// appears complete or not at all.
class FilmExport {
  public:
    /// @param plan       has frames
    /// @param device     as session::Options
    /// @param on_change  called on its thread after each frame and at the end
    FilmExport(std::shared_ptr<const FilmPlan> plan, std::string device,
               std::function<void()> on_change);
    FilmExport(const FilmExport&) = delete;
    FilmExport& operator=(const FilmExport&) = delete;
    /// Cancels, and waits for the frame in work.
    ~FilmExport();

    const std::string& file() const { return plan_->film.output; }
    std::size_t frames() const { return plan_->frames.shots.size(); }
    std::size_t drawn() const { return drawn_; }
    /// Ends the film without a file, after the frame in work.
    void cancel() { is_cancelled_ = true; }
    bool is_cancelled() const { return is_cancelled_; }

    bool is_done() const { return is_done_; }
    /// "day.mp4: film saved, 300 frames, 10 s", or that it was cancelled. Requires is_done().
    /// @throws Error why there is no file
    std::string result() const;

  private:
    void run();
    std::string write();

    std::shared_ptr<const FilmPlan> plan_;
    std::string device_;
    std::function<void()> on_change_;
    std::atomic<std::size_t> drawn_ = 0;
    std::atomic<bool> is_cancelled_ = false, is_done_ = false;
    std::string result_;
    std::exception_ptr failure_;
    std::thread thread_;  // last: it uses the members above
};

}  // namespace relevo::viewer
