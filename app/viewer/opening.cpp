#include "viewer/opening.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "base/text.h"
#include "effect/search_path.h"
#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {

Opening::Opening(scene::Scene scene, const SceneDevice& device, Messages& messages,
                 Discard& discard)
    : device_(device), messages_(messages), discard_(discard) {
    requested_file_ = scene.dems.front();
    begin(std::move(scene), /*is_reload=*/false);
}

void Opening::open(scene::Scene scene, const Wanted& first) {
    requested_file_ = scene.dems.front();
    went_back_ = false;
    begin(std::move(scene), /*is_reload=*/false);
    next_->thread->want(first);
}

void Opening::reload(scene::Scene scene, const Wanted& first) {
    begin(std::move(scene), /*is_reload=*/true);
    next_->thread->want(first);
}

void Opening::go_back(const Wanted& first) {
    begin(*complete_, /*is_reload=*/false);
    went_back_ = true;
    next_->thread->want(first);
}

void Opening::cancel() {
    messages_.note(tr_format("opening {} was cancelled", printable(next_->scene.dems.front())));
    discard_.take(std::move(next_->thread));
    next_.reset();
}

void Opening::begin(scene::Scene scene, bool is_reload) {
    if (next_) discard_.take(std::move(next_->thread));
    failure_.reset();
    first_error_ = nullptr;
    auto thread = std::make_unique<SceneThread>(scene, device_, &Window::wake);
    next_ = Attempt{std::move(scene), std::move(thread), is_reload};
}

Opening::Event Opening::poll() {
    if (is_opening())
        if (const Event event = poll_next(); event != Event::None) return event;
    return opened_ && !is_broken_ ? poll_open() : Event::None;
}

Opening::Event Opening::poll_next() {
    try {
        next_->thread->check();
    } catch (const gl::DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        if (!opened_) first_error_ = std::current_exception();
        fail(error.what());
        return Event::Failed;
    }
    std::shared_ptr<const Opened> opened = next_->thread->opened();
    if (!opened) return Event::None;
    return accept(std::move(opened));
}

void Opening::fail(std::string reason) {
    messages_.show(reason);
    failure_ = Failure{next_->scene, std::move(reason)};
    if (!opened_) return;  // thread() stays
    discard_.take(std::move(next_->thread));
    next_.reset();
}

Opening::Event Opening::poll_open() {
    try {
        open_.thread->check();
    } catch (const gl::DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        if (!complete_ && !next_) throw;
        is_broken_ = true;
        messages_.show(error.what());
        return next_ || went_back_ ? Event::None : Event::Broken;
    }
    std::shared_ptr<const Opened> opened = open_.thread->opened();
    if (opened == opened_) return Event::None;
    const bool was_preview = is_preview();
    opened_ = std::move(opened);
    if (was_preview && !is_preview() && !open_.is_reload) home_view_ = opened_->scene.view;
    if (!is_preview()) complete_ = open_.scene;
    return Event::Changed;
}

Opening::Event Opening::accept(std::shared_ptr<const Opened> opened) {
    if (!next_->is_reload) home_view_ = opened->scene.view;
    discard_.take(std::move(open_.thread));
    open_ = *std::exchange(next_, std::nullopt);
    opened_ = std::move(opened);
    is_broken_ = false;
    if (!is_preview()) complete_ = open_.scene;
    watch_files();
    return open_.is_reload ? Event::Reloaded : Event::Opened;
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
