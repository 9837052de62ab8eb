#include "viewer/viewer.h"

#include "viewer/main_window.h"

namespace relevo::viewer {

void run(const scene::Scene& scene, const std::string& device) {
    MainWindow(scene, device).run();
}

}  // namespace relevo::viewer
