#include "base/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
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
    // In 64 bits: the last pieces reach beyond `end`.
    const std::int64_t length = std::int64_t{end} - begin;
    const std::int64_t least = std::max(1, grain);
    const auto threads = std::min<std::int64_t>(thread_count(), (length + least - 1) / least);
    if (threads <= 1) {
        body(begin, end);
        return;
    }
    // Several pieces a thread, so that an uneven load still keeps all of them busy.
    const std::int64_t piece = std::max(least, length / (threads * 4));
    std::atomic<std::int64_t> next = begin;
    std::mutex mutex;
    std::exception_ptr error;
    const auto work = [&] {
        for (;;) {
            const std::int64_t first = next.fetch_add(piece);
            if (first >= end) return;
            try {
                body(static_cast<int>(first),
                     static_cast<int>(std::min<std::int64_t>(end, first + piece)));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!error) error = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> workers;
        try {
            for (std::int64_t i = 1; i < threads; ++i)
                workers.emplace_back(work);
        } catch (const std::system_error&) {
            // The system gives no more threads (ulimit -u): those that there are do all of it.
        }
        work();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace relevo
