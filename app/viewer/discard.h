#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include <malloc.h>

namespace relevo::viewer {

/// Ends what is not wanted any more on threads of its own, so that nobody waits for the work that
/// it has begun.
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
                // Else what threads have freed stays with the program: a DEM paged through after
                // the other took 1.2 GiB in the end.
                malloc_trim(0);
            }));
    }
    /// Waits. @returns whether all has ended by then
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
