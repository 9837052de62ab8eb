#include "viewer/messages.h"

namespace relevo::viewer {

void Messages::note(std::string text, std::chrono::seconds lasts) {
    shown_ = note_ = std::move(text);
    until_ = std::chrono::steady_clock::now() + lasts;
}

void Messages::report(std::string text) {
    log::info(text);
    note(std::move(text));
}

bool Messages::expire() {
    if (note_.empty() || std::chrono::steady_clock::now() < until_) return false;
    const bool is_shown = shown_ == note_;
    if (is_shown) shown_.clear();
    note_.clear();
    return is_shown;
}

}  // namespace relevo::viewer
