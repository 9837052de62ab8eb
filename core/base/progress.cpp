#include "base/progress.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/log.h"

namespace relevo {
namespace {

constexpr int kBarWidth = 24;
constexpr double kRedraw_s = 0.25;
constexpr std::string_view kClearLine = "\r\x1b[K";

bool lines = false;  // set once, before there are threads

void put(int descriptor, std::string_view text) {
    // A terminal that is gone is no reason to end the work.
    [[maybe_unused]] const ssize_t written = write(descriptor, text.data(), text.size());
}

}  // namespace

std::string duration_text(double seconds) {
    if (seconds < 100) return fmt::format("{:.0f} s", seconds);
    return seconds < 6000 ? fmt::format("{:.0f} min", seconds / 60)
                          : fmt::format("{:.0f} h", seconds / 3600);
}

void ProgressBar::use_lines(bool on) {
    lines = on;
}

ProgressBar::ProgressBar(std::string what, int descriptor)
    : what_(std::move(what)),
      descriptor_(descriptor),
      shown_(lines || (isatty(descriptor) == 1 && log::level() <= log::Level::Info)),
      next_s_(lines ? 0 : 1) {
    if (!what_.empty()) what_ += ' ';
    if (shown_ && !lines && descriptor_ == STDERR_FILENO)
        log::set_before([] { put(STDERR_FILENO, kClearLine); });
}

ProgressBar::~ProgressBar() {
    if (shown_ && !lines && descriptor_ == STDERR_FILENO) log::set_before({});
    if (drawn_) put(descriptor_, kClearLine);
}

void ProgressBar::show(double share) {
    draw(share, fmt::format("{:.0f} %", 100 * share));
}

void ProgressBar::show(std::size_t done, std::size_t total) {
    draw(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(total, 1)),
         fmt::format("{} of {}", done, total));
}

void ProgressBar::draw(double share, const std::string& words) {
    const std::lock_guard lock(mutex_);
    const double passed_s = std::chrono::duration<double>(Progress::Clock::now() - began_).count();
    if (!shown_ || passed_s < next_s_ || !(share > 0 && share < 1)) return;
    next_s_ = passed_s + kRedraw_s;
    if (lines) {
        put(descriptor_, fmt::format("progress {:.3f}\n", share));
        return;
    }
    drawn_ = true;
    const auto full = static_cast<std::size_t>(share * kBarWidth);
    put(descriptor_, fmt::format("{}{}[{}{}] {}, {} left", kClearLine, what_,
                                 std::string(full, '='), std::string(kBarWidth - full, ' '), words,
                                 duration_text(passed_s * (1 - share) / share)));
}

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
