#include "viewer/frame_pacing.h"

#include <utility>

namespace relevo::viewer {
namespace {

/// The scene counts as moving for this long after the last movement.
constexpr double kRest_s = 0.15;
/// The shortest time between frames without a new image while the camera moves. Each frame takes
/// processor time from the scene.
constexpr double kRepeat_s = 0.08;

}  // namespace

void FramePacing::new_image() {
    has_new_image_ = true;
    need_frames(1);
}

double FramePacing::wait_s(bool is_animated, bool is_drawing) const {
    if (needs_frames() || is_animated) return 0.008;
    if (!is_at_rest_) return 0.05;
    return is_drawing ? 0.25 : kIdle_s;
}

double FramePacing::begin_pass() {
    const double passed_s = seconds_since(pass_at_);
    pass_at_ = Clock::now();
    return passed_s;
}

void FramePacing::moved() {
    // Leaves the processors to the scene for its first image of the new view.
    if (std::exchange(is_at_rest_, false)) drawn_at_ = Clock::now();
    moved_at_ = Clock::now();
}

void FramePacing::update_rest() {
    is_at_rest_ = still_s() > kRest_s;
}

bool FramePacing::is_overdue() const {
    return is_at_rest_ && still_s() > 2 * kRest_s;
}

bool FramePacing::repeats_frame(int buttons) const {
    return !has_new_image_ && buttons == drawn_buttons_ && seconds_since(drawn_at_) < kRepeat_s;
}

void FramePacing::begin_frame(int buttons) {
    drawn_at_ = Clock::now();
    drawn_buttons_ = buttons;
    has_new_image_ = false;
}

}  // namespace relevo::viewer
