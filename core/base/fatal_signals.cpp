#include "base/fatal_signals.h"

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include "base/host_program.h"
#include "base/watchdog.h"

namespace relevo {
namespace {

// For the signal handler, which gets no argument.

using Messages = std::array<std::string, kFatalSignals.size()>;

thread_local const Messages* of_thread = nullptr;
std::atomic<const Messages*> newest{nullptr};

std::mutex guards_mutex;
struct Guard {
    const Messages* messages;
    SignalsOf whose;
};
std::vector<Guard> guards;  // in their order
std::array<struct sigaction, kFatalSignals.size()> old_actions;

/// A signal of no guard's: as if there were none. Programs that load Relevo as a library may use
/// such signals (virtual machines do).
void pass_on(int signal, siginfo_t* info, void* context) {
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i) {
        const struct sigaction& old = old_actions[i];
        if (kFatalSignals[i].number != signal) continue;
        if (old.sa_flags & SA_SIGINFO) return old.sa_sigaction(signal, info, context);
        if (old.sa_handler == SIG_IGN) return;
        if (old.sa_handler != SIG_DFL) return old.sa_handler(signal);
    }
    std::signal(signal, SIG_DFL);
    raise(signal);
}

void on_signal(int signal, siginfo_t* info, void* context) {
    const Messages* const messages = of_thread || is_hosted() ? of_thread : newest.load();
    for (std::size_t i = 0; messages && i < kFatalSignals.size(); ++i)
        if (kFatalSignals[i].number == signal) end_program((*messages)[i].c_str());
    pass_on(signal, info, context);
}

void find_newest() {
    newest = nullptr;
    for (const Guard& guard : guards)
        if (guard.whose == SignalsOf::ThreadsWithoutAGuard) newest = guard.messages;
}

void add(const Guard& guard) {
    const std::lock_guard lock(guards_mutex);
    guards.push_back(guard);
    find_newest();
    if (guards.size() > 1) return;
    struct sigaction action {};
    action.sa_sigaction = on_signal;
    action.sa_flags = SA_ONSTACK | SA_SIGINFO;
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        sigaction(kFatalSignals[i].number, &action, &old_actions[i]);
}

void remove(const Messages* messages) {
    const std::lock_guard lock(guards_mutex);
    std::erase_if(guards, [&](const Guard& guard) { return guard.messages == messages; });
    find_newest();
    if (!guards.empty()) return;
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        sigaction(kFatalSignals[i].number, &old_actions[i], nullptr);
}

}  // namespace

struct FatalSignalGuard::Impl {
    Messages messages;
    const Messages* outer = nullptr;
    /// For the handler: the thread's own stack may be exhausted.
    std::array<std::byte, 64 * 1024> stack;
    stack_t old_stack{};
};

FatalSignalGuard::FatalSignalGuard(const std::function<std::string(const char* ending)>& message,
                                   SignalsOf whose)
    : impl_(std::make_unique<Impl>()) {
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        impl_->messages[i] = message(kFatalSignals[i].name);
    stack_t stack{};
    stack.ss_sp = impl_->stack.data();
    stack.ss_size = impl_->stack.size();
    sigaltstack(&stack, &impl_->old_stack);
    impl_->outer = of_thread;
    of_thread = &impl_->messages;
    add({&impl_->messages, whose});
}

FatalSignalGuard::~FatalSignalGuard() {
    remove(&impl_->messages);
    of_thread = impl_->outer;
    sigaltstack(&impl_->old_stack, nullptr);
}

}  // namespace relevo
