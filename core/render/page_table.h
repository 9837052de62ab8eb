#pragma once

#include <vector>

#include "gl/texture.h"
#include "render/page_cache.h"

namespace relevo::render {

/// The page table of a virtual texture: for each tile page of each level, slot and level of the
/// finest resident page that covers it. lib/pages.glsl reads it.
class PageTable {
  public:
    PageTable() = default;
    /// @param across  pages along the longer side of the finest level
    PageTable(int across, const char* label);

    /// @param only  pages to list; null: all resident ones
    void write(const PageCache& cache, const std::vector<TileKey>* only);

    const gl::Texture& texture() const { return texture_; }

  private:
    gl::Texture texture_;
};

}  // namespace relevo::render
