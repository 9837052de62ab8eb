#include "render/page_table.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <unordered_set>

namespace relevo::render {
namespace {

/// Marks missing pages.
constexpr std::uint16_t kNoLayer = 0xffff;

}  // namespace

PageTable::PageTable(int across, const char* label) {
    const auto side = static_cast<int>(std::bit_ceil(static_cast<unsigned>(across)));
    texture_ = gl::Texture(gl::TextureKind::D2, gl::Format::RG16UI, {side, side, 1}, 0, label);
    texture_.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
}

void PageTable::write(const PageCache& cache, const std::vector<TileKey>* only) {
    std::unordered_set<std::uint64_t> read;
    if (only)
        for (const TileKey& key : *only)
            read.insert(key.packed());
    std::vector<std::uint16_t> coarser;
    int coarser_side = 0;
    for (int level = texture_.levels() - 1; level >= 0; --level) {
        const int side = std::max(1, texture_.extent().width >> level);
        std::vector<std::uint16_t> entries(std::size_t{2} * static_cast<std::size_t>(side * side),
                                           kNoLayer);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                std::uint16_t* const entry = &entries[static_cast<std::size_t>(2 * (y * side + x))];
                const TileKey key{level, {x, y}};
                const int layer = only && !read.contains(key.packed()) ? -1 : cache.slot(key);
                if (layer >= 0) {
                    entry[0] = static_cast<std::uint16_t>(layer);
                    entry[1] = static_cast<std::uint16_t>(level);
                } else if (coarser_side > 0) {
                    std::copy_n(
                        &coarser[static_cast<std::size_t>(2 * ((y / 2) * coarser_side + x / 2))], 2,
                        entry);
                }
            }
        }
        texture_.write(level, {0, 0, 0}, {side, side, 1}, std::as_bytes(std::span(entries)));
        coarser = std::move(entries);
        coarser_side = side;
    }
}

}  // namespace relevo::render
