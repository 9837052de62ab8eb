#include "effect/module_call.h"

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/fatal_signals.h"

namespace relevo::effect {
namespace {

// A handler of exits gets no object: what it may need is here.

/// What there is to say while a module's function runs.
struct Running {
    std::string on_exit;
    Watchdog* watchdog = nullptr;
    std::thread::id thread{};  // that calls it
};
/// Of the process, as a module may have threads of its own.
std::atomic<const Running*> running{nullptr};

/// Exits are of the whole process, so that one function runs at a time.
std::mutex call_mutex;

std::mutex modules_mutex;
std::vector<const ModuleInProcess*> modules;  // that are loaded

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
    const Running* now = running.load();
    // While a module's function runs, what is not the program's own is its, or what it has loaded:
    // where its code lies is not known before it is registered.
    if (now && base != base_of(reinterpret_cast<const void*>(&base_of)))
        end_program(now->on_exit.c_str());
    const std::unique_lock lock(modules_mutex, std::try_to_lock);
    if (!base || !lock) return;
    for (const ModuleInProcess* module : modules)
        if (module->base() == base) end_program(module->message("", "ended the program").c_str());
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
    Running running;
    FatalSignalGuard guard;
};

ModuleCall::ModuleCall(ModuleInProcess& module, const std::string& function)
    : module_(module),
      signals_(new Signals{.running = {.on_exit = module.message(function, "ended the program"),
                                       .watchdog = &module.watchdog_,
                                       .thread = std::this_thread::get_id()},
                           .guard = FatalSignalGuard(
                               [&](const char* ending) {
                                   return module.message(function,
                                                         fmt::format("ended in {}", ending));
                               },
                               SignalsOf::ThisThread)}) {
    running.store(&signals_->running);
    const std::chrono::milliseconds limit = patience();
    module.watchdog_.start(
        limit, module.message(function, fmt::format("took more than {:g} s",
                                                    static_cast<double>(limit.count()) / 1e3)));
}

ModuleCall::~ModuleCall() {
    module_.watchdog_.stop();
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
