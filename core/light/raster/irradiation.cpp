#include "light/raster/irradiation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/raster/horizons.h"

namespace relevo::light {
namespace {

constexpr double kNode_m = 50e3;  // from node to node

/// Of the air over the sea, as ClearSky has it.
double pressure(double height_m) {
    return std::exp(-height_m / 8434.5);
}

double highest_m(const SunTerrain& terrain) {
    return terrain.lowest_m() + std::max(1.0, terrain.relief_m());
}

}  // namespace

double air_left(const SunTerrain& terrain, double height_m) {
    const double low = pressure(terrain.lowest_m()), high = pressure(highest_m(terrain));
    return (low - pressure(height_m)) / (low - high);
}

Nodes::Nodes(const SunTerrain& terrain) : first_column_(terrain.window().column) {
    const dem::Grid& grid = terrain.given().grid();
    const glm::dvec2 sides_m = grid.sides_m();
    columns_ = 2 + static_cast<int>(sides_m.x / kNode_m);
    rows_ = 2 + static_cast<int>(sides_m.y / kNode_m);
    column_step_ = std::max(1.0, grid.columns() - 1.0) / (columns_ - 1);
    row_step_ = std::max(1.0, grid.rows() - 1.0) / (rows_ - 1);
}

Nodes::Around Nodes::around(double column, double row) const {
    const double x = (column - first_column_) / column_step_,
                 y = row / row_step_;  // beyond the last it goes on
    const int c = std::clamp(static_cast<int>(x), 0, columns_ - 2),
              r = std::clamp(static_cast<int>(y), 0, rows_ - 2);
    const double u = x - c, v = y - r;
    const auto first = static_cast<std::size_t>(r * columns_ + c),
               below = first + static_cast<std::size_t>(columns_);
    return {{first, first + 1, below, below + 1},
            {(1 - v) * (1 - u), (1 - v) * u, v * (1 - u), v * u}};
}

SunBeams::SunBeams(const SunTerrain& terrain, const sun::PositionTable& table, double before_s,
                   double at_s, double linke)
    : nodes_(terrain),
      lowest_m_(terrain.lowest_m()),
      step_m_((highest_m(terrain) - terrain.lowest_m()) / (kHeights - 1)),
      hours_((at_s - before_s) / kHour_s) {
    const sun::Instant middle = table.from() + (before_s + at_s) / 2;
    const geo::Geodetic& center = terrain.marks()[4];
    const glm::dvec3 over_center = table.direction(middle, sun::Observer(center));
    const geo::Axes axes = terrain.frame().axes(center.lat_rad, center.lon_rad);
    direction_ = over_center.x * axes.east + over_center.y * axes.north + over_center.z * axes.up;
    for (int node = 0; node < nodes_.count(); ++node) {
        const glm::dvec2 post = nodes_.post(node);
        Beam& beam = beams_.emplace_back();
        const geo::Geodetic place = terrain.grid().place(post.x, post.y);
        if (!std::isfinite(place.lat_rad)) continue;
        const glm::dvec3 sun_au = table.vector_au(middle, sun::Observer(place));
        const double distance_au = glm::length(sun_au);
        beam.sine = sun_au.z / distance_au;
        const ClearSky clear(linke, distance_au);
        const double elevation_rad = std::asin(beam.sine);
        for (std::size_t k = 0; k < kHeights; ++k)
            beam.given[k] = static_cast<float>(
                clear.beam(elevation_rad, lowest_m_ + step_m_ * static_cast<double>(k)));
        constexpr double kStep_rad = radians(0.1);
        const double height_m = lowest_m_ + terrain.relief_m() / 2;
        if (const double here = clear.beam(elevation_rad, height_m); here > 0)
            beam.more = (clear.beam(elevation_rad + kStep_rad, height_m) / here - 1) /
                        (std::sin(elevation_rad + kStep_rad) - beam.sine);
    }
}

double SunBeams::sine(double column, double row) const {
    const Nodes::Around around = nodes_.around(column, row);
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
        sum += around.weight[k] * beams_[around.node[k]].sine;
    return sum;
}

void SunBeams::add(const SweepRun& run, const float* height_m, const float* clearance_m,
                   const InclinedGround& ground, float* beam_wh) const {
    // Piece by piece of the row, the same whatever the run.
    constexpr int kPiece = 256;
    for (int column = run.column; column < run.column + run.count;) {
        const int piece = column / kPiece * kPiece,
                  end = std::min(piece + kPiece, run.column + run.count),
                  done = column - run.column;
        const Nodes::Around around = nodes_.around(piece + kPiece / 2, run.row);
        const auto nearest = std::max_element(around.weight.begin(), around.weight.end());
        const Beam& beam =
            beams_[around.node[static_cast<std::size_t>(nearest - around.weight.begin())]];
        const double first = sine(piece, run.row),
                     a_post = (sine(piece + kPiece, run.row) - first) / kPiece;
        for (int i = done; column < end; ++column, ++i) {
            const glm::vec3 gradient =
                ground.slope.at(column - ground.window.column, run.row - ground.window.row);
            const float gain =
                gain_of(beam, static_cast<float>(first + (column - piece) * a_post), height_m[i],
                        clearance_m[i], height_m[i] - run.found[i], gradient);
            beam_wh[i] += gain > 0 ? gain : 0;  // a hole has none
        }
    }
}

/// What a post gets of a beam.
/// @param sine         of the sun's elevation there
/// @param before, now  clearances
float SunBeams::gain_of(const Beam& beam, float sine, float height_m, float before, float now,
                        const glm::vec3& gradient) const {
    // The share of the time in which a line from one to the other is over 0.
    const float both = std::abs(before) + std::abs(now);
    const float over = std::max(before, 0.0F) + std::max(now, 0.0F);
    const float share = both > 0 ? over / both : 1.0F;
    const float onto = (sine - glm::dot(gradient, direction_)) * cosine_of(gradient);
    const float at = (height_m - static_cast<float>(lowest_m_)) * static_cast<float>(1 / step_m_);
    const float level = at > 0 ? std::min(at, kHeights - 1.001F) : 0;  // a hole is anywhere
    const auto entry = static_cast<std::size_t>(level);
    const float low = beam.given[entry], high = beam.given[entry + 1];
    const float more = 1 + static_cast<float>(beam.more) * (sine - static_cast<float>(beam.sine));
    const float given =
        (low + (level - static_cast<float>(entry)) * (high - low)) * std::max(0.0F, more);
    return std::max(0.0F, onto) * given * share * static_cast<float>(hours_);
}

OpenSky::OpenSky(const SunTerrain& terrain, sun::Instant begin, double length_s, double linke)
    : nodes_(terrain), energies_(static_cast<std::size_t>(nodes_.count())) {
    const sun::PositionTable table(begin, begin + length_s);
    const double step_s = length_s > 40 * kDay_s ? 600 : 60;
    const auto steps = static_cast<int>(std::ceil(length_s / step_s - 1e-9));
    const auto find = [&](int node) {
        const glm::dvec2 post = nodes_.post(node);
        const geo::Geodetic place = terrain.grid().place(post.x, post.y);
        if (!std::isfinite(place.lat_rad)) return;
        const sun::Observer observer(place);
        Energy& sum = energies_[static_cast<std::size_t>(node)];
        for (int k = 0; k < steps; ++k) {
            const double from_s = k * step_s, until_s = std::min(from_s + step_s, length_s);
            const glm::dvec3 sun = table.vector_au(begin + (from_s + until_s) / 2, observer);
            if (sun.z <= 0) continue;
            const double distance = glm::length(sun), elevation = std::asin(sun.z / distance);
            const ClearSky clear(linke, distance);
            const double hours = (until_s - from_s) / kHour_s, level = sun.z / distance * hours;
            sum.beam_low_wh += level * clear.beam(elevation, terrain.lowest_m());
            sum.beam_high_wh += level * clear.beam(elevation, highest_m(terrain));
            sum.diffuse_wh += hours * clear.diffuse(elevation);
        }
    };
    parallel_for(0, nodes_.count(), 1, [&](int first, int last) {
        for (int node = first; node < last; ++node)
            find(node);
    });
}

OpenSky::Energy OpenSky::at(double column, double row) const {
    const Nodes::Around around = nodes_.around(column, row);
    Energy energy;
    for (std::size_t k = 0; k < 4; ++k) {
        const Energy& node = energies_[around.node[k]];
        energy.beam_low_wh += around.weight[k] * node.beam_low_wh;
        energy.beam_high_wh += around.weight[k] * node.beam_high_wh;
        energy.diffuse_wh += around.weight[k] * node.diffuse_wh;
    }
    return energy;
}

SkyLight::SkyLight(const SunTerrain& terrain, sun::Instant begin, double length_s,
                   const SunHoursOptions& options)
    : options_(options),
      plan_(terrain.given(), {options.refraction, {}}, options.part),
      open_(terrain, begin, length_s, options.irradiation->linke) {
    add_sky_view_directions(plan_, options.irradiation->sky_directions);
}

void SkyLight::add(const Window& of, SunHours& result) const {
    SkyViewOptions of_sky;
    of_sky.directions = options_.irradiation->sky_directions;
    of_sky.refraction = options_.refraction;
    of_sky.part = of;
    of_sky.plane = options_.irradiation->plane;
    const SkyView view = sky_view(plan_, of_sky);
    const SunTerrain& terrain = plan_.terrain();
    const Window part = terrain.window_of(of);
    const WindowHeights heights(terrain.posts(), part);
    const double albedo = options_.irradiation->albedo;
    const auto add_post = [&](int x, int y) {
        const OpenSky::Energy energy = open_.at(part.column + x, part.row + y);
        const double height_m = heights.at(part.column + x, part.row + y);
        const double level_wh = energy.beam_low_wh + air_left(terrain, height_m) *
                                                         (energy.beam_high_wh - energy.beam_low_wh);
        const double share = view.share.at(x, y);  // NaN in holes
        result.diffuse_kwh.at(x, y) = static_cast<float>(energy.diffuse_wh * share / 1000);
        result.reflected_kwh.at(x, y) =
            static_cast<float>(albedo * (level_wh + energy.diffuse_wh) * (1 - share) / 1000);
        float& beam = result.beam_kwh.at(x, y);
        beam = std::isnan(share) ? std::numeric_limits<float>::quiet_NaN() : beam / 1000;
    };
    parallel_for(0, part.rows, 16, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < part.columns; ++x)
                add_post(x, y);
    });
}

}  // namespace relevo::light
