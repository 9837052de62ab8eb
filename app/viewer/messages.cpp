#include "viewer/messages.h"

namespace relevo::viewer {

void Messages::note(std::string text) {
    shown_ = note_ = std::move(text);
    noted_at_ = std::chrono::steady_clock::now();
}

void Messages::report(std::string text) {
    log::info(text);
    note(std::move(text));
}

bool Messages::expire() {
    constexpr std::chrono::seconds kNote(8);
    if (note_.empty() || std::chrono::steady_clock::now() - noted_at_ < kNote) return false;
    const bool is_shown = shown_ == note_;
    if (is_shown) shown_.clear();
    note_.clear();
    return is_shown;
}

}  // namespace relevo::viewer
