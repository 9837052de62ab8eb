#include "render/draw_watch.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/paths.h"
#include "shader/limits.h"

namespace relevo::render {
namespace {

/// Fraction of patience() per pixel or triangle. With 20 s it is 100 times the time on two cores of
/// a software renderer.
constexpr double kPart_share = 0.5e-6;

std::string disable(const std::set<std::string>& ids) {
    return fmt::format("--disable {} goes on without {}", fmt::join(ids, ","),
                       ids.size() == 1 ? "it" : "them");
}

/// Ids of the effects whose GLSL is in a program.
std::set<std::string> present_in(const shader::Stitched& stitched) {
    return {stitched.plugins.begin(), stitched.plugins.end()};
}

}  // namespace

DrawWatch::Turn::Turn(DrawWatch& watch, const ProgramText& program, double parts) : watch_(watch) {
    const double patience_ms = static_cast<double>(patience().count());
    const double limit_ms = std::max(patience_ms, patience_ms * kPart_share * parts);
    const std::string blamed = watch_.blame(program.stitched);
    watch_.watchdog_.start(std::chrono::milliseconds(static_cast<long>(limit_ms)),
                           fmt::format("render: program {}: the device took more than {:g} s{}",
                                       program.name, limit_ms / 1e3, blamed));
    const std::set<std::string> foreign = watch_.foreign(program.stitched);
    guard_.emplace([&](const char* ending) {
        return fmt::format("render: program {}: the driver ended in {}{}", program.name, ending,
                           !foreign.empty()
                               ? "; " + disable(foreign)
                               : "; it needs more memory (ulimit -v, ulimit -s), or is "
                                 "at fault itself: try another --device");
    });
}

DrawWatch::Turn::~Turn() {
    watch_.watchdog_.stop();
}

std::set<std::string> DrawWatch::foreign(const shader::Stitched& stitched) const {
    const std::set<std::string> present = present_in(stitched);
    const std::string shipped = (share_dir() / "plugins" / "").string();
    std::set<std::string> ids;
    for (const shader::Snippet* snippet : snippets_)
        if (present.count(snippet->id) > 0 && !snippet->file.starts_with(shipped))
            ids.insert(snippet->id);
    return ids;
}

std::string DrawWatch::blame(const shader::Stitched& stitched) const {
    std::set<std::string> present = foreign(stitched);
    if (present.empty()) present = present_in(stitched);
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
    return fmt::format("; {} may never end; {}", fmt::join(loops, ", "), disable(suspects));
}

}  // namespace relevo::render
