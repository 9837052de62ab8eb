#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <glm/vec4.hpp>

#include "gl/texture.h"
#include "render/overlay_pages.h"

namespace relevo::render {

/// Rasters by the resources of their textures: "overlay", "drape.photo". Null: nothing is to be
/// drawn.
using NamedRasters = std::map<std::string, std::shared_ptr<const OverlayRaster>>;

/// Where a raster's texels lie, for raster_texels() of lib/raster.glsl.
struct RasterPlace {
    glm::vec4 place{0};  ///< post of its first texel, and texels per post
    glm::vec4 shape{0};  ///< its last texel, number of levels, 1 if it is lit; all 0: no raster
};

/// Rasters on the ground of a DEM, each a virtual texture.
class GroundRasters {
  public:
    /// Replaces the rasters. Those that were there before keep their pages.
    /// @param pyramid    must outlive this
    /// @param spacing_m  from post to post
    /// @param slots      pages of each at most
    void set(NamedRasters rasters, const dem::Pyramid& pyramid, double spacing_m, int slots);

    /// Makes the pages of a view, as OverlayPages::prepare(). @returns true if all are resident
    bool prepare(TileTree& tree, const LodView& view, Loading loading, bool deterministic);
    bool is_making() const;  ///< true if pages are being made in the background

    /// "drape.photo_pages", "drape.photo_table"; null for other names.
    const gl::Texture* texture(std::string_view name) const;
    RasterPlace place(const std::string& name) const;
    const NamedRasters& all() const { return rasters_; }

  private:
    NamedRasters rasters_;
    std::map<std::string, std::unique_ptr<OverlayPages>> pages_;  // without null ones
    gl::Texture no_pages_, no_table_;                             // of null ones
};

}  // namespace relevo::render
