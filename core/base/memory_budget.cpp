#include "base/memory_budget.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo {
namespace {

/// The tile pages of one view, and light for a DEM that just fills it.
constexpr std::int64_t kLeastOfPictures_mib = 64;

}  // namespace

MemoryBudget MemoryBudget::of_mib(std::int64_t mib) {
    const std::int64_t bytes = mib * kMiB;
    return {.total_bytes = bytes,
            .posts = bytes / kBytesAPost,
            .means = bytes / (2 * kBytesAPost),
            .light_posts = bytes * 7 / 32 / kBytesALightPost,
            .page_bytes = std::min(bytes / 4, 512 * kMiB),
            .block_bytes = std::clamp(bytes / 8, 8 * kMiB, 256 * kMiB),
            .work_bytes = std::clamp(bytes / 16, kMiB, 64 * kMiB)};
}

MemoryBudget MemoryBudget::of_posts(std::int64_t posts) {
    MemoryBudget budget = of_mib(kDefault_mib);
    budget.posts = budget.means = posts;
    return budget;
}

std::int64_t MemoryBudget::mib_for_posts(std::int64_t posts) {
    return std::max<std::int64_t>(1, (posts * kBytesAPost + kMiB - 1) / kMiB);
}

void MemoryBudget::check_for_pictures() const {
    if (total_bytes < kLeastOfPictures_mib * kMiB)
        bad_input(fmt::format("--memory {}: pictures need at least {}", mib(),
                              kLeastOfPictures_mib));
}

}  // namespace relevo
