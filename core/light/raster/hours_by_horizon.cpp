#include "light/raster/hours_by_horizon.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/raster/post_loops.h"
#include "light/raster/shadow_heights.h"

namespace relevo::light {
namespace {

constexpr double kTolerance_rad = radians(0.1);  // of suns that are put together anyway

/// Where a post's horizon is in a direction's tables.
struct Entry {
    std::size_t below;
    float part;  // on to the next entry

    float of(const float* over) const {
        return over[below] + part * (over[below + 1] - over[below]);
    }
};

/// By how much the sun is higher at posts than in the middle of a block, as the ground turns
/// towards it: linear over a tile.
struct Lift {
    double at_reference_rad;
    glm::dvec2 reference, per_post;

    Lift(const SunField& field, const SunTile& tile) : reference(tile.ray.reference) {
        const auto elevation = [&](double column, double row) {
            return field.at(glm::dvec2(column, row)).elevation_rad;
        };
        const auto [x, y] = std::pair(reference.x, reference.y);
        at_reference_rad = elevation(x, y);
        per_post = {(elevation(x + 1, y) - elevation(x - 1, y)) / 2,
                    (elevation(x, y + 1) - elevation(x, y - 1)) / 2};
    }
    double at(double column, double row) const {
        return at_reference_rad + per_post.x * (column - reference.x) +
               per_post.y * (row - reference.y);
    }
};

}  // namespace

HorizonHours::HorizonHours(const SunPlan& plan, sun::Instant begin, double length_s,
                           const SunHoursOptions& options)
    : plan_(plan),
      terrain_(plan.terrain()),
      options_(options),
      begin_(begin),
      length_s_(length_s),
      table_(begin, begin + length_s) {
    for (const Window& each : SunPlan::blocks(terrain_))
        if (!common(each, plan.window()).is_empty()) blocks_.push_back(block_of(each));
}

int HorizonHours::most_tiles() const {
    std::size_t most = 0;
    for (const Block& block : blocks_)
        for (const Direction& direction : block.directions)
            most = std::max(most, direction.sun.tiles.size());
    return static_cast<int>(most);
}

HorizonHours::Block HorizonHours::block_of(const Window& window) const {
    Block block{window, terrain_.grid().place(window.column + (window.columns - 1) / 2.0,
                                              window.row + (window.rows - 1) / 2.0)};
    const std::shared_ptr<const Tables> tables = tables_of(block);
    for (std::size_t k = 0; k < tables->size(); ++k)
        if (const DirectionTable& low = (*tables)[k].front(); !low.empty())
            block.directions.push_back(
                {k, {0, SunField::level(terrain_, block.middle, low.azimuth_rad())}});
    parallel_for(0, static_cast<int>(block.directions.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            Direction& direction = block.directions[static_cast<std::size_t>(i)];
            direction.sun = plan_.planned(direction.sun.field, window, kTolerance_rad);
        }
    });
    return block;
}

std::shared_ptr<const HorizonHours::Tables> HorizonHours::tables_of(const Block& block) const {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const auto& kept) { return kept.first == block.window; });
    if (found != kept_.end()) {
        std::rotate(kept_.begin(), found, found + 1);
    } else {
        if (kept_.size() == kMostKept) kept_.pop_back();
        kept_.insert(kept_.begin(),
                     {block.window, std::make_shared<const Tables>(tables_over(block.middle))});
    }
    return kept_.front().second;
}

HorizonHours::Sample HorizonHours::sample(double from_s, double until_s,
                                          const sun::Observer& observer) const {
    const glm::dvec3 towards_au = table_.vector_au(begin_ + (from_s + until_s) / 2, observer);
    Sample sun{sun::azimuth_of(towards_au),
               sun::elevation_of(towards_au),
               (until_s - from_s) / kHour_s,
               {},
               {}};
    if (sun.elevation_rad < DirectionTable::kLowest_rad) return sun;
    for (const SunTerrain::Air air : {SunTerrain::kOfLowest, SunTerrain::kOfHighest}) {
        sun.apparent_rad[air] = terrain_.apparent_rad(sun.elevation_rad, air);
        if (!options_.irradiation) continue;
        const double height_m =
            terrain_.lowest_m() +
            (air == SunTerrain::kOfLowest ? 0 : std::max(1.0, terrain_.relief_m()));
        sun.beam_wh[air] =
            sun.hours * ClearSky(options_.irradiation->linke, glm::length(towards_au))
                            .beam(sun.elevation_rad, height_m);
    }
    return sun;
}

HorizonHours::Tables HorizonHours::tables_over(const geo::Geodetic& middle) const {
    Tables tables(kDirections);
    const sun::Observer observer(middle);
    const double step_s = length_s_ > 40 * kDay_s ? 120 : 60;
    const auto steps = static_cast<std::int64_t>(std::ceil(length_s_ / step_s - 1e-9));
    const auto add = [&](const Sample& sun) {
        if (sun.elevation_rad < DirectionTable::kLowest_rad) return;
        const double turns = sun.azimuth_rad / (2 * kPi);
        const auto k = std::min(kDirections - 1,
                                static_cast<std::size_t>(turns * static_cast<double>(kDirections)));
        for (std::size_t air = 0; air < 2; ++air)
            tables[k][air].add(sun.azimuth_rad, sun.apparent_rad[air], sun.hours,
                               sun.beam_wh[air] * std::cos(sun.elevation_rad),
                               sun.beam_wh[air] * std::sin(sun.elevation_rad));
    };
    // On several threads, some at once; they are added in their order.
    constexpr std::int64_t kTogether = 1 << 14;
    std::vector<Sample> samples;
    for (std::int64_t done = 0; done < steps; done += kTogether) {
        samples.resize(static_cast<std::size_t>(std::min(kTogether, steps - done)));
        parallel_for(0, static_cast<int>(samples.size()), 256, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const double from_s = static_cast<double>(done + i) * step_s;
                samples[static_cast<std::size_t>(i)] =
                    sample(from_s, std::min(from_s + step_s, length_s_), observer);
            }
        });
        for (const Sample& sun : samples)
            add(sun);
    }
    for (AirTables& of_airs : tables)
        for (DirectionTable& table : of_airs)
            table.sum_up();
    return tables;
}

void HorizonHours::add(const Window& part, SunHours& result) const {
    Ground ground{WindowHeights(terrain_.posts(), part), std::nullopt};
    if (options_.irradiation) {
        ground.inclined.emplace(terrain_, part, options_.irradiation->plane);
        ground.air = Array2d<float>(part.columns, part.rows);
        for (int y = 0; y < part.rows; ++y)
            for (int x = 0; x < part.columns; ++x)
                ground.air.at(x, y) = static_cast<float>(
                    air_left(terrain_, ground.heights.at(part.column + x, part.row + y)));
    }
    const auto work_of = [&](const Block& block) {
        const Window some = common(block.window, part);
        return double(some.columns) * some.rows;
    };
    double all = 0;
    for (const Block& block : blocks_)
        all += work_of(block) * static_cast<double>(block.directions.size());
    for (const Block& block : blocks_) {
        const double work = work_of(block);
        if (work == 0) continue;
        const std::shared_ptr<const Tables> tables = tables_of(block);
        for (const Direction& direction : block.directions) {
            add_direction(direction, (*tables)[direction.number], part, ground, result);
            if (options_.done) options_.done(work / all);
        }
    }
}

void HorizonHours::add_direction(const Direction& direction, const AirTables& tables,
                                 const Window& part, const Ground& ground, SunHours& result) const {
    using Places = std::array<float, kLongestRun>;  // in a table
    const auto& [low, high] = tables;
    const auto bottom_m = static_cast<float>(terrain_.lowest_m()),
               a_metre = static_cast<float>(1 / std::max(1.0, terrain_.relief_m()));
    const glm::vec3 towards(direction.sun.field.direction());
    const auto add_beam = [&](const Entry& entry, float lift, int x, int y) {
        const auto between = [&](const float* in_low, const float* in_high) {
            const float l = entry.of(in_low);
            return l + ground.air.at(x, y) * (entry.of(in_high) - l);
        };
        const float level = between(low.level_wh_over(), high.level_wh_over()),
                    up = between(low.up_wh_over(), high.up_wh_over());
        const glm::vec3 gradient = ground.inclined->slope.at(x, y);
        // The sun stands higher there by the lift.
        const float onto = (up + lift * level) - glm::dot(gradient, towards) * (level - lift * up);
        const float gain = onto * cosine_of(gradient);
        result.beam_kwh.at(x, y) += gain > 0 ? gain : 0;
    };
    std::vector<Lift> lifts;
    for (const SunTile& tile : direction.sun.tiles)
        lifts.emplace_back(direction.sun.field, tile);
    const SunTile* const first_tile = direction.sun.tiles.data();
    each_horizon(direction.sun, part, [&](const SunTile& tile, const SweepRun& run) {
        const Lift& lift = lifts[static_cast<std::size_t>(&tile - first_tile)];
        const float* const height_m = ground.heights.view.at(run.column, run.row);
        // Counted from the reference, so that a post has the same bits in every run.
        const int from = run.column - static_cast<int>(lift.reference.x);
        const auto base = static_cast<float>(lift.at(lift.reference.x, run.row)),
                   a_post = static_cast<float>(lift.per_post.x);
        const auto find = [&](const float* tangents, Places& places) {
            find_entries(tangents, run.count,
                         base + static_cast<float>(DirectionTable::kLowest_rad), a_post, from,
                         static_cast<float>(DirectionTable::kEntry_rad), DirectionTable::kEntries,
                         places.data());
        };
        const auto entry_at = [](float place) {
            const float whole = std::floor(place);
            return Entry{static_cast<std::size_t>(whole), place - whole};
        };
        Places at, of_beams;
        find(run.found, at);
        const int x = run.column - part.column, y = run.row - part.row;
        const bool has_plane = ground.inclined && options_.irradiation->plane;
        if (has_plane)
            find(raised_over_planes(run, ground.inclined->slope, {x, y}, towards).data(), of_beams);
        for (int i = 0; i < run.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Entry entry = entry_at(at[k]);
            const float in_low = entry.of(low.hours_over()), in_high = entry.of(high.hours_over());
            result.hours.at(x + i, y) +=
                in_low + (height_m[i] - bottom_m) * a_metre * (in_high - in_low);
            if (ground.inclined)
                add_beam(has_plane ? entry_at(of_beams[k]) : entry,
                         base + a_post * static_cast<float>(from + i), x + i, y);
        }
    });
}

}  // namespace relevo::light
