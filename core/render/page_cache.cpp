#include "render/page_cache.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <optional>

#include "base/parallel_for.h"
#include "render/page_maker.h"

namespace relevo::render {
namespace {

/// Pages in memory before their upload: enough for all threads, and few.
std::size_t batch() {
    return static_cast<std::size_t>(std::clamp(4 * thread_count(), 8, 64));
}

}  // namespace

struct PageCache::Impl {
    struct Slot {
        std::uint64_t key = ~std::uint64_t{0};
        std::uint64_t used = 0;
    };

    std::vector<PageLayer> layers;
    std::vector<gl::Texture> textures;  // one for each layer
    std::vector<Slot> slots;
    std::unordered_map<std::uint64_t, int> slot_of;
    std::uint64_t now = 0;
    std::optional<PageMaker> maker;  // last, to be destroyed before the layers it calls

    Impl(std::vector<PageLayer> given, int count)
        : layers(std::move(given)), slots(static_cast<std::size_t>(count)) {
        for (const PageLayer& layer : layers) {
            textures.emplace_back(gl::TextureKind::D2Array, layer.format,
                                  gl::Extent{layer.side_px, layer.side_px, count * layer.slices}, 1,
                                  layer.name.c_str());
            textures.back().set_sampling(layer.filter, gl::Wrap::Clamp);
        }
    }

    MadePage make(const TileKey& key) const {
        MadePage page{key, {}};
        for (const PageLayer& layer : layers)
            page.layers.push_back(layer.make(key));
        return page;
    }

    int slot(const TileKey& key) const {
        const auto found = slot_of.find(key.packed());
        return found == slot_of.end() ? -1 : found->second;
    }

    /// Marks resident pages as used. @returns the others
    std::vector<TileKey> missing(std::span<const TileKey> keys) {
        assert(keys.size() <= slots.size());
        ++now;
        std::vector<TileKey> missing;
        for (const TileKey& key : keys) {
            const int at = slot(key);
            if (at < 0)
                missing.push_back(key);
            else
                slots[static_cast<std::size_t>(at)].used = now;
        }
        return missing;
    }

    /// Slots, least recently used first.
    std::vector<int> oldest() const {
        std::vector<int> order(slots.size());
        std::iota(order.begin(), order.end(), 0);
        std::ranges::stable_sort(order, [&](int a, int b) {
            return slots[static_cast<std::size_t>(a)].used <
                   slots[static_cast<std::size_t>(b)].used;
        });
        return order;
    }

    void put(const MadePage& page, int at) {
        Slot& slot = slots[static_cast<std::size_t>(at)];
        slot_of.erase(slot.key);
        slot = {page.key.packed(), now};
        slot_of[slot.key] = at;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const int side = layers[i].side_px, slices = layers[i].slices;
            const std::span<const std::byte> texels = page.layers[i];
            const std::size_t of_slice = texels.size() / static_cast<unsigned>(slices);
            for (int slice = 0; slice < slices; ++slice)
                textures[i].write(
                    0, {0, 0, at + slice * static_cast<int>(slots.size())}, {side, side, 1},
                    texels.subspan(static_cast<unsigned>(slice) * of_slice, of_slice));
        }
    }

    bool require(std::span<const TileKey> keys) {
        const std::vector<TileKey> wanted = missing(keys);
        if (wanted.empty()) return false;
        const std::vector<int> order = oldest();
        for (std::size_t begin = 0; begin < wanted.size(); begin += batch()) {
            const std::span keys_of_batch =
                std::span(wanted).subspan(begin, std::min(batch(), wanted.size() - begin));
            const std::vector<MadePage> pages =
                make_pages(keys_of_batch, [this](const TileKey& key) { return make(key); });
            for (std::size_t i = 0; i < pages.size(); ++i)
                put(pages[i], order[begin + i]);
        }
        return true;
    }

    bool request(std::span<const TileKey> keys) {
        std::vector<TileKey> wanted = missing(keys);
        if (!maker) {
            if (wanted.empty()) return false;
            maker.emplace([this](const TileKey& key) { return make(key); });
        }
        const std::vector<int> order = oldest();
        std::size_t next = 0;
        for (const MadePage& page : maker->take()) {
            const auto found = std::ranges::find(wanted, page.key);
            if (found == wanted.end()) continue;  // no longer requested, or already resident
            put(page, order[next++]);
            wanted.erase(found);
        }
        maker->want(std::move(wanted));
        return next > 0;
    }
};

PageCache::PageCache() = default;

PageCache::PageCache(std::vector<PageLayer> layers, int slots)
    : impl_(std::make_unique<Impl>(std::move(layers), slots)) {}

PageCache::PageCache(PageCache&&) noexcept = default;
PageCache& PageCache::operator=(PageCache&&) noexcept = default;
PageCache::~PageCache() = default;

bool PageCache::require(std::span<const TileKey> keys) {
    return impl_->require(keys);
}

bool PageCache::request(std::span<const TileKey> keys) {
    return impl_->request(keys);
}

bool PageCache::load(std::vector<TileKey> keys, Loading loading) {
    if (loading == Loading::Wait || keys.empty()) return require(keys);
    std::ranges::stable_sort(keys,
                             [](const TileKey& a, const TileKey& b) { return a.level > b.level; });
    const bool came = require(std::span(keys).first(1));
    return request(keys) || came;
}

bool PageCache::is_making() const {
    return impl_ && impl_->maker && impl_->maker->is_at_work();
}

int PageCache::slot(const TileKey& key) const {
    return impl_->slot(key);
}

int PageCache::slots() const {
    return static_cast<int>(impl_->slots.size());
}

const gl::Texture* PageCache::find(std::string_view name) const {
    if (!impl_) return nullptr;
    for (std::size_t i = 0; i < impl_->layers.size(); ++i)
        if (impl_->layers[i].name == name) return &impl_->textures[i];
    return nullptr;
}

}  // namespace relevo::render
