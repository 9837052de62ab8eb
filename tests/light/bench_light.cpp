// How fast horizons and direct light are found. Run on an idle machine, in Release: build/release
// is without tests, so
//   cmake -B build/bench -DCMAKE_BUILD_TYPE=Release -DRELEVO_TESTS=ON &&
//   build/bench/bin/bench_light

#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>

#include "base/units.h"
#include "dem/load.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"
#include "light/sweep/kernels.h"
#include "light/sweep/sweep.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light {
namespace {

/// The bundled DEM, or $RELEVO_BENCH_DEM.
const dem::Heightfield& field() {
    static const dem::Heightfield loaded = [] {
        const char* given = std::getenv("RELEVO_BENCH_DEM");
        return dem::load(given ? given
                               : (test::source_dir() / "data" / "dem" / "jacksboro.tif").string());
    }();
    return loaded;
}

geo::Geodetic middle() {
    return field().grid.place((field().grid.columns() - 1) / 2, (field().grid.rows() - 1) / 2);
}

void horizon_viewpoint(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(TerrainHorizon(field(), middle()).eye_m());
}
BENCHMARK(horizon_viewpoint)->Unit(benchmark::kMillisecond);

void horizon_direction(benchmark::State& state) {
    const TerrainHorizon horizon(field(), middle());
    double azimuth_rad = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(horizon.elevation_rad(azimuth_rad += 0.01));
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(horizon_direction)->Unit(benchmark::kMicrosecond);

/// A viewpoint and one direction, as walks ask for them: of a fan, and followed by itself.
void horizon_of_one_direction(benchmark::State& state) {
    const dem::Posts posts(field());
    HorizonOptions options;
    options.few_directions = state.range(0) != 0;
    double azimuth_rad = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            TerrainHorizon(posts, middle(), options).elevation_rad(azimuth_rad += 0.01));
}
BENCHMARK(horizon_of_one_direction)->Arg(0)->Arg(1)->ArgName("few")->Unit(benchmark::kMicrosecond);

void horizon_profile(benchmark::State& state) {
    const TerrainHorizon horizon(field(), middle());
    for (auto _ : state)
        benchmark::DoNotOptimize(horizon.profile(static_cast<int>(state.range(0))));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(horizon_profile)->Arg(3600)->Arg(18000)->Unit(benchmark::kMillisecond);

/// One sun over all posts; items are posts, each a cell-step.
/// @param state  azimuth from the grid's north, floats of vectors
void sweep_moment(benchmark::State& state) {
    const Array2d<float>& height_m = field().height_m;
    const Sweep sweep(height_m.data(), height_m.width(), height_m.height(), height_m.width());
    const glm::dvec2 spacing_m = field().grid.post_spacing_m();
    const double azimuth_rad = radians(static_cast<double>(state.range(0)));
    const SweepSun sun =
        sun_over_map(spacing_m, {std::sin(azimuth_rad), -std::cos(azimuth_rad)}, radians(20),
                     {height_m.width() / 2, height_m.height() / 2}, 0.87 / 6371000);
    Array2d<float> shadow_m(height_m.width(), height_m.height());
    set_widest_vector(static_cast<int>(state.range(1)));
    for (auto _ : state)
        sweep.each_shadow(sun, {{0, 0, shadow_m.width(), shadow_m.height()}}, Sweep::kNoFloor_m,
                          [&](const SweepRun& run) {
                              std::copy_n(run.found, run.count, &shadow_m.at(run.column, run.row));
                          });
    set_widest_vector(kVectorFloats);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(shadow_m.size()));
}
BENCHMARK(sweep_moment)
    ->ArgsProduct({{0, 135, 160, 250}, {4, 8, 16}})
    ->ArgNames({"azimuth", "floats"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Light and shade of a moment, each place with its own sun.
void shadows_moment(benchmark::State& state) {
    const dem::Posts posts(field());
    const SunOverDem sun{radians(135), radians(20), radians(0.266)};
    ShadowOptions options;
    options.soft = state.range(0) != 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(shadows(posts, sun, options).lit_posts);
    state.SetItemsProcessed(state.iterations() *
                            static_cast<std::int64_t>(field().height_m.size()));
}
BENCHMARK(shadows_moment)
    ->Arg(0)
    ->Arg(1)
    ->ArgName("soft")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Hours of a day from suns 3 minutes apart; items are posts.
void hours_of_a_day(benchmark::State& state) {
    const dem::Posts posts(field());
    const sun::Instant begin = sun::parse_time("2026-06-21T08:00Z", {}).utc;
    SunHoursOptions options;
    options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    for (auto _ : state)
        benchmark::DoNotOptimize(sun_hours(posts, begin, begin + 86400.0, options).mean_hours);
}
BENCHMARK(hours_of_a_day)->Unit(benchmark::kMillisecond)->UseRealTime();

void hours_of_a_year(benchmark::State& state) {
    const dem::Posts posts(field());
    const sun::Instant begin = sun::parse_time("2026-01-01T08:00Z", {}).utc;
    for (auto _ : state)
        benchmark::DoNotOptimize(sun_hours(posts, begin, begin + 365 * 86400.0).mean_hours);
}
BENCHMARK(hours_of_a_year)->Unit(benchmark::kMillisecond)->UseRealTime();

void horizons_36(benchmark::State& state) {
    const dem::Posts posts(field());
    std::vector<double> azimuths;
    for (int i = 0; i < 36; ++i)
        azimuths.push_back(radians(10.0 * i));
    for (auto _ : state)
        benchmark::DoNotOptimize(horizons(posts, azimuths).holes);
}
BENCHMARK(horizons_36)->Unit(benchmark::kMillisecond)->UseRealTime();

void sky_view_36(benchmark::State& state) {
    const dem::Posts posts(field());
    for (auto _ : state)
        benchmark::DoNotOptimize(sky_view(posts).mean);
}
BENCHMARK(sky_view_36)->Unit(benchmark::kMillisecond)->UseRealTime();

/// The same by the exact horizon of each post: a few of them, for the ratio.
void shadows_by_horizons(benchmark::State& state) {
    const dem::Posts posts(field());
    const dem::Grid& grid = posts.grid();
    int i = 0;
    for (auto _ : state) {
        i = (i + 7919) % (grid.columns() * grid.rows());
        const TerrainHorizon horizon(posts, grid.place(i % grid.columns(), i / grid.columns()));
        benchmark::DoNotOptimize(horizon.elevation_rad(radians(135)));
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(shadows_by_horizons)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace relevo::light

BENCHMARK_MAIN();
