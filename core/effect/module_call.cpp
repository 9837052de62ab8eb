#include "effect/module_call.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "effect/signals.h"

namespace relevo::effect {
namespace {

// A handler of signals or of exits gets no object: what it may need is here.

/// What to say of each fatal signal, while a module's function runs.
struct Running {
    std::array<std::string, kFatalSignals.size()> on_signal;
    std::string on_exit;
    Watchdog* watchdog = nullptr;
    std::thread::id thread{};  // that calls it
};
/// Of the process, as a module may have threads of its own.
std::atomic<const Running*> running{nullptr};

/// Signals are handled by the whole process, so that one function runs at a time.
std::mutex call_mutex;

std::mutex modules_mutex;
std::vector<const ModuleInProcess*> modules;  // that are loaded

void on_signal(int signal) {
    const Running* now = running.load();
    for (std::size_t i = 0; now && i < kFatalSignals.size(); ++i)
        if (kFatalSignals[i].number == signal) end_program(now->on_signal[i].c_str());
    std::signal(signal, SIG_DFL);
    raise(signal);
}

/// The program does not end by itself while a module is loaded: main() unloads them all.
void on_exit_of_the_program() {
    if (const Running* now = running.load()) end_program(now->on_exit.c_str());
    const std::lock_guard lock(modules_mutex);
    if (!modules.empty()) end_program(modules.back()->message("", "ended the program").c_str());
}

void watch_for_exits() {
    static const bool once = [] {
        std::atexit(on_exit_of_the_program);
        std::at_quick_exit(on_exit_of_the_program);
        return true;
    }();
    static_cast<void>(once);
}

/// Where the library begins that holds an address.
const void* base_of(const void* address) {
    Dl_info info{};
    return dladdr(address, &info) != 0 ? info.dli_fbase : nullptr;
}

/// Says so where code of a module called _exit().
void blame(const void* caller) {
    const void* base = base_of(caller);
    const std::unique_lock lock(modules_mutex, std::try_to_lock);
    if (!base || !lock) return;
    for (const ModuleInProcess* module : modules) {
        if (module->base() != base) continue;
        const Running* now = running.load();
        end_program(now ? now->on_exit.c_str() : module->message("", "ended the program").c_str());
    }
}

}  // namespace

ModuleInProcess::ModuleInProcess(std::string id, std::string library)
    : id_(std::move(id)), library_(std::move(library)) {
    watch_for_exits();
    const std::lock_guard lock(modules_mutex);
    modules.push_back(this);
}

ModuleInProcess::~ModuleInProcess() {
    const std::lock_guard lock(modules_mutex);
    std::erase(modules, this);
}

void ModuleInProcess::lies_at(const void* address) {
    base_ = base_of(address);
}

std::string ModuleInProcess::message(const std::string& function, const std::string& what) const {
    return fmt::format("effect: {}: {} {}; --disable {} goes on without it", library_,
                       function.empty() ? "its code" : "its " + function, what, id_);
}

struct ModuleCall::Signals {
    std::unique_lock<std::mutex> turn{call_mutex};
    Running texts;
    std::vector<std::byte> stack;
    stack_t old_stack{};
    std::array<struct sigaction, kFatalSignals.size()> old_actions{};
};

ModuleCall::ModuleCall(ModuleInProcess& module, const std::string& function)
    : module_(module), signals_(std::make_unique<Signals>()) {
    Signals& signals = *signals_;
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        signals.texts.on_signal[i] =
            module.message(function, fmt::format("ended in {}", kFatalSignals[i].name));
    signals.texts.on_exit = module.message(function, "ended the program");
    signals.texts.watchdog = &module.watchdog_;
    signals.texts.thread = std::this_thread::get_id();

    // A stack of its own: what ran out may be the other one.
    constexpr std::size_t kStackBytes = 64 * 1024;
    signals.stack.resize(kStackBytes);
    stack_t stack{};
    stack.ss_sp = signals.stack.data();
    stack.ss_size = signals.stack.size();
    sigaltstack(&stack, &signals.old_stack);
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_ONSTACK;
    running.store(&signals.texts);
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        sigaction(kFatalSignals[i].number, &action, &signals.old_actions[i]);
    const std::chrono::milliseconds limit = patience();
    module.watchdog_.start(
        limit, module.message(function, fmt::format("took more than {:g} s",
                                                    static_cast<double>(limit.count()) / 1e3)));
}

ModuleCall::~ModuleCall() {
    module_.watchdog_.stop();
    for (std::size_t i = 0; i < kFatalSignals.size(); ++i)
        sigaction(kFatalSignals[i].number, &signals_->old_actions[i], nullptr);
    sigaltstack(&signals_->old_stack, nullptr);
    running.store(nullptr);
}

ModuleCall::Pause::Pause() {
    const Running* now = running.load();
    paused_ = now && now->thread == std::this_thread::get_id() ? now->watchdog : nullptr;
    if (paused_) paused_->pause();
}

ModuleCall::Pause::~Pause() {
    if (paused_) paused_->go_on();
}

}  // namespace relevo::effect

// In front of the C library's, for the modules that call it. GNU's linker and LLVM's give a program
// this name where a library that it links with has it too.
extern "C" [[noreturn]] void _exit(int status) {
    relevo::effect::blame(__builtin_return_address(0));
    while (true)
        syscall(SYS_exit_group, status);
}

extern "C" [[noreturn]] void _Exit(int status) noexcept {
    relevo::effect::blame(__builtin_return_address(0));
    while (true)
        syscall(SYS_exit_group, status);
}
