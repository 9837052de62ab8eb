#include <csignal>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/fatal_signals.h"

namespace relevo {
namespace {

FatalSignalGuard guard_of(const std::string& who, SignalsOf whose) {
    return FatalSignalGuard([&](const char* ending) { return who + " ended in " + ending; }, whose);
}

TEST(FatalSignals, AreOfTheCodeThatRunsOnTheirThread) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers handle signals themselves";
#endif
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            const auto program = guard_of("the program", SignalsOf::ThreadsWithoutAGuard);
            const auto module = guard_of("the module", SignalsOf::ThisThread);
            raise(SIGSEGV);
        },
        testing::ExitedWithCode(1), "the module ended in a segmentation fault");
    EXPECT_EXIT(
        {
            const auto program = guard_of("the program", SignalsOf::ThreadsWithoutAGuard);
            const auto module = guard_of("the module", SignalsOf::ThisThread);
            std::thread([] { raise(SIGSEGV); }).join();
        },
        testing::ExitedWithCode(1), "the program ended in a segmentation fault");
    EXPECT_EXIT(
        {
            const auto program = guard_of("the program", SignalsOf::ThreadsWithoutAGuard);
            const auto driver = guard_of("the driver", SignalsOf::ThreadsWithoutAGuard);
            std::thread([] { raise(SIGABRT); }).join();
        },
        testing::ExitedWithCode(1), "the driver ended in an abort");
}

}  // namespace
}  // namespace relevo
