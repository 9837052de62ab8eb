#include <cmath>
#include <cstdlib>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/text.h"
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

/// One DEM of any size: `$RELEVO_BENCH_DEM`, its files with blanks between.
std::vector<std::string> given_files() {
    const char* files = std::getenv("RELEVO_BENCH_DEM");
    return files ? split(files, ' ') : std::vector<std::string>();
}

void open_given(benchmark::State& state) {
    const std::vector<std::string> files = given_files();
    if (files.empty()) state.SkipWithError("set RELEVO_BENCH_DEM to the files of a DEM");
    for (auto _ : state)
        benchmark::DoNotOptimize(Source::open(files).grid().columns());
}
BENCHMARK(open_given)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Windows of 512 x 512 posts all over it, each post covering `state.range(0)` squared of the
/// file's.
void read_windows(benchmark::State& state) {
    const std::vector<std::string> files = given_files();
    if (files.empty()) {
        state.SkipWithError("set RELEVO_BENCH_DEM to the files of a DEM");
        return;
    }
    const Source source = Source::open(files);
    const int side = static_cast<int>(512 * state.range(0));
    const int across = source.grid().columns() / side, down = source.grid().rows() / side;
    int i = 0;
    for (auto _ : state) {
        // A stride that visits all, seldom neighbours.
        i = (i + 37) % (across * down);
        benchmark::DoNotOptimize(
            source.read({i % across * side, i / across * side, side, side}, 512, 512).data());
    }
}
BENCHMARK(read_windows)
    ->Arg(1)
    ->Arg(2)
    ->Arg(8)
    ->Arg(16)
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
