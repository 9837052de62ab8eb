#include "figure/estimate.h"

#include <algorithm>
#include <cmath>

#include "light/sweep/sweep.h"

namespace relevo::figure {
namespace {

// Measured: the program with its libraries; what GDAL keeps of a file that it writes, and how many
// tiles of all bands it has at once then.
constexpr double kMiB = 1 << 20;  // bytes
constexpr double kProgram_mib = 120, kWriting_mib = 256, kTilesAtOnce = 20;
// Measured: while a tile is read with its halo, what is put together.
constexpr double kSite_mib = 64;
constexpr double kTile = 512;  // posts a side

}  // namespace

void SampledTime::begin_part(double share, double now_s) {
    parts_share_ += share;
    is_first_ = true;
    last_s_ = now_s;
}

void SampledTime::end_step(double share, double now_s) {
    (is_first_ ? ready_share_ : steps_share_) += share;
    (is_first_ ? ready_s_ : steps_s_) += now_s - last_s_;
    is_first_ = false;
    last_s_ = now_s;
}

bool SampledTime::suffices() const {
    constexpr double kRounding = 1e-9;
    return steps_share_ > 0 || ready_share_ > (1 - kRounding) * parts_share_;
}

double SampledTime::all_s() const {
    if (parts_share_ <= 0) return 0;
    const double of_steps = std::max(0.0, 1 - ready_share_ / parts_share_);
    return ready_s_ / parts_share_ + (steps_share_ > 0 ? steps_s_ / steps_share_ * of_steps : 0);
}

RasterMemory raster_memory(const dem::Posts& posts, double part_posts, const dem::Window& raster,
                           int bytes_a_post, int bytes_a_value, std::size_t bands,
                           const MemoryBudget& memory, double far_bytes) {
    const dem::Grid& grid = posts.grid();
    // What is kept of the heights, what sweeps keep of those in memory, and the file's blocks.
    const double all = double(grid.columns()) * grid.rows(), a_height = sizeof(float);
    const double turned = far_bytes > 0 ? 0 : light::Sweep::kBytesAPost;
    const double heights = (posts.in_memory() ? (a_height + turned) * all
                                              : a_height * static_cast<double>(memory.posts)) +
                           std::min(static_cast<double>(memory.block_bytes), a_height * all) +
                           far_bytes + (far_bytes > 0 ? kSite_mib * kMiB : 0);
    // A result is written from what is kept of it.
    const double tiles = std::ceil(raster.columns / kTile) * std::ceil(raster.rows / kTile);
    const double band = bytes_a_value, tile = kTile * kTile * band * static_cast<double>(bands);
    const double writing = part_posts * band + std::min(kWriting_mib * kMiB, tiles * tile) +
                           std::min(kTilesAtOnce, 3 * tiles + 2) * tile;
    return {(heights + std::max(part_posts * bytes_a_post, writing)) / kMiB + kProgram_mib,
            heights / kMiB};
}

}  // namespace relevo::figure
