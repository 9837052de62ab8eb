#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/loading.h"
#include "render/lod.h"

namespace relevo::render {

/// Data over the DEM that is stored in tile pages, such as heights and normals. A page is a tile of
/// a virtual texture.
struct PageLayer {
    std::string name;  ///< of its sampler, a sampler2DArray
    gl::Format format;
    int side_px = 0;
    gl::Filter filter = gl::Filter::Nearest;
    /// Texels of a page, row by row, of one slice after the other. Called on several threads,
    /// possibly after the call that requested the page; valid until the cache is destroyed.
    std::function<std::vector<std::byte>(const TileKey&)> make;
    /// Slices of the texture for each page: that of slot i has i, slots() + i, and so on.
    int slices = 1;
};

/// Least-recently-used slices of array textures. Layers share slot indices: a tile page has the
/// same slot in all of them.
class PageCache {
  public:
    PageCache();
    /// @param slots  capacity in pages
    PageCache(std::vector<PageLayer> layers, int slots);
    PageCache(PageCache&&) noexcept;
    PageCache& operator=(PageCache&&) noexcept;
    /// Waits for pages in progress.
    ~PageCache();

    /// Makes all `keys` resident, evicting the least recently used pages.
    /// @param keys  at most slots(), without duplicates
    /// @returns true if any page was added
    /// @throws what PageLayer::make throws
    bool require(std::span<const TileKey> keys);

    /// As require(), in the background: adds pages that were made since the last call, and queues
    /// missing ones in the order of `keys`.
    /// @throws what PageLayer::make threw
    bool request(std::span<const TileKey> keys);
    /// With Loading::Wait as require(). Else as request(), from coarse to fine, but the coarsest
    /// page is waited for: it covers everything.
    bool load(std::vector<TileKey> keys, Loading loading);
    /// True if pages are being made that request() would not return yet.
    bool is_making() const;

    /// The slot of a resident page, else -1.
    int slot(const TileKey& key) const;
    int slots() const;

    /// The texture of a layer, or null.
    const gl::Texture* find(std::string_view name) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
