#include "light/point/sectors.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace relevo::light {
namespace {

/// Runs of directions for which something holds, as first and last index; the last run may go on
/// through north.
std::vector<std::pair<std::size_t, std::size_t>> runs_of(const std::vector<bool>& holds) {
    const std::size_t n = holds.size();
    // From behind a direction for which it does not hold; n: it holds all round.
    const auto closed =
        static_cast<std::size_t>(std::find(holds.begin(), holds.end(), false) - holds.begin());
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    bool within = false;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = (closed + i) % n;
        if (holds[k] && !within) runs.emplace_back(k, k);
        within = holds[k];
        if (within) runs.back().second = k;
    }
    std::sort(runs.begin(), runs.end());
    return runs;
}

}  // namespace

std::vector<Sector> sectors_of(const std::vector<bool>& holds) {
    const auto azimuth_rad = [&](std::size_t i) {
        return 2 * kPi * double(i) / double(holds.size());
    };
    std::vector<Sector> sectors;
    for (const auto& [first, last] : runs_of(holds))
        sectors.push_back({azimuth_rad(first), azimuth_rad(last)});
    return sectors;
}

void OpenSector::include(const OpenSector& other) {
    reach_m = std::min(reach_m, other.reach_m);
    needed_m = std::max(needed_m, other.needed_m);
    least_m = std::min(least_m, other.least_m);
}

std::optional<OpenSector> open_beyond(const TerrainHorizon& horizon, const HorizonPoint& point,
                                      double highest_m, double over_rad, double until_m) {
    if (!(over_rad < kPi / 2)) return std::nullopt;
    const ApparentElevation elevation = horizon.towards(point.azimuth_rad);
    const double level = std::tan(over_rad);
    const auto highest_at_m = [&](double reach_m) {
        return std::min(elevation.farthest_rise_m(highest_m, std::max(reach_m, 1.0)), until_m);
    };
    const auto stands_over = [&](double reach_m) {
        return reach_m < until_m &&
               elevation.tangent(highest_m, highest_at_m(reach_m)) > level + 1e-9;
    };
    if (!stands_over(point.reach_m)) return std::nullopt;
    const double reach_m = horizon.edge_m(point);
    if (!stands_over(reach_m)) return std::nullopt;
    const double from_m = std::max(reach_m, 1.0);
    double low_m = highest_at_m(reach_m);
    double needed_m = std::min(TerrainHorizon::kFarthestSeen_m, until_m);
    while (needed_m - low_m > 1) {
        const double middle_m = (low_m + needed_m) / 2;
        (elevation.tangent(highest_m, middle_m) > level ? low_m : needed_m) = middle_m;
    }
    // A line of sight that goes down is lowest farther away.
    const double lowest_at_m = std::max(0.0, -level) / elevation.curvature();
    const double least_m =
        elevation.height_m(level, std::clamp(lowest_at_m, from_m, std::max(from_m, needed_m)));
    return OpenSector{{point.azimuth_rad, point.azimuth_rad}, reach_m, needed_m, least_m};
}

std::vector<OpenSector> open_sectors(const TerrainHorizon& horizon,
                                     const std::vector<HorizonPoint>& profile, double highest_m,
                                     const std::vector<double>& matters_rad) {
    const std::size_t n = profile.size();
    std::vector<std::optional<OpenSector>> all(n);
    std::vector<bool> is_open(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double horizon_rad = profile[i].elevation_rad;
        const double over_rad =
            matters_rad.empty() ? horizon_rad : std::max(horizon_rad, matters_rad[i]);
        all[i] = open_beyond(horizon, profile[i], highest_m, over_rad);
        is_open[i] = all[i].has_value();
    }
    std::vector<OpenSector> sectors;
    for (const auto& [first, last] : runs_of(is_open)) {
        OpenSector whole = *all[first];
        whole.to_azimuth_rad = profile[last].azimuth_rad;
        for (std::size_t i = first; i != last; i = (i + 1) % n)
            whole.include(*all[(i + 1) % n]);
        sectors.push_back(whole);
    }
    return sectors;
}

}  // namespace relevo::light
