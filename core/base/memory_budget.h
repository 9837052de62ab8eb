#pragma once

#include <cstdint>

namespace relevo {

/// What parts of a run may take of the memory that it is given (`--memory`), above the floor: what
/// the same run takes for a DEM of 2 x 2 posts. A value that is passed down; all of it follows from
/// one number.
///
/// Posts have more than their heights: coarser levels in pictures, sweeps and results in figures.
/// Means of a DEM that is larger than memory have about twice as much, because their finest level
/// is no copy of the heights.
struct MemoryBudget {
    bool operator==(const MemoryBudget&) const = default;

    static constexpr std::int64_t kMiB = std::int64_t{1} << 20;
    static constexpr std::int64_t kDefault_mib = 3072;  ///< 1 GiB of heights
    static constexpr std::int64_t kBytesAPost = 12;     ///< of figures; 4 of them are its height
    /// Of figures over a DEM that is held whole: height, the same turned, results, and what writes
    /// them; as measured for the sky view.
    static constexpr std::int64_t kBytesAWholePost = 24;

    bool is_of_pictures = false;  ///< by for_pictures()
    std::int64_t total_bytes = 0;
    std::int64_t posts = 0;        ///< that figures hold, in tiles
    std::int64_t whole_posts = 0;  ///< of a DEM that figures hold whole
    std::int64_t drawn_posts = 0;  ///< that pictures hold of a whole DEM
    std::int64_t means = 0;        ///< that they hold of a DEM with more posts
    std::int64_t light_posts = 0;  ///< for which pictures compute shadows
    std::int64_t view_bytes = 0;   ///< tile pages and triangles, on the device
    std::int64_t block_bytes = 0;  ///< GDAL's cache of blocks, which several DEMs share
    std::int64_t work_bytes = 0;   ///< buffers while heights are read

    /// @param mib  1 or more
    static MemoryBudget of_mib(std::int64_t mib) noexcept;
    /// The default, but for so many posts or means.
    static MemoryBudget of_posts(std::int64_t posts) noexcept;
    /// The least MiB whose budget holds so many posts.
    static std::int64_t mib_for_posts(std::int64_t posts);

    std::int64_t mib() const { return total_bytes / kMiB; }
    /// For the same use, with other MiB, as of_mib().
    MemoryBudget with_mib(std::int64_t mib) const;

    /// `posts` and `whole_posts` are no more than `drawn_posts`. @throws Error (BadInput) if
    /// pictures need more; the message says how much
    MemoryBudget for_pictures() const;

    /// Makes the C library return freed memory at once if the budget is small: else it keeps up to
    /// 44 MiB. For programs, before they start threads.
    void return_what_is_freed() const;
};

}  // namespace relevo
