// How fast the sun is found. Run on an idle machine, in Release: build/release is without tests, so
//   cmake -B build/bench -DCMAKE_BUILD_TYPE=Release -DRELEVO_TESTS=ON && build/bench/bin/bench_sun

#include <algorithm>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/events.h"
#include "sun/position.h"
#include "sun/position_table.h"
#include "sun/refraction.h"
#include "sun/zone.h"

namespace relevo::sun {
namespace {

const geo::Geodetic kPlace{radians(46.5), radians(8.0), 2000};
const Instant kFrom = Instant::from_utc({{2026, 1, 1}});
const Instant kTo = Instant::from_utc({{2027, 1, 1}});

void position_rigorous(benchmark::State& state) {
    Instant t = kFrom;
    for (auto _ : state)
        benchmark::DoNotOptimize(position(t = t + 60, kPlace));
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(position_rigorous);

void position_table_of_a_year(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(PositionTable(kFrom, kTo));
}
BENCHMARK(position_table_of_a_year)->Unit(benchmark::kMillisecond);

void direction_from_table(benchmark::State& state) {
    const PositionTable table(kFrom, kTo);
    const Observer observer(kPlace);
    Instant t = kFrom;
    for (auto _ : state) {
        benchmark::DoNotOptimize(table.direction(t, observer));
        t = t + 0.1;
        if (t > kTo) t = kFrom;
    }
    state.SetItemsProcessed(state.iterations());
    // Beside the speed what it costs: the distance from the rigorous direction.
    double worst_mas = 0;
    for (Instant at = kFrom; at < kTo; at = at + 40'000.7)
        worst_mas = std::max(
            worst_mas, glm::length(table.direction(at, observer) - position(at, kPlace).direction) /
                           1e-3 / kArcsecond_rad);
    state.counters["worst_milliarcsec"] = worst_mas;
}
BENCHMARK(direction_from_table);

void azimuth_and_elevation_from_table(benchmark::State& state) {
    const PositionTable table(kFrom, kTo);
    const Observer observer(kPlace);
    Instant t = kFrom;
    for (auto _ : state) {
        const glm::dvec3 v = table.vector_au(t, observer);
        benchmark::DoNotOptimize(azimuth_of(v));
        benchmark::DoNotOptimize(elevation_of(v));
        t = t + 0.1;
        if (t > kTo) t = kFrom;
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(azimuth_and_elevation_from_table);

void refraction_table(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(Refraction::standard(kPlace));
}
BENCHMARK(refraction_table)->Unit(benchmark::kMillisecond);

void refraction_lookup(benchmark::State& state) {
    const Refraction refraction = Refraction::standard(kPlace);
    double el_rad = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(refraction.apparent_rad(el_rad));
        el_rad += 1e-7;
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(refraction_lookup);

void events_of_a_day(benchmark::State& state) {
    const Zone zone = Zone::named("Europe/Zurich");
    for (auto _ : state)
        benchmark::DoNotOptimize(day_events({2026, 6, 21}, zone, kPlace));
}
BENCHMARK(events_of_a_day)->Unit(benchmark::kMillisecond);

void events_of_a_year(benchmark::State& state) {
    const Zone zone = Zone::named("Europe/Zurich");
    for (auto _ : state)
        benchmark::DoNotOptimize(day_events({2026, 1, 1}, {2026, 12, 31}, zone, kPlace));
}
BENCHMARK(events_of_a_year)->Unit(benchmark::kMillisecond);

void zone_by_name(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(Zone::named("Europe/Zurich"));
}
BENCHMARK(zone_by_name)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace relevo::sun

BENCHMARK_MAIN();
