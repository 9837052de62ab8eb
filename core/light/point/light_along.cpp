#include "light/point/light_along.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "light/point/ground_at.h"
#include "sun/observer.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr double kStep_s = 10;  // from sample to sample; the sun takes 0.04 degrees for it
constexpr double kMostSamples = 1'000'000;
constexpr double kSharp_s = 0.1, kSharp_m = 0.1;  // of a change of light
constexpr int kHalvings = 60;                     // as many as a double has room for
constexpr double kAirLevel_m = 100;  // between which refraction is linear, to 0.2 arcsec
// No horizon is lower: ground at 31 km over the deepest sea, under arcs that bend upwards by the
// Earth's own curvature, has it 9 degrees down.
constexpr double kLowestHorizon_rad = radians(-10);
constexpr int kRidgeDirections = 1440;  // of ridges that may lie beyond the DEM

/// A walk by samples, which may be fractions: `at(0)` is its beginning, `at(count())` its end. Time
/// and distance grow together, so that neither a rest nor a jump is passed over.
class Samples {
  public:
    /// @throws Error (BadInput) for more than kMostSamples
    Samples(const Walk& walk, double spacing_m) : walk_(walk), sample_{0} {
        for (std::size_t i = 1; i < walk.places().size(); ++i) {
            const double length_m = walk.distances_m()[i] - walk.distances_m()[i - 1];
            const double time_s = walk.times()[i] - walk.times()[i - 1];
            sample_.push_back(sample_.back() + std::max(length_m / spacing_m, time_s / kStep_s));
        }
        if (!(sample_.back() <= kMostSamples))
            bad_input(fmt::format(
                "walk: {:.1f} km in {:.1f} h need {:.3g} samples, expected at most {:.0f}; thin or "
                "split the track",
                walk.length_m() / 1000, walk.duration_s() / 3600, sample_.back(), kMostSamples));
        count_ = std::max(1, static_cast<int>(std::ceil(sample_.back())));
    }

    int count() const { return count_; }
    /// Of count() + 1 whole samples, as at() takes it.
    double whole(int i) const { return sample_.back() * i / count_; }

    WalkMoment at(double sample) const {
        const auto after = std::upper_bound(sample_.begin(), sample_.end(), sample);
        if (after == sample_.end()) return vertex(sample_.size() - 1);
        if (after == sample_.begin()) return vertex(0);
        const auto i = static_cast<std::size_t>(after - sample_.begin());
        const double share = (sample - sample_[i - 1]) / (sample_[i] - sample_[i - 1]);
        WalkMoment moment = vertex(i - 1);
        const double length_m = walk_.distances_m()[i] - moment.distance_m;
        moment.utc = moment.utc + share * (walk_.times()[i] - moment.utc);
        moment.distance_m += share * length_m;
        if (length_m > 0)
            moment.place = geo::destination(
                moment.place, geo::geodesic(moment.place, walk_.places()[i]).azimuth_rad,
                share * length_m);
        return moment;
    }

    /// A point of the track.
    WalkMoment vertex(std::size_t i) const {
        geo::Geodetic place = walk_.places()[i];
        place.height_m = 0;
        return {walk_.distances_m()[i], walk_.times()[i], place};
    }

    /// The whole samples and the track's points, which may lie outside, in the order of the way.
    std::vector<WalkMoment> with_corners() const {
        std::vector<WalkMoment> all;
        for (int i = 0; i <= count_; ++i)
            all.push_back(at(whole(i)));
        for (std::size_t i = 0; i < sample_.size(); ++i)
            all.push_back(vertex(i));
        std::stable_sort(all.begin(), all.end(), [](const WalkMoment& a, const WalkMoment& b) {
            return a.distance_m < b.distance_m;
        });
        return all;
    }

  private:
    const Walk& walk_;
    std::vector<double> sample_;  // of the track's points
    int count_ = 0;
};

/// How far a place lies beyond the edge of a grid; 0 on it.
double beyond_m(const dem::Grid& grid, const geo::Geodetic& place) {
    const glm::dvec2 post = grid.post(place);
    if (is_within(grid, post)) return 0;
    if (!std::isfinite(post.x) || !std::isfinite(post.y)) return kInfinity;
    const glm::dvec2 edge =
        glm::clamp(post, glm::dvec2(0), glm::dvec2(grid.columns() - 1, grid.rows() - 1));
    // On the edge of a wide cell the nearest post is not quite nearest on the ground.
    return std::max(1e-3, geo::geodesic(place, grid.place(edge.x, edge.y)).distance_m);
}

/// @throws Error (BadInput) where any moment, in the order of the way, is outside
void check_inside(const dem::Grid& grid, const std::vector<WalkMoment>& moments) {
    constexpr std::size_t kTold = 3;
    std::vector<std::pair<double, double>> parts_km;  // outside
    double farthest_m = 0;
    bool was_outside = false;
    for (const WalkMoment& moment : moments) {
        const double distance_m = beyond_m(grid, moment.place), km = moment.distance_m / 1000;
        const bool is_outside = distance_m > 0;
        farthest_m = std::max(farthest_m, distance_m);
        if (is_outside && !was_outside) parts_km.emplace_back(km, km);
        if (is_outside) parts_km.back().second = km;
        was_outside = is_outside;
    }
    if (parts_km.empty()) return;
    std::vector<std::string> parts;
    for (const auto& [from_km, to_km] : parts_km)
        if (parts.size() < kTold)
            parts.push_back(fmt::format("km {:.3f} to {:.3f}", from_km, to_km));
    bad_input(fmt::format(
        "walk: {}{} of {:.3f} km: outside of the DEM, {}; take a DEM that has all of the "
        "way, or cut the track",
        fmt::join(parts, ", "),
        parts_km.size() > kTold ? fmt::format(" and {} more parts", parts_km.size() - kTold) : "",
        moments.back().distance_m / 1000,
        std::isinf(farthest_m)
            ? "where its map ends"
            : fmt::format("up to {:.3g} km beyond its edge", farthest_m / 1000)));
}

/// The air over ground of any height along a walk, computed where it is asked for.
class Airs {
  public:
    Airs(const WalkOptions& options, const geo::Geodetic& place)
        : options_(options), place_(place) {}

    double apparent_rad(double height_m, double true_rad) {
        if (!options_.air) return true_rad;
        const double level = height_m / kAirLevel_m;
        const int below = static_cast<int>(std::floor(level));
        const double share = level - below;
        return (1 - share) * at_level(below).apparent_rad(true_rad) +
               share * at_level(below + 1).apparent_rad(true_rad);
    }

  private:
    const sun::Refraction& at_level(int level) {
        const std::lock_guard lock(mutex_);
        const auto known = levels_.find(level);
        if (known != levels_.end()) return known->second;
        geo::Geodetic over = place_;
        over.height_m = level * kAirLevel_m;
        return levels_.emplace(level, options_.air(over)).first->second;
    }

    const WalkOptions& options_;
    geo::Geodetic place_;
    std::mutex mutex_;
    std::map<int, sun::Refraction> levels_;
};

/// Finds the light at a moment of a walk.
class LightFinder {
  public:
    LightFinder(const dem::Posts& posts, const Walk& walk, const WalkOptions& options)
        : posts_(posts),
          horizon_(options.horizon),
          airs_(options, walk.places().front()),
          table_(walk.times().front(), walk.times().back()),
          highest_m_(highest_beyond_m(posts, options.highest_m)) {
        horizon_.few_directions = true;
    }

    WalkLight light(const WalkMoment& moment) {
        const glm::dvec2 last(posts_.grid().columns() - 1, posts_.grid().rows() - 1);
        const glm::dvec2 post = glm::clamp(posts_.grid().post(moment.place), glm::dvec2(0), last);
        geo::Geodetic ground = moment.place;
        const double height_m = posts_.height_at(post.x, post.y);
        ground.height_m = std::isnan(height_m) ? posts_.lowest_m() : height_m;
        const glm::dvec3 sun = table_.vector_au(moment.utc, sun::Observer(ground));
        const double true_rad = sun::elevation_of(sun);
        const double apparent_rad = airs_.apparent_rad(ground.height_m, true_rad);
        const WalkLight without = apparent_rad > 0 ? WalkLight::Terrain : WalkLight::Night;
        if (true_rad < kLowestHorizon_rad) return without;
        if (std::isnan(height_m)) return apparent_rad > 0 ? WalkLight::NotKnown : without;
        const TerrainHorizon horizon(posts_, moment.place, horizon_);
        const HorizonPoint point = horizon.at(sun::azimuth_of(sun));
        if (apparent_rad <= point.elevation_rad) return without;
        if (point.hole && apparent_rad <= point.hole_rad) return WalkLight::NotKnown;
        if (const auto open = open_beyond(horizon, point, highest_m_, apparent_rad)) add(*open);
        return WalkLight::Sun;
    }

    /// Of all moments that were asked for.
    Doubt doubt() const {
        Doubt doubt;
        doubt.matters = Matters::Sun;
        doubt.highest_m = highest_m_;
        for (const auto& [k, sector] : open_)
            doubt.open.push_back(sector);
        return doubt;
    }

  private:
    /// Keeps terrain beyond the DEM that could hide sun which is taken to shine.
    void add(OpenSector sector) {
        const int k = static_cast<int>(
            std::lround(sector.from_azimuth_rad / (2 * kPi) * kRidgeDirections) % kRidgeDirections);
        sector.from_azimuth_rad = sector.to_azimuth_rad = 2 * kPi * k / kRidgeDirections;
        const std::lock_guard lock(mutex_);
        open_.try_emplace(k, sector).first->second.include(sector);
    }

    const dem::Posts& posts_;
    HorizonOptions horizon_;
    Airs airs_;
    sun::PositionTable table_;
    double highest_m_;
    std::mutex mutex_;
    std::map<int, OpenSector> open_;  // by direction
};

struct Change {
    WalkMoment at;
    WalkLight to;
};

/// All changes of light between two samples of different light.
std::vector<Change> changes_between(const Samples& walk, LightFinder& finder, double from,
                                    WalkLight before, double to, WalkLight after) {
    std::vector<Change> changes;
    while (before != after) {
        double low = from, high = to;
        WalkLight next = after;
        for (int i = 0; i < kHalvings; ++i) {
            const WalkMoment a = walk.at(low), b = walk.at(high);
            if (b.utc - a.utc <= kSharp_s && b.distance_m - a.distance_m <= kSharp_m) break;
            const double middle = (low + high) / 2;
            const WalkLight there = finder.light(walk.at(middle));
            (there == before ? low : high) = middle;
            if (there != before) next = there;
        }
        changes.push_back({walk.at((low + high) / 2), next});
        before = next;
        from = high;
    }
    return changes;
}

void add_stretches(LightAlong& result, const WalkMoment& begin, WalkLight light,
                   const std::vector<std::vector<Change>>& changes, const WalkMoment& end) {
    WalkMoment from = begin;
    const auto close = [&](const WalkMoment& to) {
        result.stretches.push_back({light, from, to});
        WalkSum& sum = result.sums[static_cast<std::size_t>(light)];
        sum.time_s += to.utc - from.utc;
        sum.length_m += to.distance_m - from.distance_m;
        from = to;
    };
    for (const std::vector<Change>& between : changes)
        for (const Change& change : between) {
            close(change.at);
            light = change.to;
        }
    close(end);
}

std::string definition_of(const HorizonOptions& horizon, double spacing_m) {
    return fmt::format(
        "sun: its centre stands over the terrain horizon as seen from {}; terrain: behind it, over "
        "the level horizon; night: below it; sampled every {:.3g} m and {:.0f} s or closer, "
        "changes to {} s and {} m; distances on the map; terrestrial refraction k = {:.4g}",
        horizon.eye_height_m > 0 ? fmt::format("{:.4g} m above the ground", horizon.eye_height_m)
                                 : "the ground",
        spacing_m, kStep_s, kSharp_s, kSharp_m, horizon.refraction);
}

}  // namespace

std::string_view name_of(WalkLight light) {
    switch (light) {
        case WalkLight::Sun:
            return "sun";
        case WalkLight::Terrain:
            return "terrain";
        case WalkLight::Night:
            return "night";
        case WalkLight::NotKnown:
            return "not_known";
    }
    return {};
}

LightAlong light_along(const dem::Posts& given, const Walk& walk, const WalkOptions& options) {
    const std::optional<dem::Posts> unrolled = dem::Posts::around(given, walk.places().front());
    const dem::Posts& posts = unrolled ? *unrolled : given;
    const glm::dvec2 post_m = posts.grid().post_spacing_m();
    LightAlong result;
    result.spacing_m = std::min(post_m.x, post_m.y);
    result.step_s = kStep_s;
    result.length_m = walk.length_m();
    result.duration_s = walk.duration_s();
    result.definition = definition_of(options.horizon, result.spacing_m);
    const Samples samples(walk, result.spacing_m);
    check_inside(posts.grid(), samples.with_corners());
    LightFinder finder(posts, walk, options);
    const int count = samples.count();
    std::vector<WalkLight> lights(static_cast<std::size_t>(count) + 1);
    parallel_for(0, count + 1, 8, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            lights[static_cast<std::size_t>(i)] = finder.light(samples.at(samples.whole(i)));
    });
    std::vector<std::vector<Change>> changes(static_cast<std::size_t>(count));
    parallel_for(0, count, 8, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto k = static_cast<std::size_t>(i);
            changes[k] = changes_between(samples, finder, samples.whole(i), lights[k],
                                         samples.whole(i + 1), lights[k + 1]);
        }
    });
    add_stretches(result, samples.at(0), lights.front(), changes, samples.at(samples.whole(count)));
    result.doubt = finder.doubt();
    return result;
}

}  // namespace relevo::light
