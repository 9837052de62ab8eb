#include <gtest/gtest.h>

#include "base/memory_budget.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(MemoryBudget, TheDefaultHoldsAGiBOfHeights) {
    const MemoryBudget budget = MemoryBudget::of_mib(MemoryBudget::kDefault_mib);
    EXPECT_EQ(budget.posts, std::int64_t{1} << 28);
    EXPECT_EQ(budget.for_pictures().posts, std::int64_t{1} << 26);
    EXPECT_EQ(budget.means, std::int64_t{1} << 26);
    EXPECT_GE(budget.light_posts, 1 << 25) << "all that shadows are computed for";
    EXPECT_EQ(budget.mib(), 3072);
}

TEST(MemoryBudget, PartsAreTheWhole) {
    for (const std::int64_t mib : {64, 128, 256, 512, 1024, 3072, 1 << 20}) {
        const MemoryBudget budget = MemoryBudget::of_mib(mib);
        const std::int64_t parts = budget.means * 12 + budget.light_posts * 20 + budget.view_bytes +
                                   budget.block_bytes + budget.work_bytes;
        EXPECT_LE(parts, budget.total_bytes) << mib;
        if (mib <= 512) {
            EXPECT_GE(parts, budget.total_bytes - 32) << mib;
        }
        EXPECT_GT(budget.means, 500'000) << "finer than a screen";
    }
}

TEST(MemoryBudget, PicturesHaveALeast) {
    EXPECT_EQ(test::error_of([] { MemoryBudget::of_mib(63).for_pictures(); }),
              "exit 3: --memory 63: pictures need at least 64");
    EXPECT_EQ(MemoryBudget::of_mib(64).for_pictures().mib(), 64);
    EXPECT_GT(MemoryBudget::of_mib(1).posts, 80'000) << "figures have none";
}

TEST(MemoryBudget, SaysHowMuchPostsNeed) {
    for (const std::int64_t posts : {1, 87'381, 87'382, 1'000'000, 268'435'456, 268'435'457}) {
        const std::int64_t mib = MemoryBudget::mib_for_posts(posts);
        EXPECT_GE(MemoryBudget::of_mib(mib).posts, posts);
        EXPECT_TRUE(mib == 1 || MemoryBudget::of_mib(mib - 1).posts < posts);
    }
}

}  // namespace
}  // namespace relevo
