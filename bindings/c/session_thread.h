#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace relevo::c {

/// A thread that does one piece of work after the other, while callers wait. A device's context
/// belongs to a thread.
class SessionThread {
  public:
    SessionThread() : thread_([this] { loop(); }) {}
    ~SessionThread() {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    SessionThread(const SessionThread&) = delete;
    SessionThread& operator=(const SessionThread&) = delete;

    /// @throws what `work` throws
    void run(const std::function<void()>& work) {
        const std::lock_guard one_caller(callers_);
        std::unique_lock lock(mutex_);
        work_ = &work;
        thrown_ = nullptr;
        changed_.notify_all();
        changed_.wait(lock, [this] { return work_ == nullptr; });
        if (thrown_) std::rethrow_exception(thrown_);
    }

  private:
    void loop() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return work_ || over_; });
            if (!work_) return;
            lock.unlock();
            std::exception_ptr thrown;
            try {
                (*work_)();
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            thrown_ = std::move(thrown);
            work_ = nullptr;
            changed_.notify_all();
        }
    }

    std::mutex callers_, mutex_;
    std::condition_variable changed_;
    const std::function<void()>* work_ = nullptr;
    std::exception_ptr thrown_;
    bool over_ = false;
    std::thread thread_;  // last: it uses the rest
};

}  // namespace relevo::c
