#include "chart/skyline_names.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace relevo::chart {

std::vector<SkylineName> names_on_skyline(const light::TerrainHorizon& horizon,
                                          const names::Gazetteer& gazetteer) {
    constexpr double kNearest_m = 500, kFarthest_m = 200e3;
    constexpr double kBelow_rad = radians(0.1);  // the skyline of a broad top is before it
    const dem::Posts& posts = horizon.posts();
    const dem::Grid& grid = posts.grid();
    std::vector<SkylineName> found;
    const names::PostHeight height_m = [&](int column, int row) {
        return posts.height_at(column, row);
    };
    for (const names::Summit& summit :
         names::summits_on(gazetteer, grid, height_m, {horizon.place(), kFarthest_m})) {
        const glm::dvec2 post = grid.post(summit.place);
        geo::Geodetic top = summit.place;
        top.height_m = posts.height_at(post.x, post.y);
        if (std::isnan(top.height_m)) continue;
        const light::Sight sight = horizon.sight(top);
        if (!sight.visible || sight.distance_m < kNearest_m || sight.distance_m > kFarthest_m)
            continue;
        const double skyline_rad = horizon.elevation_rad(sight.azimuth_rad);
        if (skyline_rad - sight.elevation_rad > kBelow_rad) continue;
        found.push_back({sight.azimuth_rad, skyline_rad, top.height_m, label(summit)});
    }
    std::ranges::stable_sort(found, std::ranges::greater(), &SkylineName::ground_m);
    return found;
}

}  // namespace relevo::chart
