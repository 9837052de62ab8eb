#include "library.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <unistd.h>

namespace relevo::python {
namespace {

/// The process that has used the library; 0: none yet.
std::atomic<pid_t>& user() {
    static std::atomic<pid_t> process{0};
    return process;
}

/// Whether Python ends.
std::atomic<bool>& ending() {
    static std::atomic<bool> yes{false};
    return yes;
}

/// Calls under way. The GIL guards it.
int& calls_under_way() {
    static int count = 0;
    return count;
}

struct Messages {
    std::mutex mutex;
    std::vector<std::pair<int, std::string>> kept;
};

Messages& messages() {
    static auto& all = *new Messages;  // threads of the library may outlive the module
    return all;
}

void keep_message(void* /*user*/, std::int32_t level, const char* text) {
    constexpr std::size_t kMost = 1000;  // of a long call; nobody reads more
    const std::lock_guard lock(messages().mutex);
    if (level >= RELEVO_MESSAGE_WARNING || messages().kept.size() < kMost)
        messages().kept.emplace_back(level, text);
}

/// Work on a thread of its own, as the thread that waits for it sees it.
class Work {
  public:
    explicit Work(LongCall call) : call_(std::move(call)), thread_([this] { run(); }) {}
    /// Waits for the end, without the GIL.
    ~Work() {
        const py::gil_scoped_release released;
        thread_.join();
    }

    void cancel() { cancelled_ = true; }
    bool over() {
        const std::lock_guard lock(mutex_);
        return over_;
    }
    /// Waits a little without the GIL. @returns whether the work has ended
    bool wait() {
        constexpr auto kSignals = std::chrono::milliseconds(30);
        const py::gil_scoped_release released;
        std::unique_lock lock(mutex_);
        return ended_.wait_for(lock, kSignals, [this] { return over_; });
    }
    double share() const { return share_; }

    /// Once it has ended. @throws LibraryError
    std::string result() {
        if (code_ != RELEVO_RESULT_OK) throw LibraryError{code_, error_};
        return text_;
    }

  private:
    static std::int32_t done(void* work, double share) {
        auto* const self = static_cast<Work*>(work);
        self->share_ = share;
        return self->cancelled_ || ending() ? 1 : 0;
    }

    void run() {
        auto progress = sized<relevo_progress>();
        progress.user = this;
        progress.done = done;
        const relevo_result code = call_(&progress, text_);
        const std::lock_guard lock(mutex_);
        code_ = code;
        if (code != RELEVO_RESULT_OK) error_ = relevo_error();  // of this thread
        over_ = true;
        ended_.notify_all();
    }

    LongCall call_;
    std::atomic<bool> cancelled_{false};
    std::atomic<double> share_{0};
    std::mutex mutex_;
    std::condition_variable ended_;
    bool over_ = false;
    relevo_result code_ = RELEVO_RESULT_OK;
    std::string text_, error_;
    std::thread thread_;  // last: it uses the rest
};

/// Cancelled work that has not noticed yet: the library asks for progress between steps, which
/// take a second on large DEMs, and nobody waits that long for Ctrl-C. The GIL guards the list.
std::vector<std::unique_ptr<Work>>& abandoned() {
    static auto& all = *new std::vector<std::unique_ptr<Work>>;
    return all;
}

void abandon(std::unique_ptr<Work> work) {
    work->cancel();
    // Destroying a Work releases the GIL: the list is complete before that.
    std::vector<std::unique_ptr<Work>> ended;
    for (std::unique_ptr<Work>& one : abandoned())
        if (one->over()) ended.push_back(std::move(one));
    std::erase(abandoned(), nullptr);
    abandoned().push_back(std::move(work));
}

/// Signals and progress of work under way, on the thread that has called.
/// @throws py::error_already_set
void attend(Work& work, const py::object& progress, double& shown) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const double share = work.share();
    if (progress.is_none() || share <= shown) return;
    shown = share;
    if (progress(share).is(py::bool_(false))) work.cancel();
}

}  // namespace

void check(relevo_result result) {
    if (result != RELEVO_RESULT_OK) throw LibraryError{result, relevo_error()};
}

bool is_fork() {
    const pid_t process = user();
    return process != 0 && process != getpid();
}

Calling::Calling() {
    if (ending()) throw LibraryError{RELEVO_RESULT_BAD_CALL, "relevo: Python ends"};
    if (is_fork())
        throw LibraryError{RELEVO_RESULT_BAD_CALL,
                           "relevo: this process was forked after relevo was used, and its threads "
                           "are not here; start processes by multiprocessing's \"spawn\""};
    user() = getpid();
    ++calls_under_way();
}

Calling::~Calling() {
    --calls_under_way();
}

std::string call_long(const py::object& progress, LongCall call_library) {
    const Calling calling;
    if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0)
        throw LibraryError{RELEVO_RESULT_BAD_CALL, "progress: expected a function or None"};
    auto work = std::make_unique<Work>(std::move(call_library));
    double shown = 0;
    try {
        while (!work->wait())
            attend(*work, progress, shown);
    } catch (...) {
        abandon(std::move(work));
        throw;
    }
    return work->result();
}

void finish_calls() {
    if (is_fork()) return;
    ending() = true;
    while (calls_under_way() > 0) {
        const py::gil_scoped_release released;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    abandoned().clear();
}

void keep_messages() {
    check(relevo_set_message(keep_message, nullptr));
}

std::vector<std::pair<int, std::string>> take_messages() {
    if (is_fork()) return {};  // another thread may have held the lock
    const std::lock_guard lock(messages().mutex);
    return std::exchange(messages().kept, {});
}

Array::Array(const py::object& array, char format, Use use) {
    const int flags =
        PyBUF_FORMAT | PyBUF_C_CONTIGUOUS | (use == Use::Write ? PyBUF_WRITABLE : PyBUF_SIMPLE);
    if (PyObject_GetBuffer(array.ptr(), &view_, flags) != 0) throw py::error_already_set();
    if (view_.format && view_.format[0] == format && view_.format[1] == 0) return;
    const std::string got = view_.format ? view_.format : "B";
    PyBuffer_Release(&view_);
    throw LibraryError{RELEVO_RESULT_BAD_CALL, "array: expected elements of the type '" +
                                                   std::string(1, format) + "' but got '" + got +
                                                   "'"};
}

std::int32_t Array::side(int dimension) const {
    if (view_.ndim != 2 || view_.shape[dimension] > std::numeric_limits<std::int32_t>::max())
        throw LibraryError{RELEVO_RESULT_BAD_CALL, "array: expected rows and columns"};
    return static_cast<std::int32_t>(view_.shape[dimension]);
}

}  // namespace relevo::python
