#include "viewer/comparison.h"

#include <fmt/format.h>

#include "viewer/translation.h"

namespace relevo::viewer {

Comparison::Comparison(const SceneDevice& device, Window& window, Messages& messages,
                       Discard& discard)
    : device_(device), window_(window), messages_(messages), discard_(discard) {}

void Comparison::start(const scene::Scene& scene, const Opened& opened, const Wanted& wanted) {
    thread_ = std::make_unique<SceneThread>(scene, device_, &Window::wake, opened.dem);
    effects_ = scene.effects;
    effects_read_ = wanted.effects_read;
    want(wanted);
}

void Comparison::want(Wanted wanted) {
    wanted.scene->effects = effects_;
    wanted.effects_read = effects_read_;
    thread_->want(wanted);
}

void Comparison::stop() {
    discard_.take(std::move(thread_));
    image_ = nullptr;
    window_.take_before(nullptr);
}

bool Comparison::poll() {
    if (!thread_) return false;
    try {
        thread_->check();
    } catch (const gl::DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        messages_.show(tr_format("no comparison: {}", error.what()));
        stop();
        return false;
    }
    if (auto message = thread_->take_message()) messages_.show(std::move(*message));
    const auto newer = thread_->newer_than(image_ ? image_->number : 0);
    if (!newer) return false;
    image_ = newer;
    window_.take_before(newer.get());
    return true;
}

}  // namespace relevo::viewer
