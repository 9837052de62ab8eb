#include "light/raster/sun_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "geo/ellipsoid.h"

namespace relevo::light {
namespace {

constexpr double kTwilight_rad = radians(0.25);  // below its lowest a sun still counts as one
constexpr double kSteepest_rad = radians(89.99);

bool is_finite(const glm::dvec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

/// The ray through where it is after three shares of a way, and through a post.
std::optional<Ray> ray_through(const glm::dvec2& post, double far_m, const glm::dvec3& s,
                               const std::array<glm::dvec2, 3>& there) {
    glm::dmat3 powers;
    glm::dmat3x2 ways;
    for (int k = 0; k < 3; ++k) {
        powers[k] = {s[k], s[k] * s[k], s[k] * s[k] * s[k]};
        ways[k] = there[static_cast<std::size_t>(k)] - post;
    }
    const glm::dmat3x2 terms = ways * glm::inverse(powers);
    if (!is_finite(terms[0] + terms[1] + terms[2])) return std::nullopt;
    return Ray{post, terms[0] / far_m, 2.0 * terms[1] / (far_m * far_m),
               6.0 * terms[2] / (far_m * far_m * far_m)};
}

/// Some of the lines of a tile, from its window's first to its last.
struct SampledLines {
    struct Line {
        int line, begin, end;
    };
    std::vector<Line> with_posts;
    Window lines{};  // a window around the tile's posts: lines are its rows

    Window window(bool along_columns) const {
        if (!along_columns) return lines;
        return {lines.row, lines.column, lines.rows, lines.columns};
    }
};

/// As many lines as that. None where rays turn back, or cross.
std::optional<SampledLines> sampled_lines(const TilePosts& posts, bool along_columns, int count) {
    const Window& w = posts.window;
    const Window all = along_columns ? Window{w.row, w.column, w.rows, w.columns} : w;
    SampledLines found;
    int first = all.end_row(), last = all.row, begin = all.end_column(), end = all.column;
    int beside = 1;
    for (int i = 0, before = all.row; i < count; ++i) {
        const int line =
            all.row + static_cast<int>(std::int64_t{all.rows - 1} * i / std::max(1, count - 1));
        const auto range = range_of(posts, line, along_columns);
        if (!range) return std::nullopt;
        if (range->first < range->second) {
            // The tile may have posts between this line and the one before it, too,
            first = std::min(first, before), last = all.end_row() - 1;
            if (!found.with_posts.empty())
                beside = std::max({beside, std::abs(range->first - found.with_posts.back().begin),
                                   std::abs(range->second - found.with_posts.back().end)});
            begin = std::min(begin, range->first), end = std::max(end, range->second);
            found.with_posts.push_back({line, range->first, range->second});
        } else if (!found.with_posts.empty() && last == all.end_row() - 1) {
            last = line;  // and between its last line and the next one
        }
        before = line;
    }
    if (found.with_posts.empty()) return found;
    found.lines = common(all, {begin - beside, first, end - begin + 2 * beside, last - first + 1});
    return found;
}

/// Some, or all where these would miss a small tile.
std::optional<SampledLines> sampled_lines(const TilePosts& posts, bool along_columns) {
    constexpr int kSamples = 33;
    constexpr std::size_t kEnough = 3;
    const int lines = along_columns ? posts.window.columns : posts.window.rows;
    const auto some = sampled_lines(posts, along_columns, std::min(lines, kSamples));
    if (!some || some->with_posts.size() >= kEnough || lines <= kSamples) return some;
    return sampled_lines(posts, along_columns, lines);
}

}  // namespace

double way_in(const Window& w, const glm::dvec2& post, const glm::dvec2& a_metre) {
    const glm::dvec2 first(w.column, w.row), last(w.end_column() - 1, w.end_row() - 1);
    double way_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k)
        if (a_metre[k] != 0)
            way_m = std::min(way_m, ((a_metre[k] > 0 ? last : first)[k] - post[k]) / a_metre[k]);
    return std::max(0.0, way_m);
}

SunField::SunField(const SunTerrain& terrain, const geo::Geodetic& place, const SunOverDem& sun)
    : terrain_(&terrain), two_airs_(terrain.airs_differ(sun.elevation_rad)) {
    const geo::Axes axes = terrain.frame().axes(place.lat_rad, place.lon_rad);
    const double c = std::cos(sun.elevation_rad);
    direction_ = c * std::sin(sun.azimuth_rad) * axes.east +
                 c * std::cos(sun.azimuth_rad) * axes.north + std::sin(sun.elevation_rad) * axes.up;
}

SunField::SunField(const SunTerrain& terrain, double azimuth_rad)
    : terrain_(&terrain), azimuth_rad_(azimuth_rad), is_level_(true) {}

SunField SunField::level(const SunTerrain& terrain, const geo::Geodetic& place,
                         double azimuth_rad) {
    SunField field(terrain, place, {azimuth_rad, 0, 0});
    field.is_level_ = true;
    return field;
}

SunField SunField::over(const SunTerrain& terrain) const {
    if (azimuth_rad_) return SunField(terrain, *azimuth_rad_);
    const geo::Geodetic& middle = terrain_->marks()[4];
    SunField field(terrain, middle, at(middle));
    field.is_level_ = is_level_;
    return field;
}

bool SunField::is_night(const Window& window) const {
    constexpr double kWide_rad = radians(50);  // the sun may shine between posts so far apart
    if (is_level_) return false;
    const dem::Grid& grid = terrain_->grid();
    const double night_rad = terrain_->lowest_sun_rad() - kTwilight_rad;
    glm::dvec3 first_up(0);
    for (int i = 0; i < 9; ++i) {
        const geo::Geodetic place = grid.place(window.column + (window.columns - 1) * (i % 3) / 2.0,
                                               window.row + (window.rows - 1) * (i / 3) / 2.0);
        const glm::dvec3 up = terrain_->frame().up(place.lat_rad, place.lon_rad);
        if (i == 0) first_up = up;
        if (!(at(place).elevation_rad < night_rad)) return false;
        if (!(glm::dot(first_up, up) > std::cos(kWide_rad))) return false;
    }
    return true;
}

SunOverDem SunField::at(const geo::Geodetic& place) const {
    if (azimuth_rad_)
        return {*azimuth_rad_, place.lat_rad * 0, 0};  // no number where there is none
    const geo::Axes axes = terrain_->frame().axes(place.lat_rad, place.lon_rad);
    const double east = glm::dot(direction_, axes.east), north = glm::dot(direction_, axes.north);
    return {std::atan2(east, north),
            std::atan2(glm::dot(direction_, axes.up), std::hypot(east, north)), 0};
}

double SunField::shade_m(double apparent_rad) const {
    return shade_reach_m(terrain_->relief_m(), terrain_->curvature(), apparent_rad);
}

double SunField::reach_m(double apparent_rad) const {
    return std::max(4 * terrain_->widest_spacing_m(), shade_m(apparent_rad));
}

glm::dvec2 SunField::step(const glm::dvec2& post) const {
    const dem::Grid& grid = terrain_->grid();
    const geo::Geodetic place = grid.place(post.x, post.y);
    const double way_m = 4 * terrain_->widest_spacing_m();
    return (grid.post(geo::destination(place, at(place).azimuth_rad, way_m), post) - post) / way_m;
}

std::optional<Ray> SunField::ray(const glm::dvec2& post, const Window& window,
                                 bool along_columns) const {
    constexpr double kLonger = 1.1;   // rays are bent
    constexpr double kMostAside = 3;  // its length in posts, for one along
    const dem::Grid& grid = terrain_->grid();
    const geo::Geodetic place = grid.place(post.x, post.y);
    const glm::dvec2 a_metre = step(post);
    if (!is_finite(a_metre)) return std::nullopt;
    const SunOverDem sun = at(place);
    const double more_m = 8 * terrain_->widest_spacing_m();
    const double reach = reach_m(terrain_->apparent_rad(sun.elevation_rad, SunTerrain::kMean));
    double before_m = more_m + kLonger * std::min(way_in(window, post, a_metre) + reach,
                                                  way_in(terrain_->whole_grid(), post, a_metre));
    const double behind_m = more_m + kLonger * way_in(window, post, -a_metre);
    // As far towards the sun as the CRS expresses the ray.
    for (int tries = 0; tries < 8; ++tries, before_m /= 2) {
        glm::dvec3 shares(-behind_m / before_m, 0.5, 1);
        double far_m = before_m;
        if (behind_m < before_m / 3) {
            shares = {1 / 3.0, 2 / 3.0, 1};
        } else if (before_m < behind_m / 3) {
            shares = {-1 / 3.0, -2 / 3.0, -1};
            far_m = behind_m;
        }
        std::array<glm::dvec2, 3> there;
        for (int k = 0; k < 3; ++k)
            there[static_cast<std::size_t>(k)] =
                grid.post(geo::destination(place, sun.azimuth_rad, shares[k] * far_m), post);
        std::optional<Ray> ray = ray_through(post, far_m, shares, there);
        if (!ray) continue;
        ray->along_columns = along_columns;
        const double along = along_columns ? ray->first.x : ray->first.y;
        if (std::abs(along) * kMostAside < glm::length(ray->first)) return std::nullopt;
        return ray;
    }
    return std::nullopt;
}

std::optional<SunTile> SunField::tile(const TilePosts& posts, bool along_columns) const {
    const std::optional<SampledLines> lines = sampled_lines(posts, along_columns);
    if (!lines) return std::nullopt;
    SunTile tile{posts, {}, {}};
    tile.posts.window = lines->window(along_columns);
    if (tile.posts.window.is_empty()) return tile;
    // On the first, the middle and the last of the lines that have posts: their ends and middles.
    for (std::size_t k = 0; k < tile.marks.size(); ++k) {
        const auto& [line, begin, end] =
            lines->with_posts[(lines->with_posts.size() - 1) * (k / 3) / 2];
        const double at = begin + (end - 1 - begin) * double(k % 3) / 2;
        glm::dvec2& post = tile.marks[k].post;
        post = along_columns ? glm::dvec2(line, at) : glm::dvec2(at, line);
        tile.marks[k].elevation_rad = this->at(post).elevation_rad;
        if (!std::isfinite(tile.marks[k].elevation_rad)) return std::nullopt;
    }
    const glm::dvec2 middle(std::round(tile.marks[4].post.x), std::round(tile.marks[4].post.y));
    const std::optional<Ray> ray = this->ray(middle, tile.posts.window, along_columns);
    if (!ray) return std::nullopt;
    tile.ray = *ray;
    return tile;
}

/// With each metre towards the sun, it stands higher by the Earth's curvature, but the ground falls
/// away under a ray by that less the ray's own. A tile has one of the two: where shade does not
/// reach so far that the rays' own matters, the first one, as suns are then linear over long tiles.
double SunField::curvature_along_ray(double tangent) const {
    constexpr double kTolerance_rad = radians(0.02);
    const double earth = 1 / geo::kEquatorialRadius_m, over_ray = terrain_->curvature();
    const double off_rad = std::abs(earth - over_ray) * shade_m(std::atan(tangent)) / 2;
    return off_rad < kTolerance_rad ? earth : over_ray;
}

SweepSun SunField::sun(const SunTile& tile, SunTerrain::Air air, double offset_rad) const {
    // The plane through tangents at the marks, by least squares; a tile may be one post wide.
    const glm::dvec2& at = tile.ray.reference;
    const Window& w = tile.posts.window;
    const glm::dvec2 size(std::max(2, w.columns), std::max(2, w.rows));
    glm::dmat3 sums(1e-12);
    glm::dvec3 found(0);
    for (const SunTile::Mark& mark : tile.marks) {
        const double apparent_rad = terrain_->apparent_rad(mark.elevation_rad + offset_rad, air);
        const glm::dvec3 terms(1, (mark.post.x - at.x) / size.x, (mark.post.y - at.y) / size.y);
        sums += glm::outerProduct(terms, terms);
        found += terms * std::tan(std::min(apparent_rad, kSteepest_rad));
    }
    const glm::dvec3 fit = glm::inverse(sums) * found;
    SweepSun sun{tile.ray, fit.x, {fit.y / size.x, fit.z / size.y}};
    const glm::dvec2& first = tile.ray.first;
    const glm::dvec2 along = first * terrain_->spacing_m() * terrain_->spacing_m();
    const double rises = curvature_along_ray(sun.tangent) * (1 + sun.tangent * sun.tangent);
    sun.tangent_per_post +=
        along * (rises - glm::dot(sun.tangent_per_post, first)) / glm::dot(along, first);
    return sun;
}

/// The largest angle between the rays that shade a post and the tile's, where that is of account.
double SunField::path_error_rad(const SunTile& tile, const SunTile::Mark& mark) const {
    const dem::Grid& grid = terrain_->grid();
    const bool along_columns = tile.ray.along_columns;
    Ray ray = tile.ray;
    glm::dvec2 post = mark.post, spacing_m = terrain_->spacing_m();
    const auto turned = [&](const glm::dvec2& v) {
        return along_columns ? glm::dvec2(v.y, v.x) : v;
    };
    for (glm::dvec2* const each :
         {&ray.reference, &ray.first, &ray.second, &ray.third, &post, &spacing_m})
        *each = turned(*each);
    const geo::Geodetic place = grid.place(mark.post.x, mark.post.y);
    const double azimuth_rad = at(place).azimuth_rad;
    const double apparent = terrain_->apparent_rad(mark.elevation_rad, SunTerrain::kMean);
    const double reach = reach_m(apparent), least_m = 2 * terrain_->widest_spacing_m();
    // As a sweep goes: from row to row, all lines being moved along rows.
    const double s0 = ray.distance_m(post.y);
    if (std::isnan(s0)) return kPi;
    const double moved_by = post.x - ray.way(s0).x;
    double worst = 0;
    for (const double share : {0.2, 0.6, 1.0}) {
        // Nearer than some posts an angle is of no account, and PROJ's millimetre would be one.
        const double s = std::max(share * reach, least_m);
        const glm::dvec2 there = grid.post(geo::destination(place, azimuth_rad, s), mark.post);
        if (!(there.x > -1 && there.y > -1 && there.x < grid.columns() && there.y < grid.rows()))
            continue;
        const glm::dvec2 to = turned(there);
        const double s1 = ray.distance_m(to.y);
        if (std::isnan(s1)) return kPi;
        // Far ground is met within a quarter of a post of the ray anyway, whatever the angle.
        const auto angle_rad = [&](double off_m) {
            return std::abs(off_m) < spacing_m.x / 4 ? 0 : std::abs(off_m) / s;
        };
        const double aside_m = (ray.way(s1).x + moved_by - to.x) * spacing_m.x;
        worst = std::max(worst, angle_rad(aside_m) * std::cos(apparent));
        worst = std::max(worst, angle_rad(s1 - s0 - s) * std::sin(2 * apparent) / 2);
    }
    return worst;
}

double SunField::error_rad(const SunTile& tile) const {
    double worst = 0;
    const auto add = [&](double error_rad) { worst = error_rad <= worst ? worst : error_rad; };
    if (is_level_) {  // a direction alone: no elevation is asked for
        for (const SunTile::Mark& mark : tile.marks)
            add(path_error_rad(tile, mark));
        return worst <= kPi ? worst : kPi;
    }
    for (int k = 0; k < (two_airs_ ? 2 : 1); ++k) {
        const SunTerrain::Air air = k == 0 ? first_air() : SunTerrain::kOfHighest;
        const SweepSun model = sun(tile, air, 0);
        for (std::size_t i = 0; i < tile.marks.size(); ++i) {
            const SunTile::Mark& mark = tile.marks[i];
            const double seen =
                std::min(terrain_->apparent_rad(mark.elevation_rad, air), kSteepest_rad);
            add(std::abs(std::atan(model.tangent_at(mark.post.x, mark.post.y)) - seen));
            if (k == 0 && i % 2 == 0) add(path_error_rad(tile, mark));  // corners and middle
            if (!(worst <= kPi)) return kPi;  // a place that is none has no error either
        }
    }
    return worst;
}

}  // namespace relevo::light
