#include "viewer/viewer.h"

#include <chrono>

#include <fmt/format.h>

#include "base/log.h"
#include "viewer/main_window.h"

namespace relevo::viewer {
namespace {

/// A device that is lost again so soon after will be lost by the same scene for ever.
constexpr auto kLostAgain = std::chrono::seconds(5);

}  // namespace

void run(const scene::Scene& scene, const std::string& device) {
    scene::Scene current = scene;
    while (true) {
        const auto began = std::chrono::steady_clock::now();
        MainWindow window(current, device);
        try {
            window.run();
            return;
        } catch (const gl::DeviceLost& lost) {
            if (std::chrono::steady_clock::now() - began < kLostAgain) throw;
            log::warning(
                fmt::format("{}; the window begins again with the same scene", lost.what()));
            current = window.scene();
        }
    }
}

}  // namespace relevo::viewer
