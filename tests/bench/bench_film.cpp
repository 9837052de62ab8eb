// What a film costs: processor time of encoding, and of drawing its frames.
//
// Usage: bench_film [DEM] [FRAMES] [WIDTHxHEIGHT]. Prints figures and fails nothing.

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "film/film.h"
#include "session/scene_times.h"
#include "session/session.h"
#include "sun/event_time.h"

namespace {

namespace fs = std::filesystem;
using namespace relevo;

double processor_s() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The frames of a day from half an hour before sunrise to half an hour after sunset.
std::vector<image::Image8> day_frames(const std::string& dem, int frames, int width, int height) {
    scene::Scene scene;
    scene.dems = {dem};
    scene.width_px = width;
    scene.height_px = height;
    session::SceneTimes times;
    const auto at = [&](const char* event) {
        scene.time = {event, "2026-06-21", ""};
        return times.of(scene).utc;
    };
    const sun::Instant from = at("sunrise-30min"), to = at("sunset+30min");
    scene.view = times.settled_view(scene);
    FilesInUse files;
    session::Session session(scene, {.device = "software", .dem = times.loaded(scene)}, files);
    session.show(scene, from);
    session.draw();
    session.picture();
    std::vector<image::Image8> result;
    const double began_s = processor_s();
    for (int i = 0; i < frames; ++i) {
        session.show(scene, from + (to - from) * i / std::max(1, frames - 1));
        session.draw();
        result.push_back(session.picture());
    }
    fmt::print("drawing: {:.1f} ms of processor a frame ({} frames of {}x{}, {})\n",
               1e3 * (processor_s() - began_s) / frames, frames, width, height,
               session.device().renderer);
    return result;
}

void encode(const std::string& ending, const std::vector<image::Image8>& frames) {
    const fs::path path = fs::temp_directory_path() / ("bench_film." + ending);
    const double began_s = processor_s();
    {
        film::Film film(OutputFile(path, true, "bench"), frames[0].width, frames[0].height, {});
        for (const image::Image8& frame : frames)
            film.add(frame);
        film.finish();
    }
    const double took_s = processor_s() - began_s;
    fmt::print("{}: {:.1f} ms of processor a frame, {:.2f} MB\n", ending,
               1e3 * took_s / static_cast<double>(frames.size()),
               1e-6 * static_cast<double>(fs::file_size(path)));
    fs::remove(path);
}

}  // namespace

int main(int count, char** words) {
    const std::string dem = count > 1 ? words[1] : "data/dem/jacksboro.tif";
    const int number = count > 2 ? std::atoi(words[2]) : 300;
    int width = 1280, height = 720;
    if (count > 3) std::sscanf(words[3], "%dx%d", &width, &height);
    const std::vector<image::Image8> frames = day_frames(dem, number, width, height);
    for (const char* const ending : {"mp4", "webm", "webp", "gif"})
        encode(ending, frames);
}
