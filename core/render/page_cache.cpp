#include "render/page_cache.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "base/parallel_for.h"

namespace relevo::render {
namespace {

constexpr int kBatch = 64;  // pages that are made before they are handed to the device

}  // namespace

PageCache::PageCache(gl::Format format, int side_px, int layers, gl::Filter filter,
                     const char* label)
    : texture_(gl::TextureKind::D2Array, format, {side_px, side_px, layers}, 1, label),
      layers_(static_cast<std::size_t>(layers)) {
    texture_.set_sampling(filter, gl::Wrap::Clamp);
}

int PageCache::layer(const TileKey& key) const {
    const auto found = layer_of_.find(key.packed());
    return found == layer_of_.end() ? -1 : found->second;
}

bool PageCache::require(std::span<const TileKey> keys, const Make& make) {
    assert(keys.size() <= layers_.size());
    ++now_;
    std::vector<TileKey> missing;
    for (const TileKey& key : keys) {
        const int at = layer(key);
        if (at < 0)
            missing.push_back(key);
        else
            layers_[static_cast<std::size_t>(at)].used = now_;
    }
    if (missing.empty()) return false;

    std::vector<int> oldest(layers_.size());
    std::iota(oldest.begin(), oldest.end(), 0);
    std::stable_sort(oldest.begin(), oldest.end(), [&](int a, int b) {
        return layers_[static_cast<std::size_t>(a)].used <
               layers_[static_cast<std::size_t>(b)].used;
    });
    const int side = texture_.extent().width;
    std::vector<std::vector<std::byte>> pages;
    for (std::size_t begin = 0; begin < missing.size(); begin += kBatch) {
        const std::size_t count = std::min<std::size_t>(kBatch, missing.size() - begin);
        pages.assign(count, {});
        parallel_for(0, static_cast<int>(count), 1, [&](int first, int last) {
            for (int i = first; i < last; ++i)
                pages[static_cast<std::size_t>(i)] =
                    make(missing[begin + static_cast<std::size_t>(i)]);
        });
        for (std::size_t i = 0; i < count; ++i) {
            const int at = oldest[begin + i];
            Layer& layer = layers_[static_cast<std::size_t>(at)];
            layer_of_.erase(layer.key);
            layer = {missing[begin + i].packed(), now_};
            layer_of_[layer.key] = at;
            texture_.write(0, {0, 0, at}, {side, side, 1}, pages[i]);
        }
    }
    return true;
}

}  // namespace relevo::render
