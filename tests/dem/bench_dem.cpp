#include <cmath>

#include <benchmark/benchmark.h>

#include "dem/load.h"
#include "support/support.h"

// What loading and placing cost. `bench_dem` runs on the outside test data where it is there.

namespace relevo::dem {
namespace {

std::string file(const char* name) {
    const auto dir = test::test_data_dir();
    return dir ? (*dir / "dem" / name).string() : std::string();
}

void load_file(benchmark::State& state, const char* name) {
    const std::string path = file(name);
    if (path.empty()) {
        state.SkipWithError("needs the outside test data; set RELEVO_TEST_DATA");
        return;
    }
    for (auto _ : state)
        benchmark::DoNotOptimize(load(path).height_m.data());
}
BENCHMARK_CAPTURE(load_file, plain_1197x643, "srtm_bigtujunga30m_utm11.tif")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(load_file, deflated_3600x3600, "tyrol_aw3d30_n47e011_1s_cog.tif")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void read_reduced(benchmark::State& state, const char* name) {
    const std::string path = file(name);
    if (path.empty()) {
        state.SkipWithError("needs the outside test data; set RELEVO_TEST_DATA");
        return;
    }
    const Source source = Source::open(path);
    const Window all{0, 0, source.grid().columns(), source.grid().rows()};
    for (auto _ : state)
        benchmark::DoNotOptimize(source.read(all, all.columns / 8, all.rows / 8).data());
}
BENCHMARK_CAPTURE(read_reduced, overview_450x450, "tyrol_aw3d30_n47e011_1s_cog.tif")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(read_reduced, means_149x80, "srtm_bigtujunga30m_utm11.tif")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void place_net(benchmark::State& state, const char* crs, double x, double y, bool batch) {
    const Grid grid(1000, 1000, {x, 30, 0, y, 0, -30}, geo::Crs::parse(crs, "bench"));
    std::vector<glm::dvec2> posts;
    for (int i = 0; i < 33 * 33; ++i)
        posts.emplace_back(i % 33 * 30, i / 33 * 30);
    std::vector<geo::Geodetic> places(posts.size());
    for (auto _ : state) {
        if (batch)
            grid.place(posts, places);
        else
            for (std::size_t i = 0; i < posts.size(); ++i)
                places[i] = grid.place(posts[i].x, posts[i].y);
        benchmark::DoNotOptimize(places.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(posts.size()));
}
BENCHMARK_CAPTURE(place_net, utm_batch, "EPSG:32632", 500000, 5200000, true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(place_net, utm_single, "EPSG:32632", 500000, 5200000, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(place_net, shifted_datum_batch, "EPSG:31287", 270000, 370000, true)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace relevo::dem

BENCHMARK_MAIN();
