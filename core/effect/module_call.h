#pragma once

#include <memory>
#include <string>

#include "base/watchdog.h"

/// Code of native modules while it runs in this process, after the trial.
namespace relevo::effect {

/// A library of a plugin that is loaded, for as long as this lives: if it ends the program by
/// exit(), quick_exit(), _exit() or _Exit(), inside a call or between calls, the program says whose
/// it was and ends with status 1. What it ends by other ways (a system call of its own, SIGKILL)
/// cannot be told.
class ModuleInProcess {
  public:
    ModuleInProcess(std::string id, std::string library);
    ~ModuleInProcess();
    ModuleInProcess(const ModuleInProcess&) = delete;
    ModuleInProcess& operator=(const ModuleInProcess&) = delete;

    /// Where the library lies, once it is loaded: an address in it.
    void lies_at(const void* address);

    const std::string& id() const { return id_; }
    const std::string& library() const { return library_; }
    /// "render: plugins/vsm.so: its prepare() WHAT; --disable vsm goes on without it"
    std::string message(const std::string& function, const std::string& what) const;
    /// The start of the library whose code has that address; null without lies_at().
    const void* base() const { return base_; }

  private:
    friend class ModuleCall;
    std::string id_, library_;
    const void* base_ = nullptr;
    Watchdog watchdog_;
};

/// While this lives, a module's function runs: a fatal signal, or patience() of its own time, ends
/// the program with status 1 and the plugin's name. Before and after, signals are handled as they
/// were. Functions of modules run one at a time, whatever thread calls them: this waits for its
/// turn.
class ModuleCall {
  public:
    /// @param function  as messages name it: "prepare()"
    /// @pre no other lives on this thread
    ModuleCall(ModuleInProcess& module, const std::string& function);
    ~ModuleCall();
    ModuleCall(const ModuleCall&) = delete;
    ModuleCall& operator=(const ModuleCall&) = delete;

    /// The module waits for the host, whose time is not the module's. Nothing outside a call.
    class Pause {
      public:
        Pause();
        ~Pause();
        Pause(const Pause&) = delete;
        Pause& operator=(const Pause&) = delete;

      private:
        Watchdog* paused_;
    };

  private:
    struct Signals;
    ModuleInProcess& module_;
    std::unique_ptr<Signals> signals_;
};

}  // namespace relevo::effect
