#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "base/fatal_signals.h"
#include "base/watchdog.h"

/// Code of native modules while it runs in this process, after the trial.
namespace relevo::effect {

/// A plugin's library in this process. If it ends the program by exit(), quick_exit(), _exit() or
/// _Exit(), in a call or between calls, the program ends with status 1 and a message that names it.
/// An end by a system call of its own or by SIGKILL has no message.
class ModuleInProcess {
  public:
    ModuleInProcess(std::string id, std::filesystem::path library);
    ~ModuleInProcess();
    ModuleInProcess(const ModuleInProcess&) = delete;
    ModuleInProcess& operator=(const ModuleInProcess&) = delete;

    /// @param address  in the library, once it is loaded: code there is the module's
    void set_address(const void* address);

    const std::string& id() const { return id_; }
    const std::filesystem::path& library() const { return library_; }
    /// "effect: plugins/vsm.so: its prepare() WHAT; --disable vsm goes on without it"
    std::string message(const std::string& function, const std::string& what) const;
    /// Where the library begins in memory; null before set_address().
    const void* base() const { return base_; }

  private:
    friend class ModuleCall;
    std::string id_;
    std::filesystem::path library_;
    const void* base_ = nullptr;
    Watchdog watchdog_;
};

/// While this lives, a function of a module runs. A fatal signal of this thread, or more than
/// patience() of the function's own time, ends the program with status 1 and a message that names
/// the plugin. Signals are handled as before afterwards. Functions of modules run one at a time on
/// all threads: this waits for its turn.
class ModuleCall {
  public:
    /// @param function  as messages name it: "prepare()"
    /// @pre no other lives on this thread
    ModuleCall(ModuleInProcess& module, const std::string& function);
    ~ModuleCall();
    ModuleCall(const ModuleCall&) = delete;
    ModuleCall& operator=(const ModuleCall&) = delete;

    /// The message if the function ends the program.
    const char* exit_message() const { return exit_message_.c_str(); }

    /// While this lives, the module waits for the host: the time does not count. Does nothing
    /// outside a call.
    class Pause {
      public:
        Pause();
        ~Pause();
        Pause(const Pause&) = delete;
        Pause& operator=(const Pause&) = delete;

      private:
        Watchdog* watchdog_ = nullptr;
    };

  private:
    std::unique_lock<std::mutex> turn_;
    ModuleInProcess& module_;
    std::string exit_message_;
    std::thread::id thread_ = std::this_thread::get_id();
    FatalSignalGuard guard_;
};

}  // namespace relevo::effect
