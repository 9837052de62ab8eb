#include "base/memory_budget.h"

#include <algorithm>

#include <fmt/format.h>
#include <malloc.h>

#include "base/error.h"

// An allocator that counts was rejected, because drivers and GDAL do not use it. Below 512 MiB
// return_what_is_freed() has glibc return freed memory at once, because arenas of several threads
// kept 9 to 44 MiB.
namespace relevo {
namespace {

/// The tile pages of one view, and light for a DEM that just fills it.
constexpr std::int64_t kLeastOfPictures_mib = 64;

/// Finer heights are read where a view needs them: more means would only have to be read. So many
/// have 100 000 x 100 000 posts at a reduction of 16, which a picture of all of them needs.
constexpr std::int64_t kMostMeans = std::int64_t{1} << 26;
/// A DEM of more posts is drawn from means and finer heights sooner than from all of them.
constexpr std::int64_t kMostDrawn = std::int64_t{1} << 26;

/// Views of 1280 x 1024 pixels need 40 to 150 MiB, whatever the DEM; pools of tiles take 576 at
/// most.
std::int64_t view_bytes_of(std::int64_t bytes) {
    constexpr std::int64_t kOfAView = 160 * MemoryBudget::kMiB, kMost = 576 * MemoryBudget::kMiB;
    return std::clamp(bytes / 4, std::min(bytes * 11 / 16, kOfAView), kMost);
}

}  // namespace

MemoryBudget MemoryBudget::of_mib(std::int64_t mib) noexcept {
    constexpr std::int64_t kBytesADrawnPost = 5;   // a height, and the levels' third of it
    constexpr std::int64_t kBytesAMean = 12;       // a height, two levels with coverage, water
    constexpr std::int64_t kBytesALightPost = 20;  // heights, sweeps, results, textures
    const std::int64_t bytes = mib * kMiB;
    MemoryBudget budget{.total_bytes = bytes,
                        .posts = bytes / kBytesAPost,
                        .whole_posts = bytes / kBytesAWholePost,
                        .view_bytes = view_bytes_of(bytes),
                        .block_bytes = std::clamp(bytes / 8, 8 * kMiB, 256 * kMiB),
                        .work_bytes = std::clamp(bytes / 32, kMiB, 64 * kMiB)};
    const std::int64_t light_bytes = bytes / 16 + std::max<std::int64_t>(0, bytes - 256 * kMiB) / 6;
    budget.light_posts = light_bytes / kBytesALightPost;
    const std::int64_t rest = std::max<std::int64_t>(
        0, bytes - light_bytes - budget.view_bytes - budget.block_bytes - budget.work_bytes);
    budget.drawn_posts = std::min(rest / kBytesADrawnPost, kMostDrawn);
    budget.means = std::min(rest / kBytesAMean, kMostMeans);
    return budget;
}

MemoryBudget MemoryBudget::of_posts(std::int64_t posts) noexcept {
    MemoryBudget budget = of_mib(kDefault_mib);
    budget.posts = budget.whole_posts = budget.means = posts;
    return budget;
}

std::int64_t MemoryBudget::mib_for_posts(std::int64_t posts) {
    return std::max<std::int64_t>(1, (posts * kBytesAPost + kMiB - 1) / kMiB);
}

MemoryBudget MemoryBudget::with_mib(std::int64_t mib) const {
    return is_of_pictures ? of_mib(mib).for_pictures() : of_mib(mib);
}

MemoryBudget MemoryBudget::for_pictures() const {
    if (total_bytes < kLeastOfPictures_mib * kMiB)
        bad_input(
            fmt::format("--memory {}: pictures need at least {}", mib(), kLeastOfPictures_mib));
    MemoryBudget pictures = *this;
    pictures.is_of_pictures = true;
    pictures.posts = pictures.whole_posts = std::min(posts, drawn_posts);
    return pictures;
}

void MemoryBudget::return_what_is_freed() const {
    constexpr std::int64_t kMuch_mib = 512;  // of which that is a small part
    constexpr int kLarge = 4 << 20;  // bytes: what a strip of a sweep takes again and again is not
    if (mib() >= kMuch_mib) return;
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TRIM_THRESHOLD, kLarge);
    mallopt(M_MMAP_THRESHOLD, kLarge);
}

}  // namespace relevo
