#include "scene/stereo.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::scene {

glm::ivec2 view_px(const Scene& scene) {
    const int columns = is_side_by_side(scene.view.stereo) ? 2 : 1;
    return {std::max(scene.width_px / columns, 1), scene.height_px};
}

double view_aspect(const Scene& scene) {
    const glm::ivec2 size = view_px(scene);
    return static_cast<double>(size.x) / size.y;
}

void check_stereo(const Scene& scene) {
    if (scene.view.stereo == Stereo::None) return;
    if (scene.view.panorama != Panorama::None)
        bad_input("--stereo: not of a panorama; remove --panorama or --stereo");
    if (scene.ortho) bad_input("--stereo: not of a map; remove --ortho or --stereo");
    if (scene.stamps.margin)
        bad_input("--stereo: has no border for stamps; remove --margin or --stereo");
    if (is_side_by_side(scene.view.stereo) && scene.width_px % 2 != 0)
        bad_input(
            fmt::format("--stereo: two pictures side by side need an even width but got {} x {} px",
                        scene.width_px, scene.height_px));
}

StereoPair stereo_pair(double eye_distance_m, std::span<const float> depths_m) {
    constexpr double kNearer = 0.02, kShare = 1.0 / 30, kWithoutGround_m = 1000;
    std::vector<float> ground_m;
    std::ranges::copy_if(depths_m, std::back_inserter(ground_m),
                         [](float depth_m) { return std::isfinite(depth_m); });
    StereoPair pair{.eye_distance_m = eye_distance_m, .window_m = kWithoutGround_m};
    if (!ground_m.empty()) {
        const auto near = ground_m.begin() + static_cast<std::ptrdiff_t>(
                                                 kNearer * static_cast<double>(ground_m.size()));
        std::ranges::nth_element(ground_m, near);
        pair.window_m = *near;
    }
    if (pair.eye_distance_m <= 0) pair.eye_distance_m = kShare * pair.window_m;
    return pair;
}

}  // namespace relevo::scene
