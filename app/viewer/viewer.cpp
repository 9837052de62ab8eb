#include "viewer/viewer.h"

#include <chrono>

#include <fmt/format.h>

#include "base/log.h"
#include "base/paths.h"
#include "viewer/main_window.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// A device that is lost again so soon after a window has shown its first picture will be lost by
/// the same scene for ever.
constexpr auto kLostAgain = std::chrono::seconds(5);

}  // namespace

void run(const scene::Scene& scene, const std::string& device) {
    use_language(share_dir() / "locale");
    scene::Scene current = scene;
    while (true) {
        MainWindow window(current, device);
        try {
            window.run();
            return;
        } catch (const gl::DeviceLost& lost) {
            if (window.shown_for() < kLostAgain) throw;
            log::warning(
                fmt::format("{}; the window begins again with the same scene", lost.what()));
            current = window.scene();
            current.time.zone = scene.time.zone;
        }
    }
}

}  // namespace relevo::viewer
