#include "base/progress.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"

namespace relevo {
namespace {

std::string duration_text(double seconds) {
    if (seconds < 100) return fmt::format("{:.0f} s", seconds);
    return seconds < 6000 ? fmt::format("{:.0f} min", seconds / 60)
                          : fmt::format("{:.0f} h", seconds / 3600);
}

}  // namespace

Progress::Progress(std::string what, double total, double patience_s)
    : what_(std::move(what)), total_(total), next_s_(patience_s) {}

void Progress::add(double work) {
    const std::lock_guard lock(mutex_);
    done_ += work;
    const double passed_s = std::chrono::duration<double>(Clock::now() - began_).count();
    if (passed_s < next_s_ || done_ <= 0 || done_ >= total_) return;
    next_s_ = std::max(2 * passed_s, next_s_);
    log::info(fmt::format("{}, {:.0f} % after {}, some {} more", what_, 100 * done_ / total_,
                          duration_text(passed_s),
                          duration_text(passed_s * (total_ - done_) / done_)));
}

}  // namespace relevo
