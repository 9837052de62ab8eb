#include "base/memory_budget.h"

#include <gtest/gtest.h>

namespace relevo {
namespace {

TEST(MemoryBudget, TheDefaultHoldsAGiBOfHeights) {
    const MemoryBudget budget = MemoryBudget::of_mib(MemoryBudget::kDefault_mib);
    EXPECT_EQ(budget.posts, std::int64_t{1} << 28);
    EXPECT_EQ(budget.means, std::int64_t{1} << 27);
    EXPECT_GE(budget.light_posts, 1 << 25) << "all that shadows are computed for";
    EXPECT_EQ(budget.mib(), 3072);
}

TEST(MemoryBudget, PartsAreNoMoreThanTheWhole) {
    for (const std::int64_t mib : {64, 128, 256, 512, 1024, 3072, 1 << 20}) {
        const MemoryBudget budget = MemoryBudget::of_mib(mib);
        const std::int64_t parts = budget.posts * MemoryBudget::kBytesAPost / 2 +
                                   budget.light_posts * MemoryBudget::kBytesALightPost +
                                   budget.page_bytes + budget.block_bytes + budget.work_bytes;
        EXPECT_LE(parts, budget.total_bytes * 5 / 4) << mib;
    }
}

TEST(MemoryBudget, SaysHowMuchPostsNeed) {
    for (const std::int64_t posts : {1, 87'381, 87'382, 1'000'000, 268'435'456, 268'435'457}) {
        const std::int64_t mib = MemoryBudget::mib_for_posts(posts);
        EXPECT_GE(MemoryBudget::of_mib(mib).posts, posts);
        if (mib > 1) EXPECT_LT(MemoryBudget::of_mib(mib - 1).posts, posts);
    }
}

}  // namespace
}  // namespace relevo
