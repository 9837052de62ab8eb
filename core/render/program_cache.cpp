#include "render/program_cache.h"

#include <algorithm>
#include <utility>

namespace relevo::render {

std::shared_ptr<ProgramCache::Entry> ProgramCache::find(const ProgramText& text) {
    const auto known = entries_.find(text.hash);
    if (known == entries_.end()) return nullptr;
    known->second->used = ++uses_;
    return known->second;
}

void ProgramCache::begin(const ProgramText& text) {
    if (!entries_.contains(text.hash) && !pending_.contains(text.hash))
        pending_.emplace(text.hash, begin_program(text));
}

std::shared_ptr<ProgramCache::Entry> ProgramCache::link(const ProgramText& text) {
    begin(text);
    auto pending = pending_.extract(text.hash);
    try {
        return keep(text.hash, finish_program(std::move(pending.mapped()), text));
    } catch (...) {
        pending_.clear();  // of the same selection: nobody will ask for them
        throw;
    }
}

void ProgramCache::add(const std::string& hash, gl::Program program) {
    if (!entries_.contains(hash)) keep(hash, std::move(program));
}

std::shared_ptr<ProgramCache::Entry> ProgramCache::keep(const std::string& hash,
                                                        gl::Program program) {
    auto entry = std::make_shared<Entry>(Entry{std::move(program)});
    entry->used = ++uses_;
    ++links_;
    if (entries_.size() >= kMost)
        entries_.erase(std::ranges::min_element(
            entries_, {}, [](const auto& each) { return each.second->used; }));
    entries_.insert_or_assign(hash, entry);
    return entry;
}

}  // namespace relevo::render
