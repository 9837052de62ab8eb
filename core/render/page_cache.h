#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/lod.h"

namespace relevo::render {

/// What lies on the ground by place, cut into pages: heights, normals, and whatever else has texels
/// for a tile. Adding one here is all that a new kind of page takes on this side.
struct PageLayer {
    std::string name;  ///< of its sampler, a sampler2DArray
    gl::Format format;
    int side_px = 0;
    gl::Filter filter = gl::Filter::Nearest;
    /// Texels of a page, row after row. Called on several threads at once, also after the call that
    /// asked for the page; must hold until the cache is gone.
    std::function<std::vector<std::byte>(const TileKey&)> make;
};

/// Pages of layers that are cut alike. A page has one slot in all of them, which is its layer in
/// each of their array textures; slots hold the pages that were used last.
class PageCache {
  public:
    PageCache();
    /// @param slots  the most pages that are kept
    PageCache(std::vector<PageLayer> layers, int slots);
    PageCache(PageCache&&) noexcept;
    PageCache& operator=(PageCache&&) noexcept;
    /// Waits for the pages that are being made.
    ~PageCache();

    /// Sees to it that all `keys` have a slot, at the cost of those not used for longest.
    /// @param keys  at most slots() of them, none twice
    /// @returns whether any page came
    /// @throws what PageLayer::make throws
    bool require(std::span<const TileKey> keys);

    /// The same beside the caller: takes the pages that have been made since the last call and has
    /// those that are missing made, in this order, on threads of its own.
    /// @throws what PageLayer::make threw
    bool request(std::span<const TileKey> keys);
    /// Whether more of them are being made than request() would take now.
    bool is_making() const;

    /// The slot of a page that is there; -1 for none.
    int slot(const TileKey& key) const;
    int slots() const;

    /// The texture of a layer; null for none of that name.
    const gl::Texture* find(std::string_view name) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
