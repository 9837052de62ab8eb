#include <atomic>
#include <vector>

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

}  // namespace
}  // namespace relevo
