#include "cli/timings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <map>
#include <vector>

#include "base/memory_budget.h"
#include "cli/memory_use.h"
#include "cli/shared.h"
#include "dem/remote.h"

namespace relevo::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSunStep_s = 60;

/// What parts of the run may take, and the peak of the process.
Json memory_of(const MemoryBudget& memory) {
    const auto mib = [](std::int64_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(MemoryBudget::kMiB);
    };
    return {{"allowed", memory.mib()},
            {"tiles", mib(memory.view_bytes)},
            {"blocks", mib(memory.block_bytes)},
            {"work", mib(memory.work_bytes)},
            {"peak", peak_memory_mib()}};
}

/// Since a value of std::clock(), of all threads.
double processor_ms_since(std::clock_t began) {
    return 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void move_sun(session::Session& session, double step_s) {
    if (step_s <= 0) return;
    session.show(session.scene(), session.time() + step_s, {.exact = false});
}

/// @param step_s  by which the sun moves
/// @returns passes of one frame; "sun" is what the moved sun takes before the first of them
render::PassTimes timed_frame(session::Session& session, double step_s) {
    render::PassTimes times;
    const auto began = Clock::now();
    const std::clock_t processor_began = std::clock();
    move_sun(session, step_s);
    const render::PassTime sun{"sun", milliseconds_since(began),
                               processor_ms_since(processor_began)};
    session.draw_alone(&times);
    if (step_s > 0) times.insert(times.begin(), sun);
    return times;
}

/// Medians of each pass, of frames of their own: to time a pass is to wait for the one before.
Json passes_of(session::Session& session, int repeat, double step_s) {
    std::vector<std::string> order;
    std::map<std::string, std::array<std::vector<double>, 2>> of;
    for (int i = 0; i < repeat; ++i) {
        for (const render::PassTime& time : timed_frame(session, step_s)) {
            auto& [ms, processor_ms] = of[time.pass];
            if (ms.empty()) order.push_back(time.pass);
            ms.push_back(time.ms);
            processor_ms.push_back(time.processor_ms);
        }
    }
    Json passes = Json::object();
    for (const std::string& pass : order)
        passes[pass] = {{"ms", median(of[pass][0])}, {"processor_ms", median(of[pass][1])}};
    return passes;
}

/// @param step_s  by which the sun moves before each frame
Json frames(session::Session& session, int repeat, double step_s) {
    std::vector<double> frames_ms;
    const std::clock_t processor_began = std::clock();
    for (int i = 0; i < repeat; ++i) {
        const auto began = Clock::now();
        move_sun(session, step_s);
        session.draw_alone();
        frames_ms.push_back(milliseconds_since(began));
    }
    const double processor_ms = processor_ms_since(processor_began);
    return {{"count", frames_ms.size()},
            {"min_ms", *std::ranges::min_element(frames_ms)},
            {"median_ms", median(frames_ms)},
            {"max_ms", *std::ranges::max_element(frames_ms)},
            {"processor_ms", processor_ms / static_cast<double>(frames_ms.size())},
            {"passes", passes_of(session, repeat, step_s)}};
}

}  // namespace

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

void Timings::add_picture(double took_ms) {
    double passes_ms = 0;
    for (const render::PassTime& pass : passes_)
        passes_ms += pass.ms;
    add("passes", passes_ms);
    add("readback", std::max(took_ms - passes_ms, 0.0));
}

void Timings::write(session::Session& session, int repeat) {
    if (!file_) return;
    Json json;
    json["device"] = session.device().renderer;
    json["triangles"] = session.triangles();
    json["stages_ms"] = stages_;
    json["whole_ms"] = milliseconds_since(began_);
    json["ev100"] = session.ev100();
    json["memory_mib"] = memory_of(session.scene().dem.memory);
    if (const auto net = dem::network_use())
        json["net"] = {{"requests", net->requests}, {"read_bytes", net->read_bytes}};
    Json& passes = json["passes_ms"] = Json::object();
    for (const render::PassTime& pass : passes_)
        passes[pass.pass] = pass.ms;
    if (repeat > 0) {
        json["frames"] = frames(session, repeat, 0);
        json["frames_with_sun_moved"] = frames(session, repeat, kSunStep_s);
    }
    file_->write(json_text(json));
}

}  // namespace relevo::cli
