#include "viewer/history.h"

#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr std::size_t kMaxStates = 500;

std::string change_name(const Document& from, const Document& to) {
    if (!(from.scene.effects == to.scene.effects)) return tr("effects");
    if (!(from.overlay == to.overlay) || !(from.scene.overlay == to.scene.overlay))
        return tr("layers");
    if (from.scene.land_cover != to.scene.land_cover) return tr("houses and trees");
    if (from.scene.exaggeration != to.scene.exaggeration) return tr("heights");
    if (from.scene.exposure_ev != to.scene.exposure_ev) return tr("exposure");
    if (from.zone.name() != to.zone.name()) return tr("time zone");
    return from.utc != to.utc ? tr("time") : tr("view");
}

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

std::string History::undo_name(const Document* document) const {
    if (states_.empty()) return {};
    if (document && differs(*document)) return change_name(states_[at_], *document);
    return can_undo() ? change_name(states_[at_ - 1], states_[at_]) : "";
}

std::string History::redo_name() const {
    return can_redo() ? change_name(states_[at_], states_[at_ + 1]) : "";
}

const Document& History::undo() {
    return states_[--at_];
}

const Document& History::redo() {
    return states_[++at_];
}

}  // namespace relevo::viewer
