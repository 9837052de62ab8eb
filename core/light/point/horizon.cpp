#include "light/point/horizon.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "dem/surroundings.h"
#include "light/point/edge_ground.h"
#include "light/point/fan.h"
#include "light/point/ground_at.h"

namespace relevo::light {
namespace {

constexpr double kNear_posts = 1.5;  // of a target, that do not hide it

// Of the eye above the ground, as sun::RiseRule has it: the sun is refracted by the air at the
// ground, and higher up lines of sight no longer bend alike.
constexpr double kHighestEye_m = 10'000;
constexpr double kDeepest_m = -12'000;
constexpr double kHighestGround_m = 31'000;  // where sun::Refraction ends
// An arc of 0.13 of the Earth's curvature from here to the sea's horizon is bent by 0.6 degrees, as
// light is by all of the air; nothing higher up is seen along such arcs.
constexpr double kHighestTarget_m = 20'000;

double turned(double azimuth_rad) {
    const double turns = azimuth_rad / (2 * kPi);
    const double result = (turns - std::floor(turns)) * 2 * kPi;
    return result < 2 * kPi ? result : 0;
}

/// How far the DEM's edge is at most, by `steps` points along each of its sides.
double farthest_edge_m(const dem::Grid& grid, const geo::Geodetic& place, int steps) {
    double edge_m = 0;
    for (int i = 0; i <= steps; ++i) {
        const double column = double(grid.columns() - 1) * i / steps;
        const double row = double(grid.rows() - 1) * i / steps;
        for (const glm::dvec2& post : {glm::dvec2(column, 0), glm::dvec2(column, grid.rows() - 1),
                                       glm::dvec2(0, row), glm::dvec2(grid.columns() - 1, row)}) {
            const geo::Geodetic p = grid.place(post.x, post.y);
            if (std::isfinite(p.lat_rad))
                edge_m = std::max(edge_m, geo::geodesic(place, p).distance_m);
        }
    }
    return edge_m;
}

/// The farthest that a line of sight can matter: to the DEM's farthest edge, or to where terrain as
/// high as its highest post sinks under the horizon of a smooth Earth as high as its lowest.
double longest_m(const dem::Posts& posts, const geo::Geodetic& place, double eye_m,
                 const HorizonOptions& options) {
    constexpr int kSteps = 32;
    constexpr double kSmall_m = 5e5;  // up to there a corner of a map is what is farthest
    double edge_m = options.few_directions ? 1.1 * farthest_edge_m(posts.grid(), place, 2) : 0;
    if (!(edge_m > 0 && edge_m < kSmall_m)) edge_m = farthest_edge_m(posts.grid(), place, kSteps);
    const double radius = geo::kEquatorialRadius_m / (1 - options.refraction);
    const double low_m = posts.lowest_m();
    const double sight_m = std::sqrt(2 * radius * std::max(0.0, eye_m - low_m)) +
                           std::sqrt(2 * radius * (posts.highest_m() - low_m));
    // Edges between the samples, and the radius that way, are within 2 %.
    return 1.02 * std::min(edge_m, sight_m) + 1;
}

/// A straight line on the map that leaves the grid.
std::vector<TracePoint> line_on_map(const dem::Grid& grid, const glm::dvec2& post,
                                    double bearing_rad) {
    dem::Affine linear = grid.affine();
    linear.x0 = linear.y0 = 0;
    const glm::dvec2 step = linear.inverse({std::sin(bearing_rad), std::cos(bearing_rad)});
    const double length =
        (grid.columns() + grid.rows()) / std::max(std::abs(step.x), std::abs(step.y));
    return {{post, 0}, {post + step * length, length * grid.crs().unit_si()}};
}

}  // namespace

TerrainHorizon::TerrainHorizon(const dem::Heightfield& field, const geo::Geodetic& place,
                               const HorizonOptions& options)
    : TerrainHorizon(std::make_unique<const dem::Posts>(field), place, options) {}

TerrainHorizon::TerrainHorizon(std::unique_ptr<const dem::Posts> owned, const geo::Geodetic& place,
                               const HorizonOptions& options)
    : TerrainHorizon(*owned, place, options) {
    owned_ = std::move(owned);
}

TerrainHorizon::TerrainHorizon(const dem::Posts& posts, const geo::Geodetic& place,
                               const HorizonOptions& options)
    : given_(posts), posts_(&posts), options_(options) {
    if (!(options.refraction >= -1 && options.refraction <= 0.9))
        bad_input(
            fmt::format("horizon: refraction {:.10g}: impossible, expected -1 to 0.9 of the "
                        "Earth's curvature; 0.13 is the mean",
                        options.refraction));
    unrolled_ = dem::Posts::around(posts, place);
    if (unrolled_) posts_ = &*unrolled_;
    const Ground ground = ground_at(*posts_, place);
    post_ = ground.post;
    const dem::Grid& grid = posts_->grid();
    place_ = grid.place(post_.x, post_.y);
    place_.height_m = ground.height_m;
    eye_m_ = options.eye_height_m + (options.eye_above_ground ? place_.height_m : 0);
    check_eye();
    const auto map_point = [&](const geo::Geodetic& p) { return grid.crs().from_geodetic(p); };
    const glm::dvec2 northward = map_point(geo::destination(place_, 0, 1)) - map_point(place_);
    true_north_on_map_rad_ = std::atan2(northward.x, northward.y);
    if (!options.map_radius_m)
        fan_ = std::make_unique<const Fan>(grid, place_, post_,
                                           longest_m(*posts_, place_, eye_m_, options),
                                           options.few_directions);
    if (const dem::Posts* const around = posts.surroundings(); around && fan_) {
        unrolled_around_ = dem::Posts::around(*around, place_);
        around_ = unrolled_around_ ? &*unrolled_around_ : around;
        const dem::Grid& wider = around_->grid();
        if (!is_within(wider, wider.post(place_)))
            bad_input(fmt::format("horizon: {}: outside of the wider DEM", place_text(place_)));
        fan_around_ = std::make_unique<const Fan>(wider, place_, wider.post(place_),
                                                  longest_m(*around_, place_, eye_m_, options),
                                                  options.few_directions);
    }
    if (!fan_ && grid.crs().is_geographic())
        bad_input(
            fmt::format("horizon: {}: a map in degrees cannot be taken as flat ground; expected a "
                        "projected CRS",
                        grid.crs().name()));
}

TerrainHorizon::~TerrainHorizon() = default;

void TerrainHorizon::check_eye() const {
    const double ground_m = place_.height_m;
    if (!(ground_m >= kDeepest_m && ground_m <= kHighestGround_m))
        bad_input(
            fmt::format("horizon: {}: the ground is at {:.0f} m there, expected a height of "
                        "the Earth; pass --unit cm where the DEM's heights are centimetres, or "
                        "--nodata V where V is no height",
                        place_text(place_), ground_m));
    if (!(eye_m_ - ground_m <= kHighestEye_m))
        bad_input(fmt::format(
            "horizon: {}: the eye at {:.10g} m, expected at most {:.0f} m above the ground, which "
            "is at {:.1f} m there; the refraction model does not hold above",
            place_text(place_), eye_m_, kHighestEye_m, ground_m));
    if (eye_m_ < ground_m)
        bad_input(
            fmt::format("horizon: {}: the eye at {:.1f} m is under the ground, which "
                        "is at {:.1f} m there; a height above the ground is written as 2agl",
                        place_text(place_), eye_m_, ground_m));
}

ApparentElevation TerrainHorizon::towards(double azimuth_rad) const {
    const double radius_m =
        options_.map_radius_m.value_or(radius_of_curvature_m(place_.lat_rad, azimuth_rad));
    return {radius_m, eye_m_, options_.refraction};
}

/// @param line  becomes the line of sight over the grid
HighestCrossing TerrainHorizon::look(double azimuth_rad, double until_m,
                                     std::vector<TracePoint>& line) const {
    if (fan_)
        fan_->trace(azimuth_rad, line);
    else
        line = line_on_map(posts_->grid(), post_, azimuth_rad + true_north_on_map_rad_);
    const HighestCrossing found = highest_crossing(*posts_, towards(azimuth_rad), line, until_m);
    if (!around_) return found;
    const bool has_holes = posts_->about().statistics.holes > 0;
    const double end_m =
        has_holes ? std::min(found.reach_m, outside_from_m(*posts_, line)) : found.reach_m;
    if (end_m >= until_m) return found;
    fan_around_->trace(azimuth_rad, line);
    return look_around(azimuth_rad, end_m, until_m, found, line);
}

/// Goes on over the wider DEM from where the site ends.
/// @param line  over the wider grid; becomes what of it is beyond the site
HighestCrossing TerrainHorizon::look_around(double azimuth_rad, double from_m, double until_m,
                                            const HighestCrossing& on_site,
                                            std::vector<TracePoint>& line) const {
    const auto next = std::find_if(line.begin(), line.end(), [&](const TracePoint& point) {
        return point.distance_m > from_m;
    });
    if (next == line.end() || next == line.begin()) return on_site;
    const TracePoint &from = *(next - 1), &to = *next;
    const double t = (from_m - from.distance_m) / (to.distance_m - from.distance_m);
    *(next - 1) = {from.post + t * (to.post - from.post), from_m};
    line.erase(line.begin(), next - 1);
    const HighestCrossing beyond = highest_crossing(*around_, towards(azimuth_rad), line, until_m);
    HighestCrossing found = on_site;
    if (beyond.tangent > on_site.tangent) {
        found = beyond;
        found.post =
            posts_->grid().post(around_->grid().place(beyond.post.x, beyond.post.y), post_);
    }
    found.reach_m = std::max(on_site.reach_m, beyond.reach_m);
    found.first_void_m = std::min(on_site.first_void_m, beyond.first_void_m);
    found.last_void_m = std::max(on_site.last_void_m, beyond.last_void_m);
    return found;
}

/// A column and row of the posts as they are given.
glm::dvec2 TerrainHorizon::given(glm::dvec2 post) const {
    if (!unrolled_) return post;
    const dem::Affine &here = unrolled_->grid().affine(), &there = given_.grid().affine();
    const double turn = *given_.grid().columns_per_turn();
    post.x += std::round((here.x0 - there.x0) / here.x_column);
    post.x -= turn * std::floor(post.x / turn);
    return post;
}

HorizonPoint TerrainHorizon::at(double azimuth_rad) const {
    thread_local std::vector<TracePoint> line;
    const HighestCrossing highest = look(azimuth_rad, kInfinity, line);
    HorizonPoint point;
    point.azimuth_rad = turned(azimuth_rad);
    point.distance_m = highest.distance_m;
    point.post = given(highest.post);
    point.height_m = highest.height_m;
    point.reach_m = highest.reach_m;
    if (farthest_posts().about().statistics.holes > 0)
        point.reach_m = std::min(point.reach_m, outside_from_m(farthest_posts(), line));
    point.elevation_rad = std::atan(highest.tangent);
    const double beyond_rad = ground_beyond_rad(azimuth_rad, highest, line);
    if (!(point.elevation_rad >= beyond_rad)) {
        point.elevation_rad = beyond_rad;
        point.distance_m = point.height_m = kNaN;
        point.post = glm::dvec2(kNaN);
    }
    point.hole_rad = hole_rad(azimuth_rad, highest);
    point.hole = point.hole_rad > point.elevation_rad;
    return point;
}

/// Elevation of the horizon that the smooth ground beyond the DEM makes.
double TerrainHorizon::ground_beyond_rad(double azimuth_rad, const HighestCrossing& highest,
                                         const std::vector<TracePoint>& line) const {
    if (highest.tangent >= 0) return -kPi / 2;  // no edge stands over it
    const Edge edge =
        edge_along(farthest_posts(), line).value_or(Edge{0, farthest_posts().lowest_m()});
    return std::atan(tangent_beyond(edge, eye_m_, towards(azimuth_rad).curvature()));
}

/// How high terrain as high as the highest post would stand in the voids on a line of sight.
double TerrainHorizon::hole_rad(double azimuth_rad, const HighestCrossing& highest) const {
    if (!(highest.first_void_m < kInfinity)) return -kPi / 2;
    const ApparentElevation elevation = towards(azimuth_rad);
    const double high_m = std::max(posts_->highest_m(), farthest_posts().highest_m());
    const double void_m =
        std::min(elevation.farthest_rise_m(high_m, highest.first_void_m), highest.last_void_m);
    return std::atan(elevation.tangent(high_m, void_m));
}

double TerrainHorizon::edge_m(const HorizonPoint& point) const {
    if (!fan_) return point.reach_m;
    const auto outside = [&](double distance_m) {
        const dem::Posts& posts = farthest_posts();
        const glm::dvec2 post =
            (around_ ? *fan_around_ : *fan_).post(point.azimuth_rad, distance_m);
        if (!is_within(posts.grid(), post)) return true;
        const auto column = static_cast<int>(std::lround(post.x)),
                   row = static_cast<int>(std::lround(post.y));
        return std::isnan(posts.thinned_m(column, row)) && posts.is_outside(column, row);
    };
    double inside_m = point.reach_m, outside_m = 1.01 * point.reach_m + 1;
    if (outside(outside_m)) return point.reach_m;
    while (outside_m < kFarthestSeen_m && !outside(outside_m)) {
        inside_m = outside_m;
        outside_m *= 2;
    }
    if (outside_m >= kFarthestSeen_m) return kFarthestSeen_m;
    while (outside_m - inside_m > 1) {
        const double middle_m = (inside_m + outside_m) / 2;
        (outside(middle_m) ? outside_m : inside_m) = middle_m;
    }
    return inside_m;
}

double TerrainHorizon::elevation_within_rad(double azimuth_rad, double distance_m) const {
    std::vector<TracePoint> line;
    return std::atan(look(azimuth_rad, distance_m, line).tangent);
}

std::vector<HorizonPoint> TerrainHorizon::profile(int count) const {
    std::vector<HorizonPoint> points(static_cast<std::size_t>(count));
    parallel_for(0, count, 256, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            points[static_cast<std::size_t>(i)] = at(2 * kPi * i / count);
    });
    return points;
}

geo::Geodetic TerrainHorizon::place_of(const HorizonPoint& point) const {
    if (std::isnan(point.distance_m)) return {kNaN, kNaN, kNaN};
    geo::Geodetic place = given_.grid().place(point.post.x, point.post.y);
    place.height_m = point.height_m;
    return place;
}

Sight TerrainHorizon::sight(const geo::Geodetic& target) const {
    if (!(target.height_m >= kDeepest_m && target.height_m <= kHighestTarget_m))
        bad_input(
            fmt::format("horizon: {}: the target at {:.10g} m, expected {:.0f} to {:.0f}; no "
                        "landscape has such a height",
                        place_text(target), target.height_m, kDeepest_m, kHighestTarget_m));
    const geo::Geodesic way = geo::geodesic(place_, target);
    Sight sight;
    sight.azimuth_rad = way.azimuth_rad;
    sight.distance_m = way.distance_m;
    if (!(sight.distance_m <= kFarthestSeen_m))
        bad_input(
            fmt::format("horizon: {}: the target is {:.0f} km away, expected at most {:.0f}; "
                        "nothing on Earth is seen from so far",
                        place_text(target), sight.distance_m / 1000, kFarthestSeen_m / 1000));
    const dem::Grid& under = is_within(posts_->grid(), posts_->grid().post(target))
                                 ? posts_->grid()
                                 : farthest_posts().grid();
    const glm::dvec2 spacing_m = under.post_spacing_m();
    const double until_m = sight.distance_m - kNear_posts * std::max(spacing_m.x, spacing_m.y);
    const double level =
        towards(sight.azimuth_rad).tangent(target.height_m, std::max(sight.distance_m, 1e-3));
    sight.elevation_rad = std::atan(level);
    std::vector<TracePoint> line;
    HighestCrossing highest;
    if (until_m > 0) highest = look(sight.azimuth_rad, until_m, line);
    sight.visible = highest.tangent <= level;
    sight.hole = sight.visible && hole_rad(sight.azimuth_rad, highest) > sight.elevation_rad;
    if (!sight.visible) sight.hidden_by_rad = std::atan(highest.tangent) - sight.elevation_rad;
    return sight;
}

std::string TerrainHorizon::description() const {
    const double above_m = eye_m_ - place_.height_m;
    return fmt::format(
               "terrain horizon: highest crossing with the rows and columns of the DEM, {} with "
               "terrestrial refraction k = {:.4g}; {}, on ground at {:.1f} m{}",
               options_.map_radius_m ? "on the map, on a sphere" : "on the WGS 84 ellipsoid",
               options_.refraction,
               above_m > 0 ? fmt::format("eye {:.4g} m up", above_m) : "eye at ground level",
               place_.height_m, kBeyondTheDem) +
           dem::surroundings_text(given_, "; ");
}

}  // namespace relevo::light
