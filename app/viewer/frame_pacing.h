#pragma once

#include <algorithm>
#include <chrono>

namespace relevo::viewer {

using Clock = std::chrono::steady_clock;

/// The longest wait for input. Files are checked for changes at this interval.
inline constexpr double kIdle_s = 1;

inline double seconds_since(Clock::time_point began) {
    return std::chrono::duration<double>(Clock::now() - began).count();
}

/// Decides how long the window waits for input and whether it draws a frame.
class FramePacing {
  public:
    /// Draws at least `count` frames without waiting for input: panels need several to settle.
    void need_frames(int count) { frames_left_ = std::max(frames_left_, count); }
    bool needs_frames() const { return frames_left_ > 0; }
    /// A new image of the scene has to be drawn.
    void new_image();

    /// The longest wait for input [s].
    /// @param is_animated  the scene changes without input
    /// @param is_drawing   an image of the scene is overdue
    double wait_s(bool is_animated, bool is_drawing) const;
    /// Begins a pass of the event loop. @returns the time since the last one [s]
    double begin_pass();

    /// The camera or the sun moves now.
    void moved();
    /// The time since the last movement [s].
    double still_s() const { return seconds_since(moved_at_); }
    /// Whether nothing moved at the last update_rest().
    bool is_at_rest() const { return is_at_rest_; }
    void update_rest();
    /// Whether the scene has been at rest long enough to report that its image is overdue.
    bool is_overdue() const;

    /// Whether a frame would repeat the last one, which was drawn a short time ago.
    /// @param buttons  of the mouse that are pressed, as Window::buttons()
    bool repeats_frame(int buttons) const;
    void begin_frame(int buttons);
    void end_frame() { frames_left_ = std::max(frames_left_ - 1, 0); }

  private:
    Clock::time_point pass_at_ = Clock::now(), moved_at_ = Clock::now(), drawn_at_;
    int frames_left_ = 3;
    int drawn_buttons_ = 0;
    bool has_new_image_ = false, is_at_rest_ = true;
};

}  // namespace relevo::viewer
