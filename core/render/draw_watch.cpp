#include "render/draw_watch.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shader/loops.h"

namespace relevo::render {
namespace {

/// What a pixel or a triangle may take for each second of patience: at the usual 20 s that is a
/// hundred times as long as in a frame on two cores of a software renderer.
constexpr double kPart_share = 0.5e-6;

std::string disable(const std::set<std::string>& ids) {
    return fmt::format("--disable {} goes on without {}", fmt::join(ids, ","),
                       ids.size() == 1 ? "it" : "them");
}

}  // namespace

DrawWatch::Turn::Turn(std::optional<DrawWatch>& watch, const ProgramText& program, double parts)
    : watch_(watch ? &*watch : nullptr) {
    if (!watch_) return;
    const double patience_ms = static_cast<double>(patience().count());
    const double limit_ms = std::max(patience_ms, patience_ms * kPart_share * parts);
    watch_->watchdog_.start(
        std::chrono::milliseconds(static_cast<long>(limit_ms)),
        fmt::format("render: program {}: the device took more than {:g} s{}", program.name,
                    limit_ms / 1e3, watch_->blame(program.stitched)));
}

DrawWatch::Turn::~Turn() {
    if (watch_) watch_->watchdog_.stop();
}

std::string DrawWatch::blame(const shader::Stitched& stitched) const {
    std::set<std::string> present;
    for (const shader::HookUse& use : stitched.hooks)
        present.insert(use.providers.begin(), use.providers.end());
    if (present.empty()) return "";
    std::set<std::string> suspects;
    std::vector<std::string> loops;
    for (const shader::Snippet* snippet : snippets_) {
        if (present.count(snippet->id) == 0) continue;
        for (const int line : shader::open_loops(snippet->source)) {
            suspects.insert(snippet->id);
            loops.push_back(fmt::format("{}:{}", snippet->file, line));
        }
    }
    if (suspects.empty()) return fmt::format("; of the effects in it, {}", disable(present));
    return fmt::format("; {} may go on for ever; {}", fmt::join(loops, ", "), disable(suspects));
}

}  // namespace relevo::render
