#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "base/parallel_for.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
    std::vector<std::atomic<int>> seen(100003);
    parallel_for(0, static_cast<int>(seen.size()), 7, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            ++seen[static_cast<std::size_t>(i)];
    });
    for (const std::atomic<int>& count : seen)
        ASSERT_EQ(count, 1);
}

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
    parallel_for(5, 5, 1, [](int, int) { FAIL(); });
    parallel_for(5, 4, 1, [](int, int) { FAIL(); });
}

TEST(ParallelFor, PassesAnErrorOn) {
    EXPECT_EQ(test::error_of([] {
                  parallel_for(0, 1000, 1, [](int first, int) {
                      if (first == 0) bad_input("piece 0");
                  });
              }),
              "exit 3: piece 0");
}

TEST(ParallelFor, BeginsNoPieceAfterAnError) {
    if (thread_count() < 2) GTEST_SKIP() << "one thread does all in one piece";
    std::atomic<int> begun = 0;
    EXPECT_EQ(test::error_of([&] {
                  parallel_for(0, 1 << 20, 1, [&](int first, int) {
                      ++begun;
                      if (first == 0) bad_input("piece 0");
                      std::this_thread::sleep_for(std::chrono::milliseconds(50));
                  });
              }),
              "exit 3: piece 0");
    EXPECT_LT(begun, 2 * thread_count());
}

TEST(ParallelFor, DoesWithoutThreadsThatTheSystemDoesNotGive) {
    EXPECT_EXIT(
        {
            thread_count();
            // Root is exempt from the limit.
            if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(8);
            const rlimit none{};
            setrlimit(RLIMIT_NPROC, &none);
            std::atomic<int> seen = 0;
            const std::string error = test::error_of([&] {
                parallel_for(0, 1000, 1, [&](int first, int last) { seen += last - first; });
            });
            _exit(error == "no error" && seen == 1000 ? 7 : 6);
        },
        testing::ExitedWithCode(7), "");
}

TEST(ParallelFor, SaysWhetherTheSystemGivesThreads) {
    EXPECT_TRUE(can_start_threads(4));
    EXPECT_EXIT(
        {
            rlimit little{};
            little.rlim_cur = little.rlim_max = rlim_t{256} << 20;
            setrlimit(RLIMIT_AS, &little);
            _exit(can_start_threads(200) ? 6 : 7);
        },
        testing::ExitedWithCode(7), "");
}

TEST(ParallelFor, ReachesTheGreatestNumber) {
    constexpr int kMax = std::numeric_limits<int>::max();
    std::atomic<std::int64_t> seen = 0;
    parallel_for(-1, kMax, 1, [&](int first, int last) {
        EXPECT_LE(-1, first);
        EXPECT_LT(first, last);
        seen += std::int64_t{last} - first;
    });
    EXPECT_EQ(seen, std::int64_t{kMax} + 1);
}

TEST(ParallelFor, MayBeCalledFromInsideAndFromSeveralThreads) {
    std::atomic<int> count = 0;
    const auto nested = [&] {
        parallel_for(0, 64, 1, [&](int first, int last) {
            for (int i = first; i < last; ++i)
                parallel_for(0, 32, 1, [&](int a, int b) { count += b - a; });
        });
    };
    {
        std::vector<std::jthread> callers;
        for (int i = 0; i < 4; ++i)
            callers.emplace_back(nested);
        nested();
    }
    EXPECT_EQ(count, 5 * 64 * 32);
}

TEST(ParallelFor, KeepsItsThreads) {
    std::mutex mutex;
    std::set<std::thread::id> ids;
    for (int call = 0; call < 200; ++call)
        parallel_for(0, 64, 1, [&](int, int) {
            const std::lock_guard lock(mutex);
            ids.insert(std::this_thread::get_id());
        });
    EXPECT_LE(ids.size(), static_cast<std::size_t>(thread_count()));
}

}  // namespace
}  // namespace relevo
