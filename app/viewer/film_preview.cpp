#include "viewer/film_preview.h"

#include <algorithm>
#include <utility>

// The preview shows shots of the job that the film is made from. Rejected: camera and sun from
// formulas of the window, which would differ from the file; and a thread that draws frames ahead,
// which would queue them.
namespace relevo::viewer {
namespace {

/// What a parameter is set to last; empty: nothing.
std::string text_of(const scene::Effects& effects, const std::string& address) {
    std::string text;
    for (const effect::Setting& setting : effects.settings)
        if (setting.address == address) text = setting.text;
    return text;
}

}  // namespace

void FilmPreview::show(const scene::Shot& frame, const Pose& pose, const std::string& value) {
    Document& document = state_.document;
    document.scene = frame.scene;
    document.pose = pose;
    // An overlay that is in no file is not in the film.
    document.overlay = {};
    if (frame.scene.overlay) document.overlay = choice_of(*frame.scene.overlay);
    state_.set_utc(frame.utc);
    document.utc = frame.utc;  // also beyond the years of the calendar
    const std::string text = value.empty() ? "" : text_of(frame.scene.effects, value);
    if (text != text_ && !text.empty()) state_.new_values.emplace_back(value, text);
    value_ = value;
    text_ = text;
}

void FilmPreview::end() {
    if (!before_) return;
    const bool changed_value = !std::exchange(text_, {}).empty();
    state_.document = *std::exchange(before_, std::nullopt);
    state_.set_utc(state_.document.utc);
    if (!changed_value) return;
    std::erase_if(state_.new_values, [&](const auto& one) { return one.first == value_; });
    state_.new_effects = state_.document.scene.effects;
}

}  // namespace relevo::viewer
