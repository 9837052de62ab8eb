#include "viewer/history.h"

namespace relevo::viewer {
namespace {

constexpr std::size_t kMaxStates = 500;

}  // namespace

void History::add(const Document& document) {
    if (!states_.empty()) states_.resize(at_ + 1);
    states_.push_back(document);
    if (states_.size() > kMaxStates) states_.erase(states_.begin());
    at_ = states_.size() - 1;
}

void History::amend(const Document& document) {
    if (!states_.empty()) states_[at_] = document;
}

bool History::differs(const Document& document) const {
    if (states_.empty()) return true;
    const Document& now = states_[at_];
    return now.utc != document.utc || now.pose.eye_m != document.pose.eye_m ||
           now.pose.heading_deg != document.pose.heading_deg ||
           now.pose.pitch_deg != document.pose.pitch_deg;
}

void History::end_step(const Document& document) {
    if (differs(document)) add(document);
}

const Document& History::undo() {
    return states_[--at_];
}

const Document& History::redo() {
    return states_[++at_];
}

}  // namespace relevo::viewer
