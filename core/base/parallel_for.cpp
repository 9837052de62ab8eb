#include "base/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <sched.h>

namespace relevo {

int thread_count() {
    static const int count = [] {
        cpu_set_t set;
        CPU_ZERO(&set);
        if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
        return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    }();
    return count;
}

void parallel_for(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    if (end <= begin) return;
    const int length = end - begin;
    grain = std::max(1, grain);
    const int threads = std::min(thread_count(), (length + grain - 1) / grain);
    if (threads <= 1) {
        body(begin, end);
        return;
    }
    // Several pieces a thread, so that an uneven load still keeps all of them busy.
    const int piece = std::max(grain, length / (threads * 4));
    std::atomic<int> next = begin;
    std::mutex mutex;
    std::exception_ptr error;
    const auto work = [&] {
        for (;;) {
            const int first = next.fetch_add(piece);
            if (first >= end) return;
            try {
                body(first, std::min(end, first + piece));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!error) error = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> workers;
        for (int i = 1; i < threads; ++i)
            workers.emplace_back(work);
        work();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace relevo
