#include "light/irradiation.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"

namespace relevo::light {
namespace {

constexpr double kNode_m = 50e3;  // from node to node of what changes slowly over the Earth

/// Of the air over the sea, as ClearSky has it.
double pressure(double height_m) {
    return std::exp(-height_m / 8434.5);
}

}  // namespace

double air_left(const DemSky& dem, double height_m) {
    const double low = pressure(dem.level_height_m(0)),
                 high = pressure(dem.level_height_m(0) + std::max(1.0, dem.relief_m()));
    return (low - pressure(height_m)) / (low - high);
}

GroundForBeams::GroundForBeams(const DemSky& dem, const SweepWindow& part)
    : east(part, 0), north(part, 0), air(part, 0), beam_wh(part, 0) {
    const dem::Grid& grid = dem.grid();
    const PartHeights heights(dem.posts(), part);
    ground_slope(grid, heights.view, part, east, north);
    parallel_for(part.row, part.row + part.rows, 16, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const SweepRun run{false, row, part.column, part.columns, nullptr, nullptr};
            float* const to = air.of(run);
            for (int i = 0; i < part.columns; ++i)
                to[i] = static_cast<float>(air_left(dem, double{heights.at(part.column + i, row)}));
        }
    });
}

GroundForBeams GroundForBeams::part(const SweepWindow& window, bool along_columns) const {
    return GroundForBeams(east.part(window, along_columns), north.part(window, along_columns),
                          air.part(window, along_columns), TileValues(window, 0, along_columns));
}

void GroundForBeams::turn(bool along_columns) {
    for (TileValues* const each : {&east, &north, &air, &beam_wh})
        each->turn(along_columns);
}

SunBeam::SunBeam(const SunSky& sky, const SunTile& tile, const ClearSky& clear, double time_h)
    : reference(tile.path.reference), hours(time_h) {
    const GridPair& p = reference;
    const double across = std::max(0.5, tile.window.columns / 2.0),
                 down = std::max(0.5, tile.window.rows / 2.0);
    at = sky.direction(p.column, p.row);
    a_column = (sky.direction(p.column + across, p.row) - sky.direction(p.column - across, p.row)) /
               (2 * across);
    a_row = (sky.direction(p.column, p.row + down) - sky.direction(p.column, p.row - down)) /
            (2 * down);
    const double elevation = sky.elevation_rad(p.column, p.row);
    const DemSky& dem = sky.dem();
    lowest_m = dem.level_height_m(0);
    step_m = std::max(1.0, dem.relief_m()) / (given.size() - 1);
    for (std::size_t k = 0; k < given.size(); ++k)
        given[k] =
            static_cast<float>(clear.beam(elevation, lowest_m + step_m * static_cast<double>(k)));
    constexpr double kStep_rad = radians(0.1);
    const double middle_m = lowest_m + dem.relief_m() / 2;
    if (const double here = clear.beam(elevation, middle_m); here > 0)
        more = (clear.beam(elevation + kStep_rad, middle_m) / here - 1) /
               (std::sin(elevation + kStep_rad) - std::sin(elevation));
}

void add_beam(const SweepRun& run, const SunBeam& sun, const float* margin_m,
              GroundForBeams& ground) {
    const auto f = [](double value) { return static_cast<float>(value); };
    const glm::dvec3 base =
        sun.at + (run.along_column ? sun.a_column * (run.line - sun.reference.column)
                                   : sun.a_row * (run.line - sun.reference.row));
    const glm::dvec3& a_post = run.along_column ? sun.a_row : sun.a_column;
    const float first =
        f(run.first - (run.along_column ? sun.reference.row : sun.reference.column));
    const float x = f(base.x), y = f(base.y), z = f(base.z), dx = f(a_post.x), dy = f(a_post.y),
                dz = f(a_post.z), up = f(sun.at.z), lowest = f(sun.lowest_m),
                a_metre = f(1 / sun.step_m), more = f(sun.more), hours = f(sun.hours);
    const float *const east = ground.east.of(run), *const north = ground.north.of(run);
    constexpr float kLast = float(std::tuple_size_v<decltype(SunBeam::given)>) - 1.001F;
    float* const beam = ground.beam_wh.of(run);
    for (int i = 0; i < run.count; ++i) {
        const float before = margin_m[i], now = run.height_m[i] - run.found[i];
        // The share of the time in which a line from one to the other is over 0.
        const float both = std::abs(before) + std::abs(now);
        const float over = std::max(before, 0.0F) + std::max(now, 0.0F);
        const float share = both > 0 ? over / both : 1.0F;
        const float k = first + static_cast<float>(i), e = east[i], n = north[i];
        const float sz = z + k * dz;
        const float onto =
            (sz - e * (x + k * dx) - n * (y + k * dy)) / std::sqrt(1 + e * e + n * n);
        const float at = (run.height_m[i] - lowest) * a_metre;
        const float level = at > 0 ? std::min(at, kLast) : 0;  // a hole is anywhere
        const auto entry = static_cast<std::size_t>(level);
        const float low = sun.given[entry], high = sun.given[entry + 1];
        const float given = (low + (level - static_cast<float>(entry)) * (high - low)) *
                            std::max(0.0F, 1 + more * (sz - up));
        const float gain = std::max(0.0F, onto) * given * share * hours;
        beam[i] += gain > 0 ? gain : 0;  // a hole has none
    }
}

OpenSky::OpenSky(const DemSky& dem, const sun::PositionTable& table, sun::Instant begin,
                 double length_s, double step_s, double linke) {
    const dem::Grid& grid = dem.grid();
    const glm::dvec2 sides_m = grid.sides_m();
    columns_ = 2 + static_cast<int>(sides_m.x / kNode_m);
    rows_ = 2 + static_cast<int>(sides_m.y / kNode_m);
    column_step_ = std::max(1.0, grid.columns() - 1.0) / (columns_ - 1);
    row_step_ = std::max(1.0, grid.rows() - 1.0) / (rows_ - 1);
    nodes_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    const auto steps = static_cast<int>(std::ceil(length_s / step_s - 1e-9));
    parallel_for(0, static_cast<int>(nodes_.size()), 1, [&](int first, int last) {
        for (int node = first; node < last; ++node) {
            const sun::Observer observer(
                grid.place(node % columns_ * column_step_, node / columns_ * row_step_));
            Energy& sum = nodes_[static_cast<std::size_t>(node)];
            for (int k = 0; k < steps; ++k) {
                const double from_s = k * step_s, until_s = std::min(from_s + step_s, length_s);
                const glm::dvec3 sun = table.vector_au(begin + (from_s + until_s) / 2, observer);
                if (sun.z <= 0) continue;
                const double distance = glm::length(sun), elevation = std::asin(sun.z / distance);
                const ClearSky clear(linke, distance);
                const double hours = (until_s - from_s) / 3600, level = sun.z / distance * hours;
                sum.beam_low_wh += level * clear.beam(elevation, dem.level_height_m(0));
                sum.beam_high_wh +=
                    level *
                    clear.beam(elevation, dem.level_height_m(0) + std::max(1.0, dem.relief_m()));
                sum.diffuse_wh += hours * clear.diffuse(elevation);
            }
        }
    });
}

OpenSky::Energy OpenSky::at(double column, double row) const {
    const double x = std::clamp(column / column_step_, 0.0, columns_ - 1.0),
                 y = std::clamp(row / row_step_, 0.0, rows_ - 1.0);
    const int c = std::min(columns_ - 2, static_cast<int>(x)),
              r = std::min(rows_ - 2, static_cast<int>(y));
    const double u = x - c, v = y - r;
    const auto node = [&](int i, int j) -> const Energy& {
        return nodes_[static_cast<std::size_t>((r + j) * columns_ + c + i)];
    };
    const auto between = [&](double Energy::*figure) {
        return (1 - v) * ((1 - u) * (node(0, 0).*figure) + u * (node(1, 0).*figure)) +
               v * ((1 - u) * (node(0, 1).*figure) + u * (node(1, 1).*figure));
    };
    return {between(&Energy::beam_low_wh), between(&Energy::beam_high_wh),
            between(&Energy::diffuse_wh)};
}

}  // namespace relevo::light
