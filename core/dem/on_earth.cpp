#include "dem/on_earth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "dem/interpret.h"

namespace relevo::dem {

void cut_to_earth(const Grid& grid, Array2d<float>& height_m) {
    constexpr int kAtOnce = 1 << 14;  // of a row
    parallel_for(0, grid.rows(), std::max(1, kAtOnce / grid.columns()), [&](int first, int last) {
        std::vector<glm::dvec2> posts;
        std::vector<geo::Geodetic> places;
        for (int row = first; row < last; ++row)
            for (int begin = 0; begin < grid.columns();) {
                const int count = std::min(kAtOnce, grid.columns() - begin);
                posts.resize(static_cast<std::size_t>(count));
                places.resize(posts.size());
                for (int i = 0; i < count; ++i)
                    posts[static_cast<std::size_t>(i)] = {double(begin) + i, row};
                grid.place(posts, places);
                for (int i = 0; i < count; ++i)
                    if (!std::isfinite(places[static_cast<std::size_t>(i)].lat_rad))
                        height_m.at(begin + i, row) = std::numeric_limits<float>::quiet_NaN();
                begin += count;
            }
    });
}

void settle_earth(const Grid& grid, Description& about, bool& leaves_earth) {
    constexpr const char* kRemedy =
        "pass the right one with --crs EPSG:n, or bring it to degrees with gdalwarp -t_srs "
        "EPSG:4326";
    const double share = grid.share_on_earth();
    leaves_earth = share < 1;
    if (share == 0)
        refuse(about.path, fmt::format("none of its posts is on the Earth in {}; {}",
                                       grid.crs().name(), kRemedy));
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    if (!std::isfinite(spacing_m.x + spacing_m.y))
        refuse(about.path,
               fmt::format("cells so large that the centre has no neighbour on the Earth in {}; {}",
                           grid.crs().name(), kRemedy));
    if (!(spacing_m.x > 0 && spacing_m.y > 0))
        refuse(about.path, "cells so small that neighbouring posts are at the same place");
    if (!leaves_earth) return;
    about.holes_by.emplace_back("earth");
    guess(about, fmt::format("some of its posts are not on the Earth in {} and are voids",
                             grid.crs().name()));
}

}  // namespace relevo::dem
