#include "effect/module_call.h"

#include <atomic>
#include <cstdlib>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/host_program.h"

namespace relevo::effect {
namespace {

// For handlers of exits, which get no argument.

/// The call that runs. One of the process: a module may have threads of its own.
std::atomic<const ModuleCall*> running{nullptr};
std::mutex call_mutex;

std::mutex modules_mutex;
std::vector<const ModuleInProcess*> modules;  // that are loaded

/// main() unloads all modules: if one is loaded, it has ended the program. Another program may exit
/// with modules loaded.
void on_exit_of_the_program() {
    if (const ModuleCall* call = running.load()) end_program(call->exit_message());
    const std::lock_guard lock(modules_mutex);
    if (!modules.empty() && !is_hosted())
        end_program(modules.back()->message("", "ended the program").c_str());
}

void watch_for_exits() {
    static const bool once = [] {
        std::atexit(on_exit_of_the_program);
        std::at_quick_exit(on_exit_of_the_program);
        return true;
    }();
    static_cast<void>(once);
}

/// Where the library begins in memory that holds an address.
const void* base_of(const void* address) {
    Dl_info info{};
    return dladdr(address, &info) != 0 ? info.dli_fbase : nullptr;
}

/// Ends the program with a message if code of a module called _exit().
void check_exit(const void* caller) {
    const void* base = base_of(caller);
    // While a registration runs, its library's place is not known yet: all code that is not the
    // program's own counts as the module's.
    const ModuleCall* const call = running.load();
    if (call && base != base_of(reinterpret_cast<const void*>(&base_of)))
        end_program(call->exit_message());
    const std::unique_lock lock(modules_mutex, std::try_to_lock);
    if (!base || !lock) return;
    for (const ModuleInProcess* module : modules)
        if (module->base() == base) end_program(module->message("", "ended the program").c_str());
}

}  // namespace

ModuleInProcess::ModuleInProcess(std::string id, std::filesystem::path library)
    : id_(std::move(id)), library_(std::move(library)) {
    watch_for_exits();
    const std::lock_guard lock(modules_mutex);
    modules.push_back(this);
}

ModuleInProcess::~ModuleInProcess() {
    const std::lock_guard lock(modules_mutex);
    std::erase(modules, this);
}

void ModuleInProcess::set_address(const void* address) {
    base_ = base_of(address);
}

std::string ModuleInProcess::message(const std::string& function, const std::string& what) const {
    return fmt::format("effect: {}: {} {}; --disable {} goes on without it", library_.string(),
                       function.empty() ? "its code" : "its " + function, what, id_);
}

ModuleCall::ModuleCall(ModuleInProcess& module, const std::string& function)
    : turn_(call_mutex),
      module_(module),
      exit_message_(module.message(function, "ended the program")),
      guard_(
          [&](const char* ending) {
              return module.message(function, fmt::format("ended in {}", ending));
          },
          SignalsOf::ThisThread) {
    running.store(this);
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
    const ModuleCall* const call = running.load();
    if (!call || call->thread_ != std::this_thread::get_id()) return;
    watchdog_ = &call->module_.watchdog_;
    watchdog_->pause();
}

ModuleCall::Pause::~Pause() {
    if (watchdog_) watchdog_->go_on();
}

}  // namespace relevo::effect

// These replace the C library's for modules: the linkers of GNU and LLVM export them, because a
// library that the program links has the same names.
extern "C" void _exit(int status) {
    relevo::effect::check_exit(__builtin_return_address(0));
    while (true)
        syscall(SYS_exit_group, status);
}

extern "C" void _Exit(int status) noexcept {
    relevo::effect::check_exit(__builtin_return_address(0));
    while (true)
        syscall(SYS_exit_group, status);
}
