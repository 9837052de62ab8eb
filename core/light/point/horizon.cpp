#include "light/point/horizon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "geo/ellipsoid.h"
#include "light/point/edge_ground.h"
#include "light/point/fan.h"

namespace relevo::light {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSphere_m = 6'371'000;

// A viewpoint that is meant to be on a post is there: coordinates of seven decimals, and the way to
// the grid's CRS and back, are good to a centimetre.
constexpr double kSnap_cells = 1e-3;
constexpr double kChunk_cells = 32;
constexpr double kNear_posts = 1.5;  // of a target, that do not hide it

// Of the eye above the ground, as sun::RiseRule has it: the sun is refracted by the air at the
// ground, and higher up lines of sight no longer bend alike.
constexpr double kHighestEye_m = 10'000;
constexpr double kDeepest_m = -12'000;
constexpr double kHighestGround_m = 31'000;  // where sun::Refraction ends
// An arc of 0.13 of the Earth's curvature from here to the sea's horizon is bent by 0.6 degrees, as
// light is by all of the air; nothing higher up is seen along such arcs.
constexpr double kHighestTarget_m = 20'000;
constexpr double kFarthestSeen_m = 1e6;  // nothing on Earth is seen from 1000 km

/// Where points stand in the sky of a viewpoint. `rise` over `run` is the tangent of the apparent
/// elevation of a point of height h at the distance s; rise falls with s, run grows.
struct RoundGround {
    double radius_m, eye_m, refraction;

    // The ellipsoid that way, as its osculating sphere; the next term, the change of the radius
    // along the way, is 0.04 m at 100 km, 0.00003 degrees (tests/light/test_horizon.cpp). Lines of
    // sight are arcs of a radius of radius_m / refraction.
    double rise(double h, double s) const {
        const double u = s * s / (radius_m * radius_m);
        const double fallen = u * (0.5 - u / 24);  // 1 - cos
        return (h - eye_m) - (radius_m + h) * fallen + 0.5 * refraction * radius_m * u;
    }
    double run(double h, double s) const {
        const double u = s * s / (radius_m * radius_m);
        return (1 + h / radius_m) * s * (1 - u * (1.0 / 6 - u / 120));
    }
};

struct MapGround {
    double radius_m, eye_m, refraction;  // radius infinite: a plane
    double rise(double h, double s) const {
        return (h - eye_m) - (1 - refraction) * s * s / (2 * radius_m);
    }
    double run(double, double s) const { return s; }
};

/// Where a smooth Earth of height h has its horizon, beyond `from`.
template <typename G>
double farthest_rise_m(const G& ground, double h, double from_m) {
    const double above_m = ground.eye_m - h;
    if (above_m <= 0) return from_m;
    return std::max(from_m, std::sqrt(2 * ground.radius_m * above_m / (1 - ground.refraction)));
}

/// Tangent of the elevation of height h at s; level at infinity, where the plane's horizon is.
template <typename G>
double tangent(const G& ground, double h, double s) {
    if (std::isinf(s)) return 0;
    return ground.rise(h, s) / ground.run(h, s);
}

/// The height at the distance s whose elevation has this tangent; both sides are linear in it.
template <typename G>
double height_m(const G& ground, double tangent, double s) {
    const double rise = ground.rise(0, s), rise_a_m = ground.rise(1, s) - rise;
    const double run = ground.run(0, s), run_a_m = ground.run(1, s) - run;
    return (tangent * run - rise) / (rise_a_m - tangent * run_a_m);
}

/// Radius of the ellipsoid's curvature in a direction: Euler's formula.
double radius_m(double lat_rad, double azimuth_rad) {
    const double e2 = geo::kFlattening * (2 - geo::kFlattening);
    const double w2 = 1 - e2 * std::sin(lat_rad) * std::sin(lat_rad);
    const double n = geo::kEquatorialRadius_m / std::sqrt(w2);
    const double m = n * (1 - e2) / w2;
    const double c = std::cos(azimuth_rad), s = std::sin(azimuth_rad);
    return 1 / (c * c / m + s * s / n);
}

double snapped(double index) {
    const double nearest = std::round(index);
    return std::abs(index - nearest) <= kSnap_cells ? nearest : index;
}

double turned(double azimuth_rad) {
    const double turns = azimuth_rad / (2 * kPi);
    const double result = (turns - std::floor(turns)) * 2 * kPi;
    return result < 2 * kPi ? result : 0;
}

std::string place_text(const geo::Geodetic& place) {
    return fmt::format("{:.7g},{:.7g}", degrees(place.lat_rad), degrees(place.lon_rad));
}

/// "47 to 48 north, 11 to 12 east", of the posts.
std::string cover_text(const dem::Grid& grid) {
    double south = kInfinity, north = -kInfinity, west = kInfinity, east = -kInfinity;
    const geo::Geodetic center = grid.center();
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i)
        for (int k = 0; k <= kSteps; ++k) {
            const geo::Geodetic p = grid.place((grid.columns() - 1) * i / double{kSteps},
                                               (grid.rows() - 1) * k / double{kSteps});
            if (!std::isfinite(p.lat_rad)) continue;
            const double lon_deg =
                degrees(center.lon_rad + std::remainder(p.lon_rad - center.lon_rad, 2 * kPi));
            south = std::min(south, degrees(p.lat_rad));
            north = std::max(north, degrees(p.lat_rad));
            west = std::min(west, lon_deg);
            east = std::max(east, lon_deg);
        }
    return fmt::format("latitudes {:.4f} to {:.4f} and longitudes {:.4f} to {:.4f}", south, north,
                       west, east);
}

/// The nearest post with a height, as a remedy: ", the nearest height is at LAT,LON"; empty where
/// there is none near.
std::string nearest_height_text(const dem::Posts& posts, const glm::dvec2& post) {
    constexpr int kFarthest = 2000;
    const dem::Grid& grid = posts.grid();
    const int column = static_cast<int>(std::lround(post.x));
    const int row = static_cast<int>(std::lround(post.y));
    // A side of a ring: as much of it as lies on the grid.
    struct Side {
        dem::Window on_grid;
        std::vector<float> buffer;
        dem::Posts::View view;
        bool valid(int c, int r) const {
            return c >= on_grid.column && r >= on_grid.row &&
                   c < on_grid.column + on_grid.columns && r < on_grid.row + on_grid.rows &&
                   !std::isnan(*view.at(c, r));
        }
    };
    std::array<Side, 4> sides;
    const auto read = [&](Side& side, int c1, int c2, int r1, int r2) {
        c1 = std::max(c1, 0), c2 = std::min(c2, grid.columns() - 1);
        r1 = std::max(r1, 0), r2 = std::min(r2, grid.rows() - 1);
        side.on_grid = {c1, r1, c2 - c1 + 1, r2 - r1 + 1};
        if (side.on_grid.columns > 0 && side.on_grid.rows > 0)
            side.view = posts.view(side.on_grid, side.buffer);
    };
    for (int ring = 0; ring <= kFarthest; ++ring) {
        read(sides[0], column - ring, column + ring, row - ring, row - ring);
        read(sides[1], column - ring, column + ring, row + ring, row + ring);
        read(sides[2], column - ring, column - ring, row - ring, row + ring);
        read(sides[3], column + ring, column + ring, row - ring, row + ring);
        for (int i = -ring; i <= ring; ++i) {
            const std::array<glm::ivec2, 4> candidates{glm::ivec2(column + i, row - ring),
                                                       {column + i, row + ring},
                                                       {column - ring, row + i},
                                                       {column + ring, row + i}};
            for (std::size_t k = 0; k < sides.size(); ++k)
                if (sides[k].valid(candidates[k].x, candidates[k].y))
                    return fmt::format("; a post with a height is at {}",
                                       place_text(grid.place(candidates[k].x, candidates[k].y)));
        }
    }
    return {};
}

/// The column and row of a place, snapped, and its height.
/// @throws Error (BadInput) `horizon: LAT,LON: what`
std::pair<glm::dvec2, double> ground_at(const dem::Posts& posts, const geo::Geodetic& place) {
    const dem::Grid& grid = posts.grid();
    const auto is_inside = [&](const glm::dvec2& post) {
        return post.x >= 0 && post.y >= 0 && post.x <= grid.columns() - 1 &&
               post.y <= grid.rows() - 1;
    };
    glm::dvec2 post = grid.post(place);
    post = {snapped(post.x), snapped(post.y)};
    if (!is_inside(post)) {
        const geo::Geodetic swapped{place.lon_rad, place.lat_rad, 0};
        const bool is_swapped =
            std::abs(swapped.lat_rad) <= kPi / 2 && is_inside(grid.post(swapped));
        bad_input(fmt::format("horizon: {}: outside of the DEM, expected a point within {}{}",
                              place_text(place), cover_text(grid),
                              is_swapped ? "; latitude comes first" : ""));
    }
    const double height_m = posts.height_at(post.x, post.y);
    if (std::isnan(height_m))
        bad_input(fmt::format("horizon: {}: the point is {}{}", place_text(place),
                              posts.is_outside(static_cast<int>(std::lround(post.x)),
                                               static_cast<int>(std::lround(post.y)))
                                  ? "outside the ground of the DEM"
                                  : "in a void of the DEM",
                              nearest_height_text(posts, post)));
    return {post, height_m};
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

}  // namespace

struct TerrainHorizon::Scan {
    double until_m = kInfinity;  // look no farther

    double best = -kInfinity;  // tangent
    double distance_m = kNaN;
    glm::dvec2 post{kNaN};
    double height_m = kNaN;
    double reach_m = 0;
    double first_hole_m = kInfinity, last_hole_m = -kInfinity;
};

namespace {

/// One line of sight over the grid.
template <typename G, typename Scan>
class Line {
  public:
    /// @param buffer  room for the posts of a chunk
    Line(const dem::Posts& posts, const G& ground, double spacing_m, std::vector<float>& buffer,
         Scan& scan)
        : posts_(posts),
          columns_(posts.grid().columns()),
          rows_(posts.grid().rows()),
          lowest_m_(posts.lowest_m()),
          highest_m_(posts.highest_m()),
          buffer_(buffer),
          ground_(ground),
          touching_m_(1e-6 * spacing_m),
          scan_(scan) {}

    void follow(const std::vector<TracePoint>& line) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            if (!segment(line[i], line[i + 1])) return;
    }

  private:
    static TracePoint mix(const TracePoint& a, const TracePoint& b, double t) {
        return {a.post + t * (b.post - a.post), a.distance_m + t * (b.distance_m - a.distance_m)};
    }

    /// How much of the way from a to b lies within the posts.
    double inside(const TracePoint& a, const TracePoint& b) const {
        double t = 1;
        for (int axis = 0; axis < 2; ++axis) {
            const double first = -kSnap_cells;
            const double last = (axis == 0 ? columns_ : rows_) - 1 + kSnap_cells;
            const double from = a.post[axis], to = b.post[axis];
            if (to > last) t = std::min(t, (last - from) / (to - from));
            if (to < first) t = std::min(t, (first - from) / (to - from));
        }
        return std::max(t, 0.0);
    }

    /// @returns whether the line goes on
    bool segment(const TracePoint& from, const TracePoint& next) {
        double t = inside(from, next);
        const bool leaves = t < 1;
        TracePoint to = mix(from, next, t);
        scan_.reach_m = to.distance_m;
        const bool ends = to.distance_m >= scan_.until_m;
        if (ends) {
            if (from.distance_m >= scan_.until_m) return false;
            t = (scan_.until_m - from.distance_m) / (to.distance_m - from.distance_m);
            to = mix(from, to, t);
        }
        if (!nothing_left_) {
            const glm::dvec2 cells = glm::abs(to.post - from.post);
            const int chunks =
                std::max(1, static_cast<int>(std::ceil(std::max(cells.x, cells.y) / kChunk_cells)));
            TracePoint a = from;
            for (int i = 1; i <= chunks && !nothing_left_; ++i) {
                const TracePoint b = i == chunks ? to : mix(from, to, i / double(chunks));
                chunk(a, b);
                a = b;
            }
        }
        return !leaves && !ends;
    }

    /// The highest tangent that height h can have between two distances.
    double bound(double h, double near_m, double far_m) const {
        const double rise = ground_.rise(h, near_m);
        return rise > 0 ? rise / ground_.run(lowest_m_, near_m) : rise / ground_.run(h, far_m);
    }

    void chunk(const TracePoint& a, const TracePoint& b) {
        const auto [c1, c2] = std::minmax(a.post.x, b.post.x);
        const auto [r1, r2] = std::minmax(a.post.y, b.post.y);
        const glm::ivec2 first(c1, r1), last(c2, r2);
        if (a.distance_m > touching_m_) {
            if (bound(highest_m_, a.distance_m, kFarthest_m) <= scan_.best) {
                nothing_left_ = true;
                return;
            }
            const float h = posts_.bound_m(first.x, last.x, first.y, last.y);
            if (bound(h, a.distance_m, b.distance_m) <= scan_.best) return;
        }
        // Rounding may put a crossing into the cell beside.
        const glm::ivec2 begin = glm::max(first - 1, 0);
        const glm::ivec2 end = glm::min(last + 3, glm::ivec2(columns_, rows_));
        const dem::Posts::View view =
            posts_.view({begin.x, begin.y, end.x - begin.x, end.y - begin.y}, buffer_);
        crossings<0>(a, b, view);
        crossings<1>(a, b, view);
    }

    /// All crossings with columns (axis 0) or rows (axis 1).
    template <int kAxis>
    void crossings(const TracePoint& a, const TracePoint& b, const dem::Posts::View& view) {
        constexpr int kOther = 1 - kAxis;
        const double begin = a.post[kAxis], way = b.post[kAxis] - begin;
        if (way == 0) return;
        const int lines = kAxis == 0 ? columns_ : rows_;
        const auto [low, high] = std::minmax(begin, b.post[kAxis]);
        const int first = std::max(0, static_cast<int>(std::ceil(low)));
        const int last = std::min(lines - 1, static_cast<int>(std::floor(high)));
        const int posts = kOther == 0 ? columns_ : rows_;
        const std::ptrdiff_t line = kAxis == 0 ? 1 : view.stride;
        const std::ptrdiff_t step = kAxis == 0 ? view.stride : 1;
        const int view_line = kAxis == 0 ? view.column : view.row;
        const int view_post = kAxis == 0 ? view.row : view.column;
        const double other_way = b.post[kOther] - a.post[kOther];
        const double distance = b.distance_m - a.distance_m;
        for (int i = first; i <= last; ++i) {
            const double t = (i - begin) / way;
            const double s = a.distance_m + t * distance;
            if (s <= touching_m_) continue;
            const double other = a.post[kOther] + t * other_way;
            const int k = std::clamp(static_cast<int>(other), 0, posts - 2);
            const double f = other - k;
            const float* h0 = view.first_m + (i - view_line) * line + (k - view_post) * step;
            double h = h0[0] + f * (h0[step] - h0[0]);
            if (h != h) {
                // A hole at the far end of the edge does not spoil the post itself.
                h = f <= kSnap_cells ? h0[0] : f >= 1 - kSnap_cells ? h0[step] : kNaN;
                if (h != h) {
                    const int none = h0[0] != h0[0] ? k : k + 1;
                    if (kAxis == 0 ? posts_.is_outside(i, none) : posts_.is_outside(none, i))
                        continue;
                    scan_.first_hole_m = std::min(scan_.first_hole_m, s);
                    scan_.last_hole_m = std::max(scan_.last_hole_m, s);
                    continue;
                }
            }
            const double rise = ground_.rise(h, s), run = ground_.run(h, s);
            if (rise > scan_.best * run) {
                scan_.best = rise / run;
                scan_.distance_m = s;
                scan_.height_m = h;
                scan_.post[kAxis] = i;
                scan_.post[kOther] = other;
            }
        }
    }

    // Half the way round: the longest geodesic.
    static constexpr double kFarthest_m = 2.0e7;

    const dem::Posts& posts_;
    int columns_, rows_;
    double lowest_m_, highest_m_;
    std::vector<float>& buffer_;
    const G& ground_;
    double touching_m_;
    Scan& scan_;
    bool nothing_left_ = false;
};

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
    if (const std::optional<int> round = posts.grid().columns_round()) {
        first_column_ = static_cast<int>(std::lround(posts.grid().post(place).x)) - *round / 2;
        unrolled_.emplace(dem::Posts::unrolled(posts, first_column_, *round + 1));
        posts_ = &*unrolled_;
    }
    std::tie(post_, ground_m_) = ground_at(*posts_, place);
    const dem::Grid& grid = posts_->grid();
    place_ = grid.place(post_.x, post_.y);
    place_.height_m = ground_m_;
    if (!(ground_m_ >= kDeepest_m && ground_m_ <= kHighestGround_m))
        bad_input(
            fmt::format("horizon: {}: the ground is at {:.0f} m there, expected a height of "
                        "the Earth; pass --unit cm where the DEM's heights are centimetres, or "
                        "--nodata V where V is no height",
                        place_text(place_), ground_m_));
    eye_m_ = options.eye_above_ground ? ground_m_ + options.eye_height_m : options.eye_height_m;
    if (!(eye_m_ - ground_m_ <= kHighestEye_m))
        bad_input(fmt::format(
            "horizon: {}: the eye at {:.10g} m, expected at most {:.0f} m above the ground, which "
            "is at {:.1f} m there; the refraction model does not hold above",
            place_text(place_), eye_m_, kHighestEye_m, ground_m_));
    if (eye_m_ < ground_m_)
        bad_input(
            fmt::format("horizon: {}: the eye at {:.1f} m is under the ground, which "
                        "is at {:.1f} m there; a height above the ground is written as 2agl",
                        place_text(place_), eye_m_, ground_m_));
    const auto map_point = [&](const geo::Geodetic& p) { return grid.crs().from_geodetic(p); };
    const glm::dvec2 here = map_point(place_);
    const glm::dvec2 northward = map_point(geo::destination(place_, 0, 1)) - here;
    true_north_on_map_rad_ = std::atan2(northward.x, northward.y);
    if (options.earth == EarthModel::Ellipsoid) {
        fan_ = std::make_unique<const Fan>(grid, place_, post_,
                                           longest_m(*posts_, place_, eye_m_, options),
                                           options.few_directions);
    } else {
        if (grid.crs().is_geographic())
            bad_input(
                fmt::format("horizon: {}: a map in degrees cannot be taken as flat "
                            "ground; expected a projected CRS",
                            grid.crs().name()));
        map_unit_m_ = grid.crs().unit_si();
    }
}

TerrainHorizon::~TerrainHorizon() = default;

/// Calls `body` with the shape of the ground that way.
template <typename Body>
void TerrainHorizon::with_ground(double azimuth_rad, const Body& body) const {
    switch (options_.earth) {
        case EarthModel::Ellipsoid:
            return body(
                RoundGround{radius_m(place_.lat_rad, azimuth_rad), eye_m_, options_.refraction});
        case EarthModel::MapOnSphere:
            return body(MapGround{kSphere_m, eye_m_, options_.refraction});
        case EarthModel::MapOnPlane:
            return body(MapGround{kInfinity, eye_m_, 0});
    }
}

/// @param line  becomes the line of sight over the grid
void TerrainHorizon::look(double azimuth_rad, Scan& scan, std::vector<TracePoint>& line) const {
    thread_local std::vector<float> buffer;
    const dem::Grid& grid = posts_->grid();
    if (fan_) {
        fan_->trace(azimuth_rad, line);
    } else {
        const double bearing = azimuth_rad + true_north_on_map_rad_;
        dem::Affine linear = grid.affine();
        linear.x0 = linear.y0 = 0;
        const glm::dvec2 step = linear.inverse({std::sin(bearing), std::cos(bearing)});
        const double long_enough =
            (grid.columns() + grid.rows()) / std::max(std::abs(step.x), std::abs(step.y));
        line.assign({{post_, 0}, {post_ + step * long_enough, long_enough * map_unit_m_}});
    }
    // Any length of the order of a cell serves: it says what is no crossing but the start itself.
    const double spacing_m =
        line.size() < 2 ? 1.0
                        : line[1].distance_m / std::max(1e-9, glm::length(line[1].post - post_));
    with_ground(azimuth_rad, [&](const auto& ground) {
        Line<std::decay_t<decltype(ground)>, Scan>(*posts_, ground, spacing_m, buffer, scan)
            .follow(line);
    });
}

/// A column and row of the posts as they are given.
glm::dvec2 TerrainHorizon::given(glm::dvec2 post) const {
    if (!unrolled_) return post;
    const double round = *given_.grid().columns_round();
    post.x += first_column_;
    post.x -= round * std::floor(post.x / round);
    return post;
}

HorizonPoint TerrainHorizon::at(double azimuth_rad) const {
    thread_local std::vector<TracePoint> line;
    Scan scan;
    look(azimuth_rad, scan, line);
    HorizonPoint point;
    point.azimuth_rad = turned(azimuth_rad);
    point.distance_m = scan.distance_m;
    point.post = given(scan.post);
    point.height_m = scan.height_m;
    point.reach_m = scan.reach_m;
    if (posts_->about().statistics.holes > 0)
        point.reach_m = std::min(point.reach_m, outside_from_m(*posts_, line));
    point.elevation_rad = std::atan(scan.best);
    const double least_rad =
        std::max(options_.least_elevation_rad, ground_beyond_rad(azimuth_rad, scan, line));
    if (!(point.elevation_rad >= least_rad)) {
        point.elevation_rad = least_rad;
        point.distance_m = point.height_m = kNaN;
        point.post = glm::dvec2(kNaN);
    }
    point.hole_rad = hole_rad(azimuth_rad, scan);
    point.hole = point.hole_rad > point.elevation_rad;
    return point;
}

/// Elevation of the horizon that the smooth ground beyond the DEM makes.
double TerrainHorizon::ground_beyond_rad(double azimuth_rad, const Scan& scan,
                                         const std::vector<TracePoint>& line) const {
    double elevation_rad = -kPi / 2;
    with_ground(azimuth_rad, [&](const auto& ground) {
        if (options_.outside_height_m) {
            const double outside_m = *options_.outside_height_m;
            if (outside_m == -kInfinity) return;
            const double far_m = farthest_rise_m(ground, outside_m, std::max(scan.reach_m, 1.0));
            elevation_rad = std::atan(tangent(ground, outside_m, far_m));
        } else if (scan.best < 0) {  // over which no edge stands
            const double curvature = (1 - ground.refraction) / ground.radius_m;
            const Edge edge = edge_along(*posts_, line).value_or(Edge{0, posts_->lowest_m()});
            elevation_rad = std::atan(tangent_beyond(edge, eye_m_, curvature));
        }
    });
    return elevation_rad;
}

/// How high terrain as high as the highest post would stand in the holes that a look has met.
double TerrainHorizon::hole_rad(double azimuth_rad, const Scan& scan) const {
    double elevation_rad = -kPi / 2;
    if (!(scan.first_hole_m < kInfinity)) return elevation_rad;
    with_ground(azimuth_rad, [&](const auto& ground) {
        const double high_m = posts_->highest_m();
        const double hole_m =
            std::min(farthest_rise_m(ground, high_m, scan.first_hole_m), scan.last_hole_m);
        elevation_rad = std::atan(tangent(ground, high_m, hole_m));
    });
    return elevation_rad;
}

/// How far the DEM goes towards a point of the horizon, also where the look ended before its edge.
double TerrainHorizon::edge_m(const HorizonPoint& point) const {
    if (!fan_) return point.reach_m;
    const auto outside = [&](double distance_m) {
        const glm::dvec2 post = fan_->post(point.azimuth_rad, distance_m);
        const dem::Grid& grid = posts_->grid();
        if (!(post.x >= -kSnap_cells && post.x <= grid.columns() - 1 + kSnap_cells &&
              post.y >= -kSnap_cells && post.y <= grid.rows() - 1 + kSnap_cells))
            return true;
        const auto column = static_cast<int>(std::lround(post.x)),
                   row = static_cast<int>(std::lround(post.y));
        return std::isnan(posts_->thinned_m(column, row)) && posts_->is_outside(column, row);
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
    Scan scan;
    scan.until_m = distance_m;
    look(azimuth_rad, scan, line);
    return std::atan(scan.best);
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

std::optional<OpenSector> TerrainHorizon::open_beyond(const HorizonPoint& point, double highest_m,
                                                      double over_rad, double until_m) const {
    if (!(over_rad < kPi / 2)) return std::nullopt;
    std::optional<OpenSector> found;
    with_ground(point.azimuth_rad, [&](const auto& ground) {
        const double level = std::tan(over_rad);
        const auto highest_at_m = [&](double reach_m) {
            return std::min(farthest_rise_m(ground, highest_m, std::max(reach_m, 1.0)), until_m);
        };
        const auto stands_over = [&](double reach_m) {
            return reach_m < until_m &&
                   tangent(ground, highest_m, highest_at_m(reach_m)) > level + 1e-9;
        };
        if (!stands_over(point.reach_m)) return;
        const double reach_m = edge_m(point);
        if (!stands_over(reach_m)) return;
        double low = highest_at_m(reach_m);
        double high = std::min(kFarthestSeen_m, until_m);
        while (high - low > 1) {
            const double middle = (low + high) / 2;
            (tangent(ground, highest_m, middle) > level ? low : high) = middle;
        }
        // A line of sight that goes down is lowest farther away.
        const double from_m = std::max(reach_m, 1.0);
        const double lowest_at_m =
            level < 0 ? -level * ground.radius_m / (1 - ground.refraction) : 0;
        const double least_m =
            height_m(ground, level, std::clamp(lowest_at_m, from_m, std::max(from_m, high)));
        found = {{point.azimuth_rad, point.azimuth_rad}, reach_m, high, least_m};
    });
    return found;
}

namespace {

/// Sectors of neighbours that are open, from one sector for each direction.
std::vector<OpenSector> joined(const std::vector<HorizonPoint>& profile,
                               const std::vector<OpenSector>& all) {
    const std::size_t n = profile.size();
    std::vector<bool> is_open(n);
    for (std::size_t i = 0; i < n; ++i)
        is_open[i] = all[i].needed_m > 0;
    const auto index = [&](double azimuth_rad) {
        return static_cast<std::size_t>(std::lround(azimuth_rad / (2 * kPi) * double(n))) % n;
    };
    std::vector<OpenSector> sectors;
    for (const Sector& sector : sectors_of(is_open)) {
        const std::size_t first = index(sector.from_azimuth_rad);
        const std::size_t last = index(sector.to_azimuth_rad);
        OpenSector whole{
            {profile[first].azimuth_rad, profile[last].azimuth_rad}, kInfinity, 0, kInfinity};
        for (std::size_t i = first;; i = (i + 1) % n) {
            whole.reach_m = std::min(whole.reach_m, all[i].reach_m);
            whole.needed_m = std::max(whole.needed_m, all[i].needed_m);
            whole.least_m = std::min(whole.least_m, all[i].least_m);
            if (i == last) break;
        }
        sectors.push_back(whole);
    }
    return sectors;
}

}  // namespace

std::vector<OpenSector> TerrainHorizon::open_sectors(const std::vector<HorizonPoint>& profile,
                                                     double highest_m,
                                                     const std::vector<double>& matters_rad) const {
    // Sectors of one direction each; none where the DEM reaches far enough.
    std::vector<OpenSector> all(profile.size());
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const double horizon_rad = profile[i].elevation_rad;
        const double over_rad =
            matters_rad.empty() ? horizon_rad : std::max(horizon_rad, matters_rad[i]);
        if (const auto open = open_beyond(profile[i], highest_m, over_rad)) all[i] = *open;
    }
    return joined(profile, all);
}

std::vector<Sector> sectors_of(const std::vector<bool>& holds) {
    const std::size_t n = holds.size();
    const auto azimuth_rad = [&](std::size_t i) { return 2 * kPi * double(i) / double(n); };
    // From behind a direction for which it does not hold; n: it holds all round.
    const auto closed =
        static_cast<std::size_t>(std::find(holds.begin(), holds.end(), false) - holds.begin());
    std::vector<Sector> sectors;
    bool within = false;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = (closed + i) % n;
        if (holds[k] && !within) sectors.push_back({azimuth_rad(k), azimuth_rad(k)});
        within = holds[k];
        if (within) sectors.back().to_azimuth_rad = azimuth_rad(k);
    }
    std::sort(sectors.begin(), sectors.end(), [](const Sector& a, const Sector& b) {
        return a.from_azimuth_rad < b.from_azimuth_rad;
    });
    return sectors;
}

Sight TerrainHorizon::sight(const geo::Geodetic& target) const {
    if (!(target.height_m >= kDeepest_m && target.height_m <= kHighestTarget_m))
        bad_input(
            fmt::format("horizon: {}: the target at {:.10g} m, expected {:.0f} to {:.0f}; no "
                        "landscape has such a height",
                        place_text(target), target.height_m, kDeepest_m, kHighestTarget_m));
    Sight sight;
    if (fan_) {
        const geo::Geodesic way = geo::geodesic(place_, target);
        sight.azimuth_rad = way.azimuth_rad;
        sight.distance_m = way.distance_m;
    } else {
        const geo::Crs& crs = posts_->grid().crs();
        const glm::dvec2 way = crs.from_geodetic(target) - crs.from_geodetic(place_);
        sight.azimuth_rad = turned(std::atan2(way.x, way.y) - true_north_on_map_rad_);
        sight.distance_m = glm::length(way) * map_unit_m_;
    }
    if (!(sight.distance_m <= kFarthestSeen_m))
        bad_input(
            fmt::format("horizon: {}: the target is {:.0f} km away, expected at most {:.0f}; "
                        "nothing on Earth is seen from so far",
                        place_text(target), sight.distance_m / 1000, kFarthestSeen_m / 1000));
    const glm::dvec2 spacing_m = posts_->grid().post_spacing_m();
    Scan scan;
    scan.until_m = sight.distance_m - kNear_posts * std::max(spacing_m.x, spacing_m.y);
    double level = 0;
    with_ground(sight.azimuth_rad, [&](const auto& ground) {
        level = tangent(ground, target.height_m, std::max(sight.distance_m, 1e-3));
    });
    sight.elevation_rad = std::atan(level);
    std::vector<TracePoint> line;
    if (scan.until_m > 0) look(sight.azimuth_rad, scan, line);
    sight.visible = scan.best <= level;
    sight.hole = sight.visible && hole_rad(sight.azimuth_rad, scan) > sight.elevation_rad;
    if (!sight.visible) sight.hidden_by_rad = std::atan(scan.best) - sight.elevation_rad;
    return sight;
}

std::string TerrainHorizon::description() const {
    std::string ground;
    switch (options_.earth) {
        case EarthModel::Ellipsoid:
            ground = fmt::format("on the WGS 84 ellipsoid with terrestrial refraction k = {:.4g}",
                                 options_.refraction);
            break;
        case EarthModel::MapOnSphere:
            ground = fmt::format("on the map, on a sphere with terrestrial refraction k = {:.4g}",
                                 options_.refraction);
            break;
        case EarthModel::MapOnPlane:
            ground = "on the map, without curvature";
            break;
    }
    const double above_m = eye_m_ - ground_m_;
    std::string text = fmt::format(
        "terrain horizon: highest crossing with the rows and columns of the DEM, {}; {}, on ground "
        "at {:.1f} m",
        ground, above_m > 0 ? fmt::format("eye {:.4g} m up", above_m) : "eye at ground level",
        ground_m_);
    if (options_.least_elevation_rad > -kPi / 2)
        text +=
            fmt::format("; nowhere below {:.4g} degrees", degrees(options_.least_elevation_rad));
    else if (!options_.outside_height_m)
        text += kBeyondTheDem;
    else if (*options_.outside_height_m > -kInfinity)
        text +=
            fmt::format("; outside the DEM smooth ground at {:.0f} m", *options_.outside_height_m);
    return text;
}

geo::Geodetic summit_near(const dem::Posts& posts, const geo::Geodetic& place, double radius_m) {
    constexpr int kSide = 256;  // of what is looked at together
    const dem::Grid& grid = posts.grid();
    const auto [post, ground_m] = ground_at(posts, place);
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const glm::ivec2 reach =
        glm::ivec2(glm::min(radius_m / spacing_m, glm::dvec2(grid.columns(), grid.rows())));
    const glm::ivec2 nearest(std::lround(post.x), std::lround(post.y));
    const glm::ivec2 begin = glm::max(nearest - reach, 0);
    const glm::ivec2 end = glm::min(nearest + reach + 1, glm::ivec2(grid.columns(), grid.rows()));
    double highest_m = ground_m;
    std::optional<glm::ivec2> at;  // of equally high posts the first, row by row
    std::vector<float> buffer;
    for (int row = begin.y; row < end.y; row += kSide)
        for (int column = begin.x; column < end.x; column += kSide) {
            const dem::Window part{column, row, std::min(kSide, end.x - column),
                                   std::min(kSide, end.y - row)};
            if (posts.bound_m(column, column + part.columns - 1, row, row + part.rows - 1) <
                highest_m)
                continue;
            const dem::Posts::View view = posts.view(part, buffer);
            for (int r = row; r < row + part.rows; ++r)
                for (int c = column; c < column + part.columns; ++c) {
                    const double height_m = *view.at(c, r);
                    const bool higher =
                        height_m > highest_m || (height_m == highest_m && at && r < at->y);
                    if (higher && glm::length((glm::dvec2(c, r) - post) * spacing_m) <= radius_m) {
                        highest_m = height_m;
                        at = glm::ivec2(c, r);
                    }
                }
        }
    geo::Geodetic summit = at ? grid.place(at->x, at->y) : grid.place(post.x, post.y);
    summit.height_m = highest_m;
    return summit;
}

}  // namespace relevo::light
