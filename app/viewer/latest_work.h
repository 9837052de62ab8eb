#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace relevo::viewer {

/// Computes an Answer to the latest Wanted on a thread of its own. Answer::of is its Wanted.
template <typename Wanted, typename Answer>
class LatestWork {
  public:
    /// True if a stale answer to `of` may be displayed while one to `now` is computed.
    using Serves = bool (*)(const Wanted& of, const Wanted& now);

    /// @param on_change  called on that thread whenever there is a new answer
    LatestWork(std::function<void()> on_change, Serves serves)
        : on_change_(std::move(on_change)), serves_(serves), thread_([this] { run(); }) {}
    LatestWork(const LatestWork&) = delete;
    LatestWork& operator=(const LatestWork&) = delete;
    virtual ~LatestWork() { end(); }

    void want(Wanted wanted) {
        {
            const std::lock_guard lock(mutex_);
            if (answer_ && !serves_(answer_->of, wanted)) answer_ = nullptr;
            wanted_ = std::move(wanted);
            is_new_ = true;
            is_done_ = false;
        }
        changed_.notify_one();
    }
    /// Drops the request and its answer.
    void forget() {
        {
            const std::lock_guard lock(mutex_);
            wanted_.reset();
            answer_ = nullptr;
            is_new_ = is_done_ = true;
        }
        changed_.notify_one();
    }
    /// The latest answer, perhaps partial or stale; null: none yet.
    std::shared_ptr<const Answer> answer() const {
        const std::lock_guard lock(mutex_);
        return answer_;
    }
    /// Whether the answer to the latest request is complete.
    bool is_done() const {
        const std::lock_guard lock(mutex_);
        return is_done_;
    }

  protected:
    /// Called on that thread with each request, and with null after forget().
    virtual void work_out(const Wanted* wanted) = 0;
    /// Waits for the current step. Destructors call it before they destroy members that work_out()
    /// uses.
    void end() {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        changed_.notify_one();
        if (thread_.joinable()) thread_.join();
    }
    void tell_of_change() const { on_change_(); }

    /// Whether there is another request by now.
    bool is_given_up() const {
        const std::lock_guard lock(mutex_);
        return ends_ || is_new_;
    }
    /// Whether an answer to this request may not even be displayed as a stale one.
    bool is_of_no_use(const Wanted& of) const {
        const std::lock_guard lock(mutex_);
        return ends_ || is_useless(of);
    }
    /// @param done  the answer is complete
    void publish(std::shared_ptr<const Answer> answer, bool done) {
        {
            const std::lock_guard lock(mutex_);
            if (ends_ || is_useless(answer->of)) return;
            answer_ = std::move(answer);
            if (!is_new_) is_done_ = done;
        }
        on_change_();
    }

  private:
    bool is_useless(const Wanted& of) const {
        return is_new_ && !(wanted_ && serves_(of, *wanted_));
    }

    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return ends_ || is_new_; });
            if (ends_) return;
            is_new_ = false;
            const std::optional<Wanted> now = wanted_;
            lock.unlock();
            work_out(now ? &*now : nullptr);
            lock.lock();
        }
    }

    std::function<void()> on_change_;
    Serves serves_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Wanted> wanted_;
    std::shared_ptr<const Answer> answer_;
    bool is_new_ = false, ends_ = false, is_done_ = true;
    std::thread thread_;  // last: it uses the members above
};

}  // namespace relevo::viewer
