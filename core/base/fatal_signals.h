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

/// Whose fatal signals a guard speaks for.
enum class SignalsOf {
    ThisThread,            ///< that of the thread that made it alone: code that runs on no other
    ThreadsWithoutAGuard,  ///< those of threads without a guard, too: a driver has its own threads
};

/// While this lives, code runs that is not ours (a driver's, a plugin's), and a fatal signal ends
/// the program by end_program() with a message of this. A signal of the thread that made it is
/// taken for its own, also where the stack has run out; one of a thread without a guard for that
/// of the newest guard that speaks for such threads. Guards of a thread nest; threads may have
/// theirs at once.
class FatalSignalGuard {
  public:
    /// @param message  of how the code ended, a name of kFatalSignals; called for each at once
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
