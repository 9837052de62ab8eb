#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace relevo::session {

/// Runs tasks in order on its own threads. add() blocks while many tasks are waiting.
class TaskQueue {
  public:
    explicit TaskQueue(int threads);
    ~TaskQueue() { finish(); }
    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    /// @param task  must not throw
    void add(std::function<void()> task);

    /// Waits for all tasks.
    void finish();

  private:
    void work();

    std::size_t most_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool ended_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace relevo::session
