#include "dem/dataset_pool.h"

#include <algorithm>
#include <utility>

namespace relevo::dem {

Dataset DatasetPool::take(const Piece& piece) {
    const std::lock_guard lock(mutex_);
    const auto found = by_piece_.find(&piece);
    if (found == by_piece_.end()) return nullptr;
    Dataset dataset = std::move(found->second->dataset);
    handles_.erase(found->second);
    by_piece_.erase(found);
    return dataset;
}

void DatasetPool::give(const Piece& piece, Dataset dataset) {
    Dataset oldest;  // declared before the lock, so closed after it
    const std::lock_guard lock(mutex_);
    if (handles_.size() >= kMostIdle) {
        const auto last = std::prev(handles_.end());
        const auto [begin, end] = by_piece_.equal_range(last->piece);
        by_piece_.erase(
            std::find_if(begin, end, [&](const auto& entry) { return entry.second == last; }));
        oldest = std::move(last->dataset);
        handles_.erase(last);
    }
    handles_.push_front({&piece, std::move(dataset)});
    by_piece_.emplace(&piece, handles_.begin());
}

}  // namespace relevo::dem
