#include "render/program_cache.h"

#include <algorithm>

namespace relevo::render {

std::shared_ptr<ProgramCache::Entry> ProgramCache::find(const ProgramText& text) {
    const auto known = entries_.find(text.hash);
    if (known == entries_.end()) return nullptr;
    known->second->used = ++uses_;
    return known->second;
}

std::shared_ptr<ProgramCache::Entry> ProgramCache::link(const ProgramText& text) {
    auto entry = std::make_shared<Entry>(Entry{link_program(text)});
    entry->used = ++uses_;
    ++links_;
    if (entries_.size() >= kMost)
        entries_.erase(std::ranges::min_element(
            entries_, {}, [](const auto& each) { return each.second->used; }));
    entries_.insert_or_assign(text.hash, entry);
    return entry;
}

}  // namespace relevo::render
