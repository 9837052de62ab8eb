#include "viewer/opening.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "base/text.h"
#include "effect/search_path.h"
#include "viewer/window.h"

namespace relevo::viewer {

Opening::Opening(scene::Scene scene, const SceneDevice& device, Messages& messages,
                 Discard& discard)
    : device_(device), messages_(messages), discard_(discard) {
    begin(std::move(scene));
}

void Opening::open(scene::Scene scene) {
    attempt_ = Attempt::Requested;
    is_reload_ = false;
    requested_file_ = scene.dems.front();
    begin(std::move(scene));
}

void Opening::reload(scene::Scene scene) {
    attempt_ = Attempt::Requested;
    is_reload_ = true;
    begin(std::move(scene));
}

void Opening::cancel() {
    go_back("opening " + printable(scene_.dems.front()) + " was cancelled");
}

Opening::Event Opening::poll() {
    if (has_failed()) return Event::None;
    try {
        thread_->check();
    } catch (const gl::DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        if (is_preview()) last_good_ = last_good_before_;  // this DEM cannot be read completely
        if (!last_good_) throw;
        return go_back(error.what());
    }
    std::shared_ptr<const Opened> opened = thread_->opened();
    if (!opened || opened == opened_) return Event::None;
    if (opened_) {
        opened_ = std::move(opened);
        return Event::Completed;
    }
    accept(std::move(opened));
    return Event::Opened;
}

void Opening::begin(scene::Scene scene) {
    scene_ = std::move(scene);
    opened_ = nullptr;
    discard_.take(std::move(thread_));
    thread_ = std::make_unique<SceneThread>(scene_, device_, &Window::wake);
}

Opening::Event Opening::go_back(std::string reason) {
    messages_.show(std::move(reason));
    if (attempt_ == Attempt::Fallback) {
        attempt_ = Attempt::Failed;
        return Event::Failed;
    }
    attempt_ = Attempt::Fallback;
    // A DEM that is reloaded keeps the current view.
    is_reload_ = is_reload_ && scene_.dems == last_good_->dems;
    scene::Scene scene = *last_good_;
    if (is_reload_) scene.view = scene_.view;
    begin(std::move(scene));
    return Event::WentBack;
}

void Opening::accept(std::shared_ptr<const Opened> opened) {
    opened_ = std::move(opened);
    if (!std::exchange(is_reload_, false)) home_view_ = opened_->scene.view;
    const bool is_fallback = attempt_ == Attempt::Fallback;
    last_good_before_ = is_fallback ? std::nullopt : last_good_;
    last_good_ = scene_;
    if (!is_fallback) requested_file_ = scene_.dems.front();
    attempt_ = Attempt::Requested;
    watch_files();
}

void Opening::watch_files() {
    const scene::Scene& scene = opened_->scene;
    std::vector<std::filesystem::path> dems;
    std::error_code ignored;
    for (const std::string& dem : scene.dems)
        if (std::filesystem::is_regular_file(dem, ignored)) dems.emplace_back(dem);
    dem_files_.watch(std::move(dems));
    const std::vector<std::string>& extra = scene.effects.plugin_path;
    // Images in a plugin's folder are not watched: saving one does not reload the effects.
    effect_files_.watch(effect::plugin_search_path({extra.begin(), extra.end()}),
                        {".json", ".glsl", ".so"});
}

}  // namespace relevo::viewer
