// Prints the mean hours of direct sun over a DEM on a day: sun_hours DEM DATE
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <relevo/relevo.h>

namespace {

void check(relevo_result result) {
    if (result != RELEVO_RESULT_OK) throw std::runtime_error(relevo_error());
}

struct CloseDem {
    void operator()(relevo_dem* dem) const { relevo_dem_close(dem); }
};
using Dem = std::unique_ptr<relevo_dem, CloseDem>;

Dem open(const char* file) {
    relevo_dem* dem = nullptr;
    check(relevo_dem_open(&file, 1, nullptr, &dem));
    return Dem(dem);
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 3) throw std::runtime_error("usage: sun_hours DEM DATE");
    const Dem dem = open(argv[1]);
    relevo_grid grid{};
    grid.size = sizeof grid;
    check(relevo_dem_grid(dem.get(), &grid));

    std::vector<float> hours(static_cast<std::size_t>(grid.columns) *
                             static_cast<std::size_t>(grid.rows));
    const std::string options = std::string("{\"date\": \"") + argv[2] + "\"}";
    check(
        relevo_sun_hours(dem.get(), options.c_str(), hours.data(), hours.size(), nullptr, nullptr));
    double sum = 0, posts = 0;
    for (const float value : hours)
        if (!std::isnan(value)) {
            sum += double{value};
            posts += 1;
        }
    std::printf("%.2f h\n", sum / posts);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
