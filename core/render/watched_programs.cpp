#include "render/watched_programs.h"

#include <algorithm>
#include <cassert>

#include <epoxy/gl.h>

namespace relevo::render {

WatchedPrograms::WatchedPrograms(const StitchedFrames& texts, ProgramCache& cache,
                                 std::vector<const shader::Snippet*> snippets)
    : texts_(texts), cache_(cache), snippets_(std::move(snippets)) {}

const ProgramText& WatchedPrograms::text(const std::string& name) const {
    const ProgramText* const found = texts_.find(name);
    assert(found);
    return *found;
}

DrawWatch& WatchedPrograms::watch() {
    if (!watch_) watch_.emplace(snippets_);
    return *watch_;
}

ProgramCache::Entry& WatchedPrograms::entry(const std::string& name) {
    auto& known = linked_[name];
    if (known) return *known;
    known = cache_.find(text(name));
    if (known) return *known;
    const DrawWatch::Turn turn(watch(), text(name), 0);
    known = cache_.link(text(name));
    return *known;
}

void WatchedPrograms::begin(const std::string& name) {
    if (cache_.find(text(name))) return;
    const DrawWatch::Turn turn(watch(), text(name), 0);
    cache_.begin(text(name));
}

bool WatchedPrograms::is_linked(const std::string& name) {
    return linked_[name] || cache_.find(text(name));
}

const gl::Program& WatchedPrograms::link(const std::string& name) {
    return entry(name).program;
}

bool WatchedPrograms::needs_watch(const std::string& name) {
    return !entry(name).proven;
}

void WatchedPrograms::draw(const std::string& name, double parts,
                           const std::function<void()>& body) {
    if (needs_watch(name))
        draw_watched(name, parts, body);
    else
        body();
}

void WatchedPrograms::draw_watched(const std::string& name, double parts,
                                   const std::function<void()>& body) {
    {
        const DrawWatch::Turn turn(watch(), text(name), parts);
        body();
        glFinish();
    }
    end_watch();
}

void WatchedPrograms::set_proven(const std::string& name) {
    entry(name).proven = true;
    end_watch();
}

void WatchedPrograms::end_watch() {
    const bool all = std::ranges::all_of(
        linked_, [](const auto& each) { return each.second && each.second->proven; });
    if (all) watch_.reset();
}

}  // namespace relevo::render
