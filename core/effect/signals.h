#pragma once

#include <array>
#include <csignal>

namespace relevo::effect {

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

}  // namespace relevo::effect
