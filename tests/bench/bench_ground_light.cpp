// How long textures of a moved sun take, computed by the processor and by the device. Run on an
// idle machine, in Release (bench_sun.cpp); RELEVO_BENCH_DEVICE is a device as --device takes it.

#include <cmath>
#include <cstdlib>

#include <benchmark/benchmark.h>

#include "base/units.h"
#include "dem/heightfield.h"
#include "dem/posts.h"
#include "gl/context.h"
#include "light/raster/clearance.h"
#include "render/ground.h"
#include "render/ground_light.h"
#include "sun/refraction.h"

namespace relevo::render {
namespace {

/// Mountains of 30 m posts, as many each way.
dem::Heightfield mountains(int side) {
    Array2d<float> height_m(side, side);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            height_m.at(column, row) = static_cast<float>(
                1500 + 700 * std::sin(0.031 * column) * std::cos(0.023 * row) +
                150 * std::sin(0.17 * column + 0.11 * row) + 20 * std::sin(0.9 * column - row));
    dem::Description about;
    about.statistics = dem::statistics(height_m);
    return {std::move(height_m),
            dem::Grid(side, side, {500000, 30, 0, 5200000, 0, -30},
                      geo::Crs::parse("EPSG:32632", "bench")),
            about};
}

void moved_sun(benchmark::State& state, ShadowsOn where) {
    const char* const device = std::getenv("RELEVO_BENCH_DEVICE");
    gl::Context context({.device = device ? device : "auto"});
    const dem::Heightfield field = mountains(static_cast<int>(state.range(0)));
    const Ground ground = make_ground(field);
    GroundLight light(field, ground.frame, {}, where);
    const geo::Geodetic place = field.grid.center();
    double azimuth_deg = 100;
    const auto move = [&] {
        sun::Position position;
        position.azimuth_rad = radians(azimuth_deg += 1);
        position.elevation_rad = radians(20);
        position.semidiameter_rad = sun::semidiameter_rad(1);
        const glm::dvec2 level(std::sin(position.azimuth_rad), std::cos(position.azimuth_rad));
        SunLight sun =
            make_sun_light(position, sun::Refraction::standard(place), ground, field.grid);
        sun.direction = {level * std::cos(position.elevation_rad),
                         std::sin(position.elevation_rad)};
        light.update_shadows(sun, 1);
        context.finish();
    };
    move();
    for (auto _ : state)
        move();
    state.SetLabel(context.info().renderer);
    if (light.is_computed_on_device() != (where == ShadowsOn::Device))
        state.SkipWithError("fell back");
}
BENCHMARK_CAPTURE(moved_sun, processor, ShadowsOn::Processor)
    ->Arg(1200)
    ->Arg(3600)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(moved_sun, device, ShadowsOn::Device)
    ->Arg(1200)
    ->Arg(3600)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// What the processor does for the device: tiles and tables of a sun.
void tables(benchmark::State& state) {
    const dem::Heightfield field = mountains(static_cast<int>(state.range(0)));
    const dem::Posts posts(field);
    const light::Clearances clearances(posts, {});
    double azimuth_deg = 100;
    for (auto _ : state)
        clearances.each_sweep(field.grid.center(),
                              {radians(azimuth_deg += 1), radians(20), sun::semidiameter_rad(1)},
                              [](const auto& sweep) { benchmark::DoNotOptimize(&sweep); });
}
BENCHMARK(tables)->Arg(1200)->Arg(3600)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace relevo::render

BENCHMARK_MAIN();
