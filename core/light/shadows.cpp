#include "light/shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "geo/ellipsoid.h"
#include "geo/local_frame.h"
#include "light/sweep.h"

namespace relevo::light {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr double kTolerance_rad = radians(0.04);  // of a tile's sun, where it is looked at
constexpr double kAirTolerance_rad = radians(0.01);
constexpr int kLeastTile = 2;               // posts a side
constexpr double kNight_rad = radians(-4);  // no ground of the Earth sees the sun so low

/// A part of the DEM, and the sun over it but for its height.
struct Tile {
    SweepWindow window;
    SweepSun path;  // its tangents are not set
};

/// The sun at a place.
struct Local {
    double azimuth_rad, elevation_rad;  // without air
};

/// The sun over the grid of a DEM.
class Sky {
  public:
    Sky(const dem::Posts& posts, const SunOverDem& sun, const ShadowOptions& options)
        : grid_(posts.grid()), frame_(grid_.center()) {
        const double c = std::cos(sun.elevation_rad);
        direction_ = {c * std::sin(sun.azimuth_rad), c * std::cos(sun.azimuth_rad),
                      std::sin(sun.elevation_rad)};
        curvature_ = (1 - options.refraction) / geo::kEquatorialRadius_m;
        relief_m_ = double{posts.highest_m()} - posts.lowest_m();
        heights_m_ = {posts.lowest_m()};
        if (options.air) {
            const auto air_at = [&](double height_m) {
                geo::Geodetic place = grid_.center();
                place.height_m = height_m;
                return options.air(place);
            };
            airs_ = {air_at(posts.lowest_m())};
            sun::Refraction high = air_at(posts.highest_m());
            if (std::abs(high.apparent_rad(sun.elevation_rad) -
                         airs_[0].apparent_rad(sun.elevation_rad)) > kAirTolerance_rad) {
                airs_.push_back(std::move(high));
                heights_m_.push_back(posts.highest_m());
            }
        }
    }

    const dem::Grid& grid() const { return grid_; }
    double curvature() const { return curvature_; }
    const std::vector<double>& heights_m() const { return heights_m_; }  ///< of levels of air

    Local at(double column, double row) const { return at(grid_.place(column, row)); }
    Local at(const geo::Geodetic& place) const {
        const geo::Axes axes = frame_.axes(place.lat_rad, place.lon_rad);
        const double east = glm::dot(direction_, axes.east),
                     north = glm::dot(direction_, axes.north);
        return {std::atan2(east, north),
                std::atan2(glm::dot(direction_, axes.up), std::hypot(east, north))};
    }
    double apparent_rad(double elevation_rad, std::size_t level) const {
        return airs_.empty() ? elevation_rad : airs_[level].apparent_rad(elevation_rad);
    }
    /// As far as ground can shade: where a ray has risen over all relief of a round Earth.
    double reach_m(double apparent_rad) const {
        const double t = std::tan(std::min(apparent_rad, radians(89.9)));
        return (std::sqrt(t * t + 2 * curvature_ * relief_m_) - t) / curvature_;
    }

    /// The tile's sun with the heights of a part of the disc.
    /// @param offset_rad  of that part over the centre
    SweepSun sun(const Tile& tile, std::size_t level, double offset_rad) const {
        const GridPair& p = tile.path.reference;
        const auto tangent = [&](double column, double row) {
            const double e = at(p.column + column, p.row + row).elevation_rad + offset_rad;
            return std::tan(std::min(apparent_rad(e, level), radians(89.99)));
        };
        const double across = std::max(0.5, tile.window.columns / 2.0);
        const double down = std::max(0.5, tile.window.rows / 2.0);
        SweepSun sun = tile.path;
        sun.tangent = tangent(0, 0);
        sun.tangent_a_post = {(tangent(across, 0) - tangent(-across, 0)) / (2 * across),
                              (tangent(0, down) - tangent(0, -down)) / (2 * down)};
        return sun;
    }

    /// The ray through the middle of a window, as a cubic over the grid.
    std::optional<Tile> tile(const SweepWindow& window) const;

    /// How far off a tile's sun is anywhere on it [rad].
    double error_rad(const Tile& tile) const;

  private:
    double path_error_rad(const Tile& tile, const glm::dvec2& post, const Local& sun) const;

    const dem::Grid& grid_;
    geo::LocalFrame frame_;
    glm::dvec3 direction_;
    double curvature_, relief_m_;
    std::vector<sun::Refraction> airs_;  // over the lowest post and, where it matters, the highest
    std::vector<double> heights_m_;
};

glm::dvec2 moved(const dem::Grid& grid, const geo::Geodetic& from, double azimuth_rad,
                 double distance_m) {
    return grid.post(geo::destination(from, azimuth_rad, distance_m));
}

std::optional<Tile> Sky::tile(const SweepWindow& window) const {
    const glm::dvec2 middle(window.column + (window.columns - 1) / 2.0,
                            window.row + (window.rows - 1) / 2.0);
    const geo::Geodetic place = grid_.place(middle.x, middle.y);
    if (!std::isfinite(place.lat_rad)) return std::nullopt;
    const Local sun = at(place);
    const glm::dvec2 spacing_m = grid_.post_spacing_m();
    double far_m = std::max(reach_m(apparent_rad(sun.elevation_rad, 0)),
                            4 * std::max(spacing_m.x, spacing_m.y));
    for (int tries = 0; tries < 8; ++tries, far_m /= 2) {
        const glm::dvec2 p1 = moved(grid_, place, sun.azimuth_rad, far_m / 3) - middle;
        const glm::dvec2 p2 = moved(grid_, place, sun.azimuth_rad, far_m * 2 / 3) - middle;
        const glm::dvec2 p3 = moved(grid_, place, sun.azimuth_rad, far_m) - middle;
        const glm::dvec2 a = 9.0 * p1 - 4.5 * p2 + p3;
        const glm::dvec2 b = -22.5 * p1 + 18.0 * p2 - 4.5 * p3;
        const glm::dvec2 c = 13.5 * p1 - 13.5 * p2 + 4.5 * p3;
        if (!std::isfinite(a.x + a.y + b.x + b.y + c.x + c.y)) continue;
        const auto pair = [](const glm::dvec2& v) { return GridPair{v.x, v.y}; };
        Tile tile{window, {}};
        tile.path.reference = pair(middle);
        tile.path.towards = pair(a / far_m);
        tile.path.bend = pair(2.0 * b / (far_m * far_m));
        tile.path.twist = pair(6.0 * c / (far_m * far_m * far_m));
        return tile;
    }
    return std::nullopt;
}

/// The largest angle between the rays that shade a post and the tile's lines.
double Sky::path_error_rad(const Tile& tile, const glm::dvec2& post, const Local& sun) const {
    // As Sweep goes: from row to row or from column to column, all lines being moved along the
    // other.
    const bool by_rows = std::abs(tile.path.towards.row) >= std::abs(tile.path.towards.column);
    const SweepSun path = by_rows ? tile.path : tile.path.transposed();
    const int step = by_rows ? 1 : 0, across = 1 - step;
    const geo::Geodetic place = grid_.place(post.x, post.y);
    const double apparent = apparent_rad(sun.elevation_rad, 0);
    const double reach = reach_m(apparent);
    const double s0 = path.distance_m(post[step]);
    const double moved_by = post[across] - path.way(s0).column;
    const double across_m = grid_.post_spacing_m()[across];
    double worst = 0;
    for (const double share : {0.02, 0.1, 0.3, 0.6, 1.0}) {
        const double s = share * reach;
        const glm::dvec2 at = moved(grid_, place, sun.azimuth_rad, s);
        if (!(at.x > -1 && at.y > -1 && at.x < grid_.columns() && at.y < grid_.rows())) continue;
        const double s1 = path.distance_m(at[step]);
        if (std::isnan(s1)) return kPi;
        const double aside_m = (path.way(s1).column + moved_by - at[across]) * across_m;
        const double longer = (s1 - s0 - s) / s;
        worst = std::max(worst, std::abs(aside_m) / s * std::cos(apparent));
        worst = std::max(worst, std::abs(longer * std::sin(2 * apparent) / 2));
    }
    return worst;
}

double Sky::error_rad(const Tile& tile) const {
    double worst = 0;
    const SweepWindow& w = tile.window;
    for (std::size_t level = 0; level < heights_m_.size(); ++level) {
        const SweepSun model = sun(tile, level, 0);
        for (int i = 0; i < 9; ++i) {
            const glm::dvec2 post(w.column + (w.columns - 1) * (i % 3) / 2.0,
                                  w.row + (w.rows - 1) * (i / 3) / 2.0);
            const Local local = at(post.x, post.y);
            const double tangent = model.tangent_at(post.x, post.y);
            const double seen = std::min(apparent_rad(local.elevation_rad, level), radians(89.99));
            worst = std::max(worst, std::abs(std::atan(tangent) - seen));
            if (level == 0) worst = std::max(worst, path_error_rad(tile, post, local));
            if (std::isnan(worst + local.elevation_rad)) return kPi;
        }
    }
    return worst;
}

[[noreturn]] void no_tile(const dem::Grid& grid) {
    bad_input(fmt::format(
        "light::shadows: {}: the sun's direction on this grid changes by more than 0.05 degrees "
        "within {} posts; expected a map on which it does not, such as UTM: gdalwarp -t_srs",
        grid.crs().name(), kLeastTile));
}

/// Tiles of which each has one sun, in order.
void divide(const Sky& sky, const SweepWindow& window, std::vector<Tile>& tiles) {
    const std::optional<Tile> tile = sky.tile(window);
    if (tile && sky.error_rad(*tile) <= kTolerance_rad) return tiles.push_back(*tile);
    const glm::dvec2 spacing_m = sky.grid().post_spacing_m();
    const bool by_columns = window.columns * spacing_m.x > window.rows * spacing_m.y;
    if ((by_columns ? window.columns : window.rows) <= kLeastTile) no_tile(sky.grid());
    SweepWindow first = window, second = window;
    if (by_columns) {
        first.columns = window.columns / 2;
        second.column += first.columns;
        second.columns -= first.columns;
    } else {
        first.rows = window.rows / 2;
        second.row += first.rows;
        second.rows -= first.rows;
    }
    divide(sky, first, tiles);
    divide(sky, second, tiles);
}

/// Edges of the shadow over a tile for a part of the disc, each post's own air considered.
Array2d<float> edges(const Sky& sky, const Sweep& sweep, const Tile& tile, double offset_rad,
                     const dem::Posts::View& heights) {
    const SweepWindow& w = tile.window;
    std::vector<Array2d<float>> of_levels;
    for (std::size_t level = 0; level < sky.heights_m().size(); ++level) {
        const SweepSun sun = sky.sun(tile, level, offset_rad);
        Array2d<float>& edge = of_levels.emplace_back(w.columns, w.rows);
        sweep.shadow_edge(sun, w, edge.data(), w.columns);
        // The smooth Earth around the DEM hides a sun that is lower than level.
        for (int row = 0; row < w.rows; ++row)
            for (int column = 0; column < w.columns; ++column) {
                const double tangent = sun.tangent_at(w.column + column, w.row + row);
                if (tangent >= 0) continue;
                const double earth_m = sweep.lowest_m() + tangent * tangent / (2 * sky.curvature());
                edge.at(column, row) = std::max(edge.at(column, row), static_cast<float>(earth_m));
            }
    }
    if (of_levels.size() == 1) return std::move(of_levels[0]);
    const double low_m = sky.heights_m()[0], span_m = sky.heights_m()[1] - low_m;
    for (int row = 0; row < w.rows; ++row)
        for (int column = 0; column < w.columns; ++column) {
            float& low = of_levels[0].at(column, row);
            const float high = of_levels[1].at(column, row);
            const double part = (*heights.at(w.column + column, w.row + row) - low_m) / span_m;
            if (low > -kInfinity && high > -kInfinity)
                low += static_cast<float>(part * (double{high} - low));
        }
    return std::move(of_levels[0]);
}

void light_tile(const Sky& sky, const Sweep& sweep, const Tile& tile, const SunOverDem& sun,
                bool soft, const dem::Posts::View& heights, Array2d<float>& lit) {
    const SweepWindow& w = tile.window;
    const double radius_rad = soft ? sun.semidiameter_rad : 0;
    const Array2d<float> upper = edges(sky, sweep, tile, radius_rad, heights);
    const Array2d<float> lower =
        soft ? edges(sky, sweep, tile, -radius_rad, heights) : Array2d<float>();
    for (int row = 0; row < w.rows; ++row)
        for (int column = 0; column < w.columns; ++column) {
            const float h = *heights.at(w.column + column, w.row + row);
            float& out = lit.at(w.column + column, w.row + row);
            if (std::isnan(h))
                out = h;
            else if (!soft)
                out = h >= upper.at(column, row);
            else if (h >= lower.at(column, row))
                out = 1;
            else if (h <= upper.at(column, row))
                out = 0;
            else
                out = static_cast<float>(
                    share_of_disc((double{h} - upper.at(column, row)) /
                                  (double{lower.at(column, row)} - upper.at(column, row))));
        }
}

/// The sun is under the horizon of every post.
bool is_night(const Sky& sky, const dem::Grid& grid) {
    for (int i = 0; i < 9; ++i) {
        const Local sun =
            sky.at((grid.columns() - 1) * (i % 3) / 2.0, (grid.rows() - 1) * (i / 3) / 2.0);
        if (!(sun.elevation_rad < kNight_rad)) return false;
    }
    return true;
}

}  // namespace

double share_of_disc(double height) {
    if (height <= 0) return 0;
    if (height >= 1) return 1;
    const double below = 1 - 2 * height;  // of the centre under the line, in radii
    return (std::acos(below) - below * std::sqrt(1 - below * below)) / kPi;
}

double true_azimuth_rad(const dem::Grid& grid, double azimuth_rad) {
    const geo::Geodetic center = grid.center();
    const glm::dvec2 on_map = grid.crs().from_geodetic(center);
    const double step = grid.crs().is_geographic() ? 1e-5 : 1 / grid.crs().unit_si();
    glm::dvec2 way(std::sin(azimuth_rad), std::cos(azimuth_rad));
    if (grid.crs().is_geographic()) way.x /= std::cos(center.lat_rad);
    const glm::dvec2 to = on_map + step * way;
    return geo::geodesic(center, grid.crs().to_geodetic(to.x, to.y)).azimuth_rad;
}

Shadows shadows(const dem::Posts& posts, const SunOverDem& sun, const ShadowOptions& options) {
    const dem::Grid& grid = posts.grid();
    if (!(options.refraction >= -1 && options.refraction <= 0.9))
        bad_input(
            fmt::format("light::shadows: refraction {:.10g}: no air bends light so, expected -1 to "
                        "0.9 of the Earth's curvature; 0.13 is the mean",
                        options.refraction));
    if (!posts.in_memory())
        bad_input(fmt::format(
            "light::shadows: {}: {} x {} posts are more than --memory allows; pass --memory {}",
            posts.about().path, grid.columns(), grid.rows(),
            ((std::int64_t{grid.columns()} * grid.rows()) >> 18) + 1));
    std::vector<float> unused;
    const dem::Posts::View heights = posts.view({0, 0, grid.columns(), grid.rows()}, unused);
    const Sky sky(posts, sun, options);
    Shadows result;
    result.lit = Array2d<float>(grid.columns(), grid.rows());
    const SweepWindow whole{0, 0, grid.columns(), grid.rows()};
    if (is_night(sky, grid)) {
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) {
                const float h = *heights.at(column, row);
                result.lit.at(column, row) = std::isnan(h) ? h : 0;
            }
    } else {
        std::vector<Tile> tiles;
        divide(sky, whole, tiles);
        const Sweep sweep(heights.at(0, 0), grid.columns(), grid.rows(), heights.stride);
        parallel_for(0, static_cast<int>(tiles.size()), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i)
                light_tile(sky, sweep, tiles[static_cast<std::size_t>(i)], sun, options.soft,
                           heights, result.lit);
        });
        result.tiles = static_cast<int>(tiles.size());
    }
    for (const float lit : result.lit) {
        result.holes += std::isnan(lit);
        result.lit_posts += lit > 0;
        result.shaded_posts += lit == 0;
    }
    result.definition = fmt::format(
        "{}, at the height of the ground; ground of the DEM alone shades, on the WGS 84 ellipsoid "
        "with terrestrial refraction k = {:.4g}; beyond the DEM smooth ground at {:.0f} m",
        options.soft ? "share of the sun's disc over the terrain, cut by a level line"
                     : "1 where the centre of the sun stands over the terrain, 0 in the shade",
        options.refraction, double{posts.lowest_m()});
    return result;
}

}  // namespace relevo::light
