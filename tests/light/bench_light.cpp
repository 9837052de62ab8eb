// How fast horizons and direct light are found. Run on an idle machine, in Release: build/release
// is without tests, so
//   cmake -B build/bench -DCMAKE_BUILD_TYPE=Release -DRELEVO_TESTS=ON &&
//   build/bench/bin/bench_light

#include <benchmark/benchmark.h>

#include "base/units.h"
#include "dem/load.h"
#include "light/horizon.h"
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

void horizon_profile(benchmark::State& state) {
    const TerrainHorizon horizon(field(), middle());
    for (auto _ : state)
        benchmark::DoNotOptimize(horizon.profile(static_cast<int>(state.range(0))));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(horizon_profile)->Arg(3600)->Arg(18000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relevo::light

BENCHMARK_MAIN();
