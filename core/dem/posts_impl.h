#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "dem/collar.h"
#include "dem/posts.h"
#include "dem/spikes.h"
#include "dem/tile_cache.h"

// What Posts is made of. Inside of the layer only.

namespace relevo::dem {

inline constexpr float kInfinite_m = std::numeric_limits<float>::infinity();

struct Posts::Impl {
    /// Posts of a grid round the Earth, column 0 being `first` of theirs.
    struct Unrolled {
        const Posts& posts;
        int first, round;
        Grid grid;

        int column(int of) const { return ((of + first) % round + round) % round; }
        /// Calls `body(from, count, at)` for columns that lie next to each other in both: `from` on
        /// of the others, `at` on of these.
        template <typename Body>
        void each_piece(int begin, int end, const Body& body) const {
            for (int at = begin; at < end;) {
                const int from = column(at), count = std::min(end - at, round - from);
                body(from, count, at);
                at += count;
            }
        }
        View view(const Window& window, std::vector<float>& buffer) const;
    };
    std::optional<Unrolled> unrolled;  // instead of all that follows

    std::optional<Source> own_source;
    std::optional<Heightfield> own_field;
    const Heightfield* field = nullptr;  // of posts in memory
    const Source* source = nullptr;      // else
    Description about;
    static constexpr int kLeastBlock = 32;  ///< cells a side
    int block = kLeastBlock;
    Array2d<float> block_highest_m;
    std::unique_ptr<TileCache> tiles;
    Array2d<float> thinned_m;   // of posts that are not in memory
    Spikes spikes;              // of such posts, where they matter
    std::uint64_t content = 0;  // of such posts
    std::once_flag outside_once;
    Array2d<std::uint8_t> outside;  // of thinned posts, made where it is asked for; empty: none is

    const Grid& grid() const {
        return unrolled ? unrolled->grid : field ? field->grid : source->grid();
    }
    int thinning() const {
        return (std::max(grid().columns(), grid().rows()) + kThinned - 1) / kThinned;
    }
    int thinned(int posts) const { return (posts - 1) / thinning() + 1; }
    float thinned_at(int column, int row) const {
        const int step = thinning();
        return field ? field->height_m.at(column * step, row * step) : thinned_m.at(column, row);
    }
    void find_outside();
    View view(const Window& window, std::vector<float>& buffer) const;
    void take(const Heightfield& in_memory);
    void take(const Source& on_demand, std::int64_t max_posts);
    void take(const Source& on_demand, std::int64_t max_posts, const PostsFacts& facts);
    void open(Source source, const LoadOptions& options);
    void take_own(const LoadOptions& options, const PostsFacts* facts);

  private:
    template <typename Body>
    void for_blocks(const Window& slab, const Body& body);
    void find_highest(const View& view, const Window& slab);
    std::optional<Collar> go_through(std::int64_t slab_posts);
    template <typename HeightAt>
    void keep_thinned(const Window& slab, const HeightAt& height_at);
    void settle_holes();
};

}  // namespace relevo::dem
