#include "viewer/picture_queue.h"

#include <chrono>
#include <utility>

namespace relevo::viewer {

void PictureQueue::add(std::shared_ptr<const Picture> picture) {
    const std::lock_guard lock(mutex_);
    pictures_.push_back(std::move(picture));
}

void PictureQueue::finish(std::size_t unfinished, const std::function<bool()>& gives_up) {
    constexpr auto kLookAgain = std::chrono::milliseconds(100);
    std::shared_ptr<const Picture> last;
    {
        const std::lock_guard lock(mutex_);
        if (pictures_.size() > unfinished)
            last = pictures_.rbegin()[static_cast<std::ptrdiff_t>(unfinished)];
    }
    if (!last) return;
    if (last->shared)
        while (!last->shared->drawn.wait(kLookAgain) && !gives_up()) {
        }
    const std::lock_guard lock(mutex_);
    while (!pictures_.empty() && pictures_.front()->number < last->number)
        pictures_.pop_front();
}

std::shared_ptr<const Picture> PictureQueue::newer_than(std::uint64_t number) const {
    const std::lock_guard lock(mutex_);
    for (auto picture = pictures_.rbegin(); picture != pictures_.rend(); ++picture) {
        if ((*picture)->number <= number) break;
        if (!(*picture)->shared || (*picture)->shared->drawn.has_passed()) return *picture;
    }
    return nullptr;
}

void PictureQueue::clear() {
    const std::lock_guard lock(mutex_);
    pictures_.clear();
}

}  // namespace relevo::viewer
