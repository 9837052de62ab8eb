#include "figure/estimate.h"

#include <algorithm>

namespace relevo::figure {

void SampledTime::begin_part(double share, double now_s) {
    parts_share_ += share;
    is_first_ = true;
    last_s_ = now_s;
}

void SampledTime::end_step(double share, double now_s) {
    (is_first_ ? ready_share_ : steps_share_) += share;
    (is_first_ ? ready_s_ : steps_s_) += now_s - last_s_;
    is_first_ = false;
    last_s_ = now_s;
}

bool SampledTime::suffices() const {
    constexpr double kRounding = 1e-9;
    return steps_share_ > 0 || ready_share_ > (1 - kRounding) * parts_share_;
}

double SampledTime::all_s() const {
    if (parts_share_ <= 0) return 0;
    const double of_steps = std::max(0.0, 1 - ready_share_ / parts_share_);
    return ready_s_ / parts_share_ + (steps_share_ > 0 ? steps_s_ / steps_share_ * of_steps : 0);
}

}  // namespace relevo::figure
