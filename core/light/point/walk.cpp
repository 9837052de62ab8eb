#include "light/point/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "sun/observer.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep_s = 10;  // from look to look; the sun takes 0.04 degrees for it
constexpr double kMostLooks = 1'000'000;
constexpr double kSharp_s = 0.1, kSharp_m = 0.1;  // of a change of light
constexpr int kHalvings = 60;                     // as many as a double has room for
constexpr double kAirLevel_m = 100;   // between which refraction is linear, to 0.2 arcsec
constexpr double kEdge_posts = 1e-3;  // as TerrainHorizon has it
// No horizon is lower: ground at 31 km over the deepest sea, under arcs that bend upwards by the
// Earth's own curvature, has it 9 degrees down.
constexpr double kLowestHorizon_rad = radians(-10);
constexpr int kDirections = 1440;  // of ridges that may lie beyond the DEM

}  // namespace

Walk::Walk(std::vector<geo::Geodetic> places) : places_(std::move(places)) {
    if (places_.size() < 2)
        bad_input(fmt::format("walk: {} point{}: too few, expected two or more", places_.size(),
                              places_.size() == 1 ? "" : "s"));
    distance_m_.push_back(0);
    for (std::size_t i = 1; i < places_.size(); ++i)
        distance_m_.push_back(distance_m_.back() +
                              geo::geodesic(places_[i - 1], places_[i]).distance_m);
}

void Walk::check_duration() const {
    if (duration_s() > kLongest_s)
        bad_input(fmt::format(
            "walk: {:.1f} km take {:.1f} days, expected at most {:.0f}; walk faster, or cut "
            "the track up",
            length_m() / 1000, duration_s() / 86400, kLongest_s / 86400));
}

Walk Walk::at_speed(std::vector<geo::Geodetic> places, sun::Instant start, double speed_m_s) {
    Walk walk(std::move(places));
    if (!(speed_m_s > 0) || std::isinf(speed_m_s))
        bad_input(fmt::format("walk: a speed of {:.10g} m/s, expected one above 0", speed_m_s));
    if (!(walk.length_m() > 0))
        bad_input("walk: all points are at the same place, expected a track with a length");
    if (!(walk.length_m() / speed_m_s <= 1e9))  // beyond it an instant may not hold it
        bad_input(fmt::format("walk: {:.1f} km at {:.3g} km/h take too long",
                              walk.length_m() / 1000, speed_m_s * 3.6));
    for (const double distance_m : walk.distance_m_)
        walk.utc_.push_back(start + distance_m / speed_m_s);
    walk.check_duration();
    return walk;
}

Walk Walk::timed(std::vector<geo::Geodetic> places, std::vector<sun::Instant> times) {
    Walk walk(std::move(places));
    walk.utc_ = std::move(times);
    for (std::size_t i = 1; i < walk.utc_.size(); ++i)
        if (walk.utc_[i] < walk.utc_[i - 1])
            bad_input(
                fmt::format("walk: point {}: its time, {}, is before that of the "
                            "point before, {}; expected times in order",
                            i + 1, sun::to_iso(walk.utc_[i]), sun::to_iso(walk.utc_[i - 1])));
    if (!(walk.duration_s() > 0))
        bad_input("walk: all points have the same time, expected times that increase");
    walk.check_duration();
    return walk;
}

Walk Walk::starting_at(sun::Instant start) const {
    Walk walk = *this;
    for (std::size_t i = 0; i < walk.utc_.size(); ++i)
        walk.utc_[i] = start + (utc_[i] - utc_.front());
    return walk;
}

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

namespace {

/// A walk by how often it is to be looked at: `at(0)` its beginning, `at(looks())` its end. Time
/// and distance grow together, so that neither a rest nor a jump is passed over.
class Way {
  public:
    Way(const Walk& walk, double spacing_m) : walk_(walk) {
        looks_.push_back(0);
        for (std::size_t i = 1; i < walk.places().size(); ++i) {
            const double length_m = walk.distances_m()[i] - walk.distances_m()[i - 1];
            const double time_s = walk.times()[i] - walk.times()[i - 1];
            looks_.push_back(looks_.back() + std::max(length_m / spacing_m, time_s / kStep_s));
        }
    }
    double looks() const { return looks_.back(); }

    WalkMoment at(double look) const {
        const auto after = std::upper_bound(looks_.begin(), looks_.end(), look);
        if (after == looks_.end()) return vertex(looks_.size() - 1);
        if (after == looks_.begin()) return vertex(0);
        const auto i = static_cast<std::size_t>(after - looks_.begin());
        const double share = (look - looks_[i - 1]) / (looks_[i] - looks_[i - 1]);
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

    WalkMoment vertex(std::size_t i) const {
        geo::Geodetic place = walk_.places()[i];
        place.height_m = 0;
        return {walk_.distances_m()[i], walk_.times()[i], place};
    }

  private:
    const Walk& walk_;
    std::vector<double> looks_;
};

/// How far a place lies beyond the edge of a grid; 0 on it.
double beyond_m(const dem::Grid& grid, const geo::Geodetic& place) {
    const glm::dvec2 post = grid.post(place);
    const glm::dvec2 last(grid.columns() - 1, grid.rows() - 1);
    if (post.x >= -kEdge_posts && post.y >= -kEdge_posts && post.x <= last.x + kEdge_posts &&
        post.y <= last.y + kEdge_posts)
        return 0;
    if (!std::isfinite(post.x) || !std::isfinite(post.y)) return kInfinity;
    const glm::dvec2 edge = glm::clamp(post, glm::dvec2(0), last);
    // On the edge of a wide cell the nearest post is not nearest on the ground by a hair.
    return std::max(1e-3, geo::geodesic(place, grid.place(edge.x, edge.y)).distance_m);
}

/// @throws Error (BadInput) where any moment, in the order of the way, is outside
void check_inside(const dem::Grid& grid, const std::vector<WalkMoment>& moments) {
    std::vector<double> beyond(moments.size());
    parallel_for(0, static_cast<int>(moments.size()), 256, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto k = static_cast<std::size_t>(i);
            beyond[k] = beyond_m(grid, moments[k].place);
        }
    });
    constexpr std::size_t kTold = 3;
    std::vector<std::string> parts;
    std::size_t count = 0;
    double farthest_m = 0, outside_from_m = 0;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        farthest_m = std::max(farthest_m, beyond[i]);
        if (beyond[i] > 0 && (i == 0 || beyond[i - 1] == 0)) outside_from_m = moments[i].distance_m;
        if (beyond[i] > 0 && (i + 1 == moments.size() || beyond[i + 1] == 0) && ++count <= kTold)
            parts.push_back(fmt::format("km {:.3f} to {:.3f}", outside_from_m / 1000,
                                        moments[i].distance_m / 1000));
    }
    if (count == 0) return;
    bad_input(fmt::format(
        "walk: {}{} of {:.3f} km: outside of the DEM, {}; take a DEM that has all of the "
        "way, or cut the track",
        fmt::join(parts, ", "),
        count > kTold ? fmt::format(" and {} more parts", count - kTold) : "",
        moments.back().distance_m / 1000,
        std::isinf(farthest_m)
            ? "where its map ends"
            : fmt::format("up to {:.3g} km beyond its edge", farthest_m / 1000)));
}

/// The air over ground of any height along a walk.
class Airs {
  public:
    Airs(const WalkOptions& options, geo::Geodetic place, double lowest_m, double highest_m) {
        if (!options.air) return;
        first_ = static_cast<int>(std::floor(lowest_m / kAirLevel_m));
        const int last = static_cast<int>(std::floor(highest_m / kAirLevel_m)) + 1;
        levels_.resize(static_cast<std::size_t>(last - first_ + 1), sun::Refraction::none());
        parallel_for(0, static_cast<int>(levels_.size()), 1, [&](int begin, int end) {
            geo::Geodetic over = place;
            for (int i = begin; i < end; ++i) {
                over.height_m = (first_ + i) * kAirLevel_m;
                levels_[static_cast<std::size_t>(i)] = options.air(over);
            }
        });
    }

    double apparent_rad(double height_m, double true_rad) const {
        if (levels_.empty()) return true_rad;
        const double level = height_m / kAirLevel_m - first_;
        const auto below =
            static_cast<std::size_t>(std::clamp(level, 0.0, double(levels_.size() - 2)));
        const double share = level - static_cast<double>(below);
        return (1 - share) * levels_[below].apparent_rad(true_rad) +
               share * levels_[below + 1].apparent_rad(true_rad);
    }

  private:
    int first_ = 0;
    std::vector<sun::Refraction> levels_;
};

/// Ridges beyond the DEM that could hide sun which is taken to shine, by direction.
class OpenDirections {
  public:
    void add(const OpenSector& sector) {
        const int k = static_cast<int>(
            std::lround(sector.from_azimuth_rad / (2 * kPi) * kDirections) % kDirections);
        const std::lock_guard lock(mutex_);
        const auto [it, is_new] = sectors_.try_emplace(k, sector);
        OpenSector& all = it->second;
        all.from_azimuth_rad = all.to_azimuth_rad = 2 * kPi * k / kDirections;
        if (is_new) return;
        all.reach_m = std::min(all.reach_m, sector.reach_m);
        all.needed_m = std::max(all.needed_m, sector.needed_m);
        all.least_m = std::min(all.least_m, sector.least_m);
    }
    std::vector<OpenSector> sectors() const {
        std::vector<OpenSector> all;
        for (const auto& [k, sector] : sectors_)
            all.push_back(sector);
        return all;
    }

  private:
    std::mutex mutex_;
    std::map<int, OpenSector> sectors_;
};

/// The horizon of the place that was looked from last: who rests looks from there again.
struct LatestHorizon {
    geo::Geodetic place;
    std::unique_ptr<const TerrainHorizon> horizon;
};

/// What light there is at a moment of a walk.
class Looker {
  public:
    Looker(const dem::Posts& posts, const WalkOptions& options, const Airs& airs,
           const sun::PositionTable& table, double highest_m)
        : posts_(posts),
          horizon_(options.horizon),
          airs_(airs),
          table_(table),
          highest_m_(highest_m) {
        horizon_.few_directions = true;
    }

    WalkLight light(const WalkMoment& moment, OpenDirections& open, LatestHorizon& latest) const {
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
        if (!latest.horizon || latest.place != moment.place)
            latest = {moment.place,
                      std::make_unique<const TerrainHorizon>(posts_, moment.place, horizon_)};
        const HorizonPoint point = latest.horizon->at(sun::azimuth_of(sun));
        if (apparent_rad <= point.elevation_rad) return without;
        if (point.hole && apparent_rad <= point.hole_rad) return WalkLight::NotKnown;
        if (const auto sector = latest.horizon->open_beyond(point, highest_m_, apparent_rad))
            open.add(*sector);
        return WalkLight::Sun;
    }

  private:
    const dem::Posts& posts_;
    HorizonOptions horizon_;
    const Airs& airs_;
    const sun::PositionTable& table_;
    double highest_m_;
};

struct Change {
    WalkMoment at;
    WalkLight to;
};

/// All changes of light between two looks of different light.
std::vector<Change> changes_between(const Way& way, const Looker& looker, OpenDirections& open,
                                    double from, WalkLight before, double to, WalkLight after) {
    std::vector<Change> changes;
    LatestHorizon latest;
    while (before != after) {
        double low = from, high = to;
        WalkLight next = after;
        for (int i = 0; i < kHalvings; ++i) {
            const WalkMoment a = way.at(low), b = way.at(high);
            if (b.utc - a.utc <= kSharp_s && b.distance_m - a.distance_m <= kSharp_m) break;
            const double middle = (low + high) / 2;
            const WalkLight there = looker.light(way.at(middle), open, latest);
            (there == before ? low : high) = middle;
            if (there != before) next = there;
        }
        changes.push_back({way.at((low + high) / 2), next});
        before = next;
        from = high;
    }
    return changes;
}

/// The highest and the lowest ground under moments; holes do not count.
std::pair<double, double> heights_under(const dem::Posts& posts,
                                        const std::vector<WalkMoment>& moments) {
    double lowest_m = kInfinity, highest_m = -kInfinity;
    for (const WalkMoment& moment : moments) {
        const glm::dvec2 post = posts.grid().post(moment.place);
        const double height_m = posts.height_at(post.x, post.y);
        if (std::isnan(height_m)) continue;
        lowest_m = std::min(lowest_m, height_m);
        highest_m = std::max(highest_m, height_m);
    }
    if (lowest_m > highest_m) return {posts.lowest_m(), posts.lowest_m()};
    return {lowest_m, highest_m};
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

/// A walk and where it is looked at.
struct Looks {
    Way way;
    int count = 0;                    ///< steps
    std::vector<WalkMoment> moments;  ///< one more than steps

    Looks(const Walk& walk, double spacing_m) : way(walk, spacing_m) {
        if (!(way.looks() <= kMostLooks))
            bad_input(fmt::format(
                "walk: {:.1f} km in {:.1f} h need {:.3g} samples, expected at most {:.0f}; thin or "
                "split the track",
                walk.length_m() / 1000, walk.duration_s() / 3600, way.looks(), kMostLooks));
        count = std::max(1, static_cast<int>(std::ceil(way.looks())));
        for (int i = 0; i <= count; ++i)
            moments.push_back(way.at(at(i)));
    }
    double at(int i) const { return way.looks() * i / count; }

    /// The moments and the corners between them, which may stand out, in the order of the way.
    std::vector<WalkMoment> with_corners(const Walk& walk) const {
        std::vector<WalkMoment> all = moments;
        for (std::size_t i = 0; i < walk.places().size(); ++i)
            all.push_back(way.vertex(i));
        std::stable_sort(all.begin(), all.end(), [](const WalkMoment& a, const WalkMoment& b) {
            return a.distance_m < b.distance_m;
        });
        return all;
    }
};

/// The stretches of a walk, and what is open of them.
void look_along(const Looks& looks, const Looker& looker, LightAlong& result) {
    OpenDirections open;
    std::vector<WalkLight> lights(looks.moments.size());
    parallel_for(0, looks.count + 1, 8, [&](int first, int last) {
        LatestHorizon latest;
        for (int i = first; i < last; ++i) {
            const auto k = static_cast<std::size_t>(i);
            lights[k] = looker.light(looks.moments[k], open, latest);
        }
    });
    std::vector<std::vector<Change>> changes(static_cast<std::size_t>(looks.count));
    parallel_for(0, looks.count, 8, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (lights[k] != lights[k + 1])
                changes[k] = changes_between(looks.way, looker, open, looks.at(i), lights[k],
                                             looks.at(i + 1), lights[k + 1]);
        }
    });
    add_stretches(result, looks.moments.front(), lights.front(), changes, looks.moments.back());
    result.doubt.open = open.sectors();
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

LightAlong light_along(const dem::Posts& posts, const Walk& walk, const WalkOptions& options) {
    const glm::dvec2 post_m = posts.grid().post_spacing_m();
    LightAlong result;
    result.spacing_m = std::min(post_m.x, post_m.y);
    result.step_s = kStep_s;
    result.length_m = walk.length_m();
    result.duration_s = walk.duration_s();
    result.definition = definition_of(options.horizon, result.spacing_m);
    const Looks looks(walk, result.spacing_m);
    check_inside(posts.grid(), looks.with_corners(walk));
    const auto [lowest_m, highest_m] = heights_under(posts, looks.moments);
    const Airs airs(options, walk.places().front(), lowest_m, highest_m);
    const sun::PositionTable table(walk.times().front(), walk.times().back());
    result.doubt.matters = Matters::Sun;
    result.doubt.highest_m =
        options.highest_m.value_or(std::min<double>(posts.highest_m(), kHighestTerrain_m));
    look_along(looks, Looker(posts, options, airs, table, result.doubt.highest_m), result);
    return result;
}

}  // namespace relevo::light
