#pragma once

#include <array>
#include <csignal>
#include <functional>
#include <memory>
#include <string>

namespace relevo {

/// Signals that end a program because its code is wrong.
struct FatalSignal {
    int number;
    const char* name;  ///< as it ends "its registration ended in ..."
};

inline constexpr std::array kFatalSignals{
    FatalSignal{SIGSEGV, "a segmentation fault"}, FatalSignal{SIGABRT, "an abort"},
    FatalSignal{SIGBUS, "a bus error"},           FatalSignal{SIGILL, "an illegal instruction"},
    FatalSignal{SIGFPE, "an arithmetic error"},   FatalSignal{SIGTRAP, "a trap"},
    FatalSignal{SIGSYS, "a bad system call"}};

/// The threads whose fatal signals a guard handles.
enum class SignalsOf {
    ThisThread,            ///< only the thread that created the guard
    ThreadsWithoutAGuard,  ///< also threads without a guard: a driver has its own threads
};

/// While this lives, code runs that is not ours (a driver's, a plugin's). A fatal signal calls
/// end_program() with this guard's message. A thread's signal belongs to its innermost guard, also
/// after a stack overflow. A signal of a thread without a guard belongs to the newest guard for
/// ThreadsWithoutAGuard. Guards of a thread nest. Several threads may have guards.
class FatalSignalGuard {
  public:
    /// @param message  of an ending, a name of kFatalSignals; called for all of them here
    explicit FatalSignalGuard(const std::function<std::string(const char* ending)>& message,
                              SignalsOf whose = SignalsOf::ThreadsWithoutAGuard);
    ~FatalSignalGuard();
    FatalSignalGuard(const FatalSignalGuard&) = delete;
    FatalSignalGuard& operator=(const FatalSignalGuard&) = delete;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo
