#include "viewer/window_style.h"

#include "viewer/translation.h"

namespace relevo::viewer {

WindowStyle::WindowStyle(Window& window, const Settings& settings)
    : window_(window), applied_(settings) {
    window_.set_style(settings.light_style, settings.text_px);
}

bool WindowStyle::update(const State& state) {
    const Settings& now = state.settings;
    const bool has_new_glyphs = needs_glyphs(state);
    if (!has_new_glyphs && now.light_style == applied_.light_style &&
        now.text_px == applied_.text_px)
        return false;
    applied_ = now;
    window_.set_style(now.light_style, now.text_px);
    return true;
}

bool WindowStyle::needs_glyphs(const State& state) {
    bool any = window_.want_letters(state.message);
    any = window_.want_letters(take_new_translations()) || any;
    const auto want = [&](const std::string& text) { any = window_.want_letters(text) || any; };
    for (const std::string& dem : state.document.scene.dems)
        want(dem);
    want(state.found_names);
    if (state.document.scene.overlay) want(state.document.scene.overlay->file);
    for (const RecentDem& dem : state.recent)
        want(dem.files.front());
    for (const SavedView& view : state.views)
        want(view.name);
    if (!state.effects || effects_ == state.effects.get()) return any;
    effects_ = state.effects.get();
    for (const effect::Effect& effect : effects_->registry.effects()) {
        want(effect.manifest.name + effect.manifest.description);
        for (const shader::Param& param : effect.params()) {
            want(param.label + param.description + param.unit);
            for (const std::string& word : param.words)
                want(word);
        }
    }
    return any;
}

}  // namespace relevo::viewer
