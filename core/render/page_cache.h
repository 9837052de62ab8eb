#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "gl/texture.h"
#include "render/lod.h"

namespace relevo::render {

/// A texture array whose layers hold the pages that were used last.
class PageCache {
  public:
    /// Makes the texels of a page; called on several threads at once.
    using Make = std::function<std::vector<std::byte>(const TileKey&)>;

    PageCache() = default;
    /// @param layers  the most pages that are kept
    PageCache(gl::Format format, int side_px, int layers, gl::Filter filter, const char* label);

    /// Sees to it that all `keys` have a layer, at the cost of those not used for longest.
    /// @param keys  at most layers() of them, none twice
    /// @returns whether any page was made
    bool require(std::span<const TileKey> keys, const Make& make);

    /// The layer of a page that the last require() named or that is still there; -1 for none.
    int layer(const TileKey& key) const;

    int layers() const { return texture_.extent().depth; }
    const gl::Texture& texture() const { return texture_; }

  private:
    struct Layer {
        std::uint64_t key = ~std::uint64_t{0};
        std::uint64_t used = 0;
    };

    gl::Texture texture_;
    std::vector<Layer> layers_;
    std::unordered_map<std::uint64_t, int> layer_of_;
    std::uint64_t now_ = 0;
};

}  // namespace relevo::render
