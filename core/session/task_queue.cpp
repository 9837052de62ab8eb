#include "session/task_queue.h"

#include <utility>

namespace relevo::session {

TaskQueue::TaskQueue(int threads) : most_(static_cast<std::size_t>(threads) + 1) {
    for (int i = 0; i < threads; ++i)
        threads_.emplace_back([this] { work(); });
}

void TaskQueue::add(std::function<void()> task) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return tasks_.size() < most_; });
    tasks_.push_back(std::move(task));
    changed_.notify_all();
}

void TaskQueue::finish() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

void TaskQueue::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
        if (tasks_.empty()) return;
        const std::function<void()> task = std::move(tasks_.front());
        tasks_.pop_front();
        changed_.notify_all();
        lock.unlock();
        task();
        lock.lock();
    }
}

}  // namespace relevo::session
