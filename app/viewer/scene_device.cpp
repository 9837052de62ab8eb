#include "viewer/scene_device.h"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"

namespace relevo::viewer {

Presentation presentation_of_environment() {
    const char* const given = std::getenv("RELEVO_PRESENT");
    const std::string_view word = given ? given : "";
    if (word.empty() || word == "auto") return Presentation::Auto;
    if (word == "shared") return Presentation::Shared;
    if (word == "copy") return Presentation::Copy;
    bad_usage(fmt::format("view: RELEVO_PRESENT: expected shared, copy or auto but got \"{}\"",
                          printable(std::string(word))));
}

struct SceneDevice::State {
    std::string device;
    Presentation presentation = Presentation::Copy;
    std::mutex mutex;
    std::condition_variable known;
    bool is_known = false;
    const gl::Context* window = nullptr;

    void set(const gl::Context* context) {
        {
            const std::lock_guard lock(mutex);
            is_known = true;
            window = context;
        }
        known.notify_all();
    }

    /// Null if the window does not open.
    const gl::Context* wait_for_window() {
        std::unique_lock lock(mutex);
        known.wait(lock, [&] { return is_known; });
        return window;
    }

    gl::Context own() const { return gl::Context(gl::ContextOptions{.device = device}); }
    bool names_device() const { return !device.empty() && device != "auto"; }
};

SceneDevice::SceneDevice(std::string device, Presentation presentation)
    : state_(std::make_shared<State>()) {
    state_->device = std::move(device);
    state_->presentation = presentation;
}

void SceneDevice::set_window(const gl::Context& window) const {
    state_->set(&window);
}

void SceneDevice::give_up() const {
    state_->set(nullptr);
}

namespace {

bool has_hardware() {
    return std::ranges::any_of(gl::list_devices(), [](const gl::Device& device) {
        return device.platform == "device" && !device.software;
    });
}

}  // namespace

SceneDevice::Opened SceneDevice::open() const {
    const State& asked = *state_;
    const bool must = asked.presentation == Presentation::Shared;
    if (asked.presentation == Presentation::Copy || (!must && !has_hardware()))
        return {asked.own(), false};
    const gl::Context* const window = state_->wait_for_window();
    if (!window) return {asked.own(), false};
    if (!must && window->info().device.software) return {asked.own(), false};
    if (asked.names_device()) {
        gl::Context own = asked.own();
        if (!own.is_on_device_of(*window)) {
            if (must)
                throw Error(
                    ErrorCode::NoDevice,
                    fmt::format("view: RELEVO_PRESENT=shared: the window is on {}, and "
                                "--device {} is {}; use RELEVO_PRESENT=copy",
                                window->info().renderer, asked.device, own.info().renderer));
            return {std::move(own), false};
        }
    }
    try {
        return {gl::Context::sharing(*window), true};
    } catch (const Error& error) {
        if (must) throw;
        log::debug(error.what());
        return {asked.own(), false};
    }
}

}  // namespace relevo::viewer
