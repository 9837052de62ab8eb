#include "base/progress.h"

#include <algorithm>
#include <cstdio>
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

ProgressBar::ProgressBar(std::string what, int descriptor)
    : what_(std::move(what)), descriptor_(descriptor), terminal_(isatty(descriptor) != 0) {}

ProgressBar::~ProgressBar() {
    if (drawn_) put(descriptor_, kClearLine);
}

void ProgressBar::show(double share) {
    const double passed_s = std::chrono::duration<double>(Progress::Clock::now() - began_).count();
    if (!terminal_ || passed_s < next_s_ || !(share > 0 && share < 1)) return;
    next_s_ = passed_s + kRedraw_s;
    drawn_ = true;
    const auto full = static_cast<std::size_t>(share * kBarWidth);
    put(descriptor_, fmt::format("{}{} [{}{}] {:.0f} %, {} left", kClearLine, what_,
                                 std::string(full, '='), std::string(kBarWidth - full, ' '),
                                 100 * share, duration_text(passed_s * (1 - share) / share)));
}

CountBar::CountBar(std::size_t total)
    : total_(total), shown_(isatty(STDERR_FILENO) == 1 && log::level() <= log::Level::Info) {
    if (shown_) log::set_before([] { fmt::print(stderr, "\r\x1b[K"); });
}

CountBar::~CountBar() {
    if (!shown_) return;
    log::set_before({});
    fmt::print(stderr, "\r\x1b[K");
}

void CountBar::add() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (shown_) show();
}

void CountBar::show() const {
    constexpr std::size_t kWidth = 32;
    const std::size_t full = total_ > 0 ? kWidth * done_ / total_ : kWidth;
    const double passed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const double left_s =
        passed_s / static_cast<double>(done_) * static_cast<double>(total_ - done_);
    fmt::print(stderr, "\r[{}{}] {} of {}, {} left\x1b[K", std::string(full, '#'),
               std::string(kWidth - full, '.'), done_, total_, duration_text(left_s));
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
