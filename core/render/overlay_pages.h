#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gl/texture.h"
#include "render/loading.h"
#include "render/lod.h"
#include "render/overlay_raster.h"
#include "render/page_cache.h"
#include "render/page_table.h"

namespace relevo::render {

/// A raster on the device: a virtual texture of its own resolution, whose tile pages are made where
/// a view needs them. lib/raster.glsl reads it.
class OverlayPages {
  public:
    /// @param pyramid    must outlive this
    /// @param spacing_m  from post to post
    /// @param slots      pages at most
    /// @param name       "overlay": of the textures "overlay_pages" and "overlay_table"
    OverlayPages(std::shared_ptr<const OverlayRaster> raster, const dem::Pyramid& pyramid,
                 double spacing_m, int slots, std::string name);

    /// Makes the pages of a view.
    /// @param tree           of the pyramid
    /// @param view           with a tolerance of one pixel
    /// @param deterministic  do not read finer pages that earlier frames left
    /// @returns true if all are resident
    bool prepare(TileTree& tree, const LodView& view, Loading loading, bool deterministic);
    /// True if pages are being made in the background.
    bool is_making() const { return cache_.is_making(); }

    /// Its two textures; null for other names.
    const gl::Texture* texture(std::string_view name) const;
    const OverlayRaster& raster() const { return *overlay_; }
    const OverlayTexels& texels() const { return texels_; }

  private:
    void visit(TileTree& tree, const LodView& view, double angle, const TileKey& key,
               std::vector<TileKey>& pages) const;

    std::string name_;
    std::shared_ptr<const OverlayRaster> overlay_;
    const dem::Pyramid& pyramid_;
    OverlayTexels texels_;
    double texel_m_;  ///< distance of texels on the finest level
    PageTable table_;
    bool table_is_narrowed_ = false;  ///< lists only the pages of a deterministic frame
    PageCache cache_;                 // last: its threads read the members above
};

}  // namespace relevo::render
