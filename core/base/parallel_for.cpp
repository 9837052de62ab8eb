#include "base/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <latch>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include <sys/mman.h>

#include "base/allocation.h"

namespace relevo {
namespace {

/// A range whose pieces are handed out until none is left.
struct Job {
    const std::function<void(int, int)>& body;
    std::int64_t end, piece;
    std::atomic<std::int64_t> next;
    // Under the pool's lock:
    int wanted = 0;  ///< helpers that may still join
    int inside = 0;  ///< helpers at work
    std::exception_ptr error;

    /// Works on pieces until none is left, or one fails. @returns what that one threw
    std::exception_ptr work() {
        for (;;) {
            const std::int64_t first = next.fetch_add(piece);
            if (first >= end) return {};
            try {
                body(static_cast<int>(first),
                     static_cast<int>(std::min<std::int64_t>(end, first + piece)));
            } catch (...) {
                next = end;  // no other piece begins
                return std::current_exception();
            }
        }
    }
};

/// Threads that wait for jobs. Who gives a job works on it too, and so waits for no one but those
/// who are in the middle of a piece: jobs may be given from inside of others, and from several
/// threads at once.
class Pool {
  public:
    static Pool& instance() {
        // Never destroyed: its threads sleep until the process ends, however that comes.
        static Pool* const pool = new Pool(thread_count() - 1);
        return *pool;
    }

    void run(Job& job) {
        {
            const std::lock_guard lock(mutex_);
            jobs_.push_back(&job);
        }
        work_.notify_all();
        const std::exception_ptr thrown = job.work();
        std::unique_lock lock(mutex_);
        jobs_.erase(std::remove(jobs_.begin(), jobs_.end(), &job), jobs_.end());
        done_.wait(lock, [&] { return job.inside == 0; });
        if (thrown) job.error = thrown;
    }

  private:
    explicit Pool(int threads) {
        try {
            for (int i = 0; i < threads; ++i)
                std::thread([this] { help(); }).detach();
        } catch (const std::system_error&) {
            // The system gives no more threads (ulimit -u): those that there are do all of it.
        }
    }

    [[noreturn]] void help() {
        std::unique_lock lock(mutex_);
        for (;;) {
            work_.wait(lock, [this] { return !jobs_.empty(); });
            Job& job = *jobs_.front();
            if (--job.wanted <= 0) jobs_.pop_front();
            ++job.inside;
            lock.unlock();
            const std::exception_ptr thrown = job.work();
            lock.lock();
            if (thrown && !job.error) job.error = thrown;
            if (--job.inside == 0) done_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable work_, done_;
    std::deque<Job*> jobs_;  // that want helpers
};

}  // namespace

int thread_count() {
    return allocation().threads;
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
    Job job{.body = body,
            .end = end,
            .piece = std::max(least, length / (threads * 8)),
            .next = begin,
            .wanted = static_cast<int>(threads) - 1};
    Pool::instance().run(job);
    if (job.error) std::rethrow_exception(job.error);
}

bool can_start_threads(int count) {
    constexpr std::size_t kBeside = std::size_t{128} << 20;  // address space alone
    void* const beside =
        mmap(nullptr, kBeside, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (beside == MAP_FAILED) return false;
    std::latch all(1);
    std::vector<std::thread> threads;
    bool started = true;
    try {
        for (int i = 0; i < count; ++i)
            threads.emplace_back([&] { all.wait(); });
    } catch (const std::system_error&) {
        started = false;
    }
    all.count_down();
    for (std::thread& thread : threads)
        thread.join();
    munmap(beside, kBeside);
    return started;
}

}  // namespace relevo
