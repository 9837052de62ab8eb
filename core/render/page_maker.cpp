#include "render/page_maker.h"

#include <algorithm>
#include <utility>

#include "base/contains.h"
#include "base/parallel_for.h"

namespace relevo::render {

std::vector<MadePage> make_pages(std::span<const TileKey> keys,
                                 const std::function<MadePage(const TileKey&)>& make) {
    std::vector<MadePage> pages(keys.size());
    parallel_for(0, static_cast<int>(keys.size()), 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
            pages[i] = make(keys[i]);
    });
    return pages;
}

PageMaker::PageMaker(std::function<MadePage(const TileKey&)> make)
    : make_(std::move(make)), thread_([this] { run(); }) {}

PageMaker::~PageMaker() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void PageMaker::want(std::vector<TileKey> keys) {
    {
        const std::lock_guard lock(mutex_);
        const auto is_under_way = [&](const TileKey& key) { return contains(in_work_, key); };
        keys.erase(std::remove_if(keys.begin(), keys.end(), is_under_way), keys.end());
        wanted_ = std::move(keys);
    }
    changed_.notify_one();
}

std::vector<MadePage> PageMaker::take() {
    const std::lock_guard lock(mutex_);
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    // Pages in made_ are still listed in in_work_ until they are taken.
    for (const MadePage& page : made_)
        in_work_.erase(std::remove(in_work_.begin(), in_work_.end(), page.key), in_work_.end());
    return std::exchange(made_, {});
}

bool PageMaker::is_at_work() const {
    const std::lock_guard lock(mutex_);
    return !wanted_.empty() || in_work_.size() > made_.size();
}

void PageMaker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return ends_ || !wanted_.empty(); });
        if (ends_) return;
        // Small batches, so that want() takes effect soon.
        const std::size_t count =
            std::min(wanted_.size(), static_cast<std::size_t>(2 * thread_count()));
        const auto end = wanted_.begin() + static_cast<std::ptrdiff_t>(count);
        const std::vector<TileKey> keys(wanted_.begin(), end);
        wanted_.erase(wanted_.begin(), end);
        in_work_.insert(in_work_.end(), keys.begin(), keys.end());
        lock.unlock();
        std::vector<MadePage> pages;
        std::exception_ptr error;
        try {
            pages = make_pages(keys, make_);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        for (MadePage& page : pages)
            made_.push_back(std::move(page));
        if (error) {
            error_ = error;
            in_work_.clear();
            wanted_.clear();
        }
    }
}

}  // namespace relevo::render
