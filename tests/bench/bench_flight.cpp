// How even the frames of a flight are: 60 s eastwards, 300 m above the ground, while tiles load in
// the background as they do in the window.
//
// Usage: bench_flight DEM [FRAMES] [SPEED] [WIDTHxHEIGHT]. FRAMES of the 60 s (600), SPEED in m/s
// (100). Prints figures and fails nothing. Processor time is that of all threads, so also that of
// loading.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/files_in_use.h"
#include "base/units.h"
#include "geo/ellipsoid.h"
#include "session/session.h"

namespace {

using namespace relevo;

constexpr double kSeconds = 60, kAbove_m = 300, kLead_s = 4;

double clock_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double processor_ms() {
    return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Places along a parallel, as far east of the DEM's middle as west, with heights that stay above
/// the ground of the next seconds and change slowly.
std::vector<geo::Geodetic> path_over(const session::Session& session, int frames,
                                     double speed_m_s) {
    const scene::GroundHeight ground_m = session.heights_to_aim_at();
    const geo::Geodetic middle = session.dem()->source->grid().center();
    const double metre_rad = 1 / (geo::kEquatorialRadius_m * std::cos(middle.lat_rad));
    std::vector<geo::Geodetic> path(static_cast<std::size_t>(frames), middle);
    for (int i = 0; i < frames; ++i) {
        geo::Geodetic& place = path[static_cast<std::size_t>(i)];
        place.lon_rad += metre_rad * speed_m_s * kSeconds * (double(i) / frames - 0.5);
        place.height_m = ground_m(place);
    }
    const int lead = std::max(1, static_cast<int>(kLead_s * frames / kSeconds));
    const auto over_windows = [&](const auto& combine) {
        const std::vector<geo::Geodetic> before = path;
        for (int i = 0; i < frames; ++i) {
            const auto first = before.begin() + std::max(0, i - lead),
                       last = before.begin() + std::min(frames, i + lead + 1);
            path[static_cast<std::size_t>(i)].height_m = combine(first, last);
        }
    };
    over_windows([](auto first, auto last) {
        return std::max_element(
                   first, last,
                   [](const auto& a, const auto& b) { return a.height_m < b.height_m; })
            ->height_m;
    });
    over_windows([](auto first, auto last) {
        double sum_m = 0;
        for (auto at = first; at != last; ++at)
            sum_m += at->height_m;
        return kAbove_m + sum_m / static_cast<double>(last - first);
    });
    return path;
}

void print(const char* what, std::vector<double> ms) {
    std::ranges::sort(ms);
    const double median = ms[ms.size() / 2];
    const auto at = [&](double share) {
        return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
    };
    const auto below = std::ranges::lower_bound(ms, 2 * median) - ms.begin();
    fmt::print(
        "{}: median {:.1f} ms, 99 % within {:.1f}, 99.5 % within {:.1f}, worst {:.1f}; {:.2f} % of "
        "frames "
        "below twice the median\n",
        what, median, at(0.99), at(0.995), ms.back(),
        100.0 * static_cast<double>(below) / static_cast<double>(ms.size()));
}

}  // namespace

int main(int count, char** words) {
    scene::Scene scene;
    scene.dems = {count > 1 ? words[1] : "data/dem/jacksboro.tif"};
    const int frames = count > 2 ? std::atoi(words[2]) : 600;
    const double speed_m_s = count > 3 ? std::atof(words[3]) : 100;
    scene.width_px = 1280;
    scene.height_px = 1024;
    if (count > 4) std::sscanf(words[4], "%dx%d", &scene.width_px, &scene.height_px);
    scene.time = {"2026-06-21T10:00", "", ""};
    FilesInUse files;
    session::Session session(scene, {}, files);
    session.link_rest();
    scene::View view;
    view.heading_deg = 90;
    view.pitch_deg = -5;
    const std::vector<geo::Geodetic> path = path_over(session, frames, speed_m_s);
    std::vector<double> by_clock_ms, of_processor_ms;
    int incomplete = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        view.eye = {path[i], false};
        const double began_ms = clock_ms(), used_ms = processor_ms();
        scene::Scene next = session.scene();
        next.view = view;
        session.show(next, session.time(), {.exact = false});
        if (i == 0) {  // after loading
            session.draw();
            glFinish();
            continue;
        }
        incomplete += !session.draw_available();
        glFinish();
        by_clock_ms.push_back(clock_ms() - began_ms);
        of_processor_ms.push_back(processor_ms() - used_ms);
    }
    fmt::print("{} frames of {}x{}, {:g} m/s, {} of them while tiles were loading, {}\n",
               by_clock_ms.size(), scene.width_px, scene.height_px, speed_m_s, incomplete,
               session.device().renderer);
    print("clock", by_clock_ms);
    print("processor", of_processor_ms);
}
