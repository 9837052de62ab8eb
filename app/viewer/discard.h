#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include <malloc.h>

namespace relevo::viewer {

/// Destroys objects on other threads, so that the caller does not wait for work in progress.
class Discard {
  public:
    template <typename T>
    void take(std::unique_ptr<T> unwanted) {
        std::erase_if(ending_, [](const std::future<void>& one) {
            return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
        });
        if (unwanted)
            ending_.push_back(std::async(std::launch::async, [one = std::move(unwanted)]() mutable {
                one.reset();
                // Without it the process keeps the memory that threads have freed: 1.2 GiB after
                // opening one DEM after the other.
                malloc_trim(0);
            }));
    }
    /// Waits up to `time`. @returns whether all objects are destroyed
    bool ends_within(std::chrono::milliseconds time) const {
        const auto until = std::chrono::steady_clock::now() + time;
        for (const std::future<void>& one : ending_)
            if (one.wait_until(until) != std::future_status::ready) return false;
        return true;
    }

  private:
    std::vector<std::future<void>> ending_;
};

}  // namespace relevo::viewer
