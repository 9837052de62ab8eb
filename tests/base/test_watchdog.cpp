#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "base/watchdog.h"

namespace relevo {
namespace {

using std::chrono::milliseconds;

void sleep_ms(int count) {
    std::this_thread::sleep_for(milliseconds(count));
}

TEST(WatchdogDeathTest, EndsTheProgramWithItsMessage) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            Watchdog watchdog;
            watchdog.start(milliseconds(50), "it hangs");
            sleep_ms(20000);
        },
        testing::ExitedWithCode(1), "^relevo: error: it hangs\n$");
}

void compute_ms(int count) {
    const auto end = std::chrono::steady_clock::now() + milliseconds(count);
    while (std::chrono::steady_clock::now() < end) {
    }
}

TEST(WatchdogDeathTest, EndsCodeThatComputesAfterItsLimit) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            Watchdog watchdog;
            watchdog.start(milliseconds(2000), "it hangs");
            compute_ms(11000);
            std::_Exit(0);
        },
        testing::ExitedWithCode(1), "^relevo: error: it hangs\n$");
}

TEST(Watchdog, WaitsForProcessorTimeThatABusyMachineDoesNotGive) {
    Watchdog watchdog;
    watchdog.start(milliseconds(1000), "never said");
    sleep_ms(2500);
    watchdog.stop();
    // Nor is the time of a pause the code's.
    watchdog.start(milliseconds(1000), "never said");
    watchdog.pause();
    compute_ms(1200);
    watchdog.go_on();
    sleep_ms(1200);
    watchdog.stop();
}

TEST(Watchdog, LetsGoWhatStopsInTime) {
    Watchdog watchdog;
    watchdog.start(milliseconds(200), "never said");
    watchdog.stop();
    sleep_ms(400);
    watchdog.start(milliseconds(200), "never said");
    watchdog.start(milliseconds(60000), "never said");
    sleep_ms(400);
}

TEST(Watchdog, DoesNotCountPauses) {
    Watchdog watchdog;
    watchdog.start(milliseconds(200), "never said");
    watchdog.pause();
    sleep_ms(400);
    watchdog.stop();
    watchdog.pause();
    watchdog.go_on();
    sleep_ms(400);
}

TEST(WatchdogDeathTest, CountsOnAfterAPause) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            Watchdog watchdog;
            watchdog.start(milliseconds(100), "it hangs");
            watchdog.pause();
            sleep_ms(300);
            watchdog.go_on();
            sleep_ms(20000);
        },
        testing::ExitedWithCode(1), "^relevo: error: it hangs\n$");
}

}  // namespace
}  // namespace relevo
