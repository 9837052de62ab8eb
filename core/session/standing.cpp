#include "session/standing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"

namespace relevo::session {
namespace {

/// Height on the drawn triangles at (column, row). Next to voids, the mean of the cell's posts if
/// the nearest one has a height: ground is cut half-way to a void. Else NaN.
double on_drawn_triangles_m(const Array2d<float>& height_m, glm::dvec2 post) {
    const int columns = height_m.width(), rows = height_m.height();
    if (!(post.x >= 0 && post.y >= 0 && post.x <= columns - 1 && post.y <= rows - 1)) return kNaN;
    const int c = std::clamp(static_cast<int>(post.x), 0, std::max(columns - 2, 0));
    const int r = std::clamp(static_cast<int>(post.y), 0, std::max(rows - 2, 0));
    const int right = std::min(c + 1, columns - 1), below = std::min(r + 1, rows - 1);
    const auto u = static_cast<float>(post.x - c), v = static_cast<float>(post.y - r);
    const std::array<float, 4> corners = {height_m.at(c, r), height_m.at(right, r),
                                          height_m.at(c, below), height_m.at(right, below)};
    const float drawn_m = dem::on_triangles(corners[0], corners[1], corners[2], corners[3], u, v);
    if (!std::isnan(drawn_m)) return drawn_m;
    const float nearest_m = corners[(u > 0.5f ? 1U : 0U) + (v > 0.5f ? 2U : 0U)];
    if (std::isnan(nearest_m)) return kNaN;
    double sum = 0;
    int valid = 0;
    for (const float corner_m : corners) {
        if (std::isnan(corner_m)) continue;
        sum += corner_m;
        ++valid;
    }
    return sum / valid;
}

}  // namespace

scene::GroundHeight heights_to_aim_at(std::shared_ptr<const LoadedDem> dem,
                                      const render::Displacement& displacement) {
    return [dem = std::move(dem), levels_m = displacement.to_m](const geo::Geodetic& at) {
        const dem::Heightfield& drawn = dem->to_draw();
        // Height 0: an eye's height may be outside the range of the DEM's CRS.
        const glm::dvec2 post = drawn.grid.post({at.lat_rad, at.lon_rad, 0});
        double height_m = on_drawn_triangles_m(drawn.height_m, post);
        const Array2d<dem::WaterKind>& water = dem->drawn.water.kind;
        if (std::isnan(height_m) || levels_m.empty() || water.empty()) return height_m;
        const dem::WaterKind kind =
            water.at(static_cast<int>(std::lround(post.x)), static_cast<int>(std::lround(post.y)));
        if (kind == dem::WaterKind::None || kind == dem::WaterKind::Lake) return height_m;
        for (const double level_m : levels_m)
            height_m = std::max(height_m, level_m);
        return height_m;
    };
}

void check_eye_height(const scene::View& view, const std::string& dem) {
    if (!view.eye) return;
    const double height_m = view.eye->place.height_m;
    if (!(height_m >= kDeepestEye_m && height_m <= kFarthestEye_m))
        bad_input(fmt::format("{}: --eye: a height of {:g} m, expected {:g} to {:g} m", dem,
                              height_m, kDeepestEye_m, kFarthestEye_m));
}

scene::Camera standing(const scene::View& view, const DrawnGround& ground,
                       std::optional<double> keep_above_m) {
    scene::Camera camera = ground.camera(view);
    const bool above_ground = view.eye && view.eye->above_ground;
    if (!view.eye) keep_above_m = scene::kClearance_m;
    if (!above_ground && !keep_above_m) return camera;
    // Iterates, because the ground's level of detail depends on the eye's height.
    constexpr int kRounds = 12;
    constexpr double kClose_m = 0.01;
    for (int round = 0; round < kRounds; ++round) {
        const std::optional<double> ground_m = ground.height_m(camera);
        if (!ground_m) return camera;
        geo::Geodetic eye = ground.frame.to_geodetic(camera.eye_m);
        const double wanted_m = above_ground ? *ground_m + view.eye->place.height_m
                                             : std::max(eye.height_m, *ground_m + *keep_above_m);
        if (std::abs(wanted_m - eye.height_m) < kClose_m) return camera;
        eye.height_m = wanted_m;
        if (!view.eye) {
            camera.eye_m = ground.frame.to_local(eye);
            continue;
        }
        // The direction to an aimed-at place changes with the eye.
        scene::View raised = view;
        eye.height_m /= ground.exaggeration;
        raised.eye = scene::Standpoint{eye, /*above_ground=*/false};
        camera = ground.camera(raised);
    }
    return camera;
}

}  // namespace relevo::session
