#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "dem/heightfield.h"
#include "dem/pyramid.h"
#include "dem/water.h"
#include "geo/local_frame.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "overlay/photo.h"
#include "render/fields.h"
#include "render/frame_block.h"
#include "render/ground_light.h"
#include "render/ground_rasters.h"
#include "render/height_means.h"
#include "render/loading.h"
#include "render/lod.h"
#include "render/natural_ground.h"
#include "render/page_cache.h"
#include "render/page_table.h"
#include "render/sides.h"
#include "render/tile_mesh.h"
#include "render/water_field.h"
#include "render/wet_posts.h"

namespace relevo::render {

struct TerrainOptions {
    /// Error of the drawn surface [px] as defined by TileTree: four times its RMS, which is thus 1
    /// px. 0 draws all posts.
    double pixel_error = 4;
    /// Vertices of a frame above which the error is increased.
    int vertex_budget = 250000;
    int max_array_layers = 2048;  ///< of the device
    MemoryBudget memory = MemoryBudget::of_mib(MemoryBudget::kDefault_mib);
    /// The heightfield's pyramid; must outlive the terrain. Null: built by the terrain.
    const dem::Pyramid* pyramid = nullptr;
    /// Water and filled voids at the heightfield's posts, for lib/water.glsl; must outlive the
    /// terrain.
    const dem::Water* water = nullptr;              ///< null: found when needed
    const Array2d<std::uint8_t>* filled = nullptr;  ///< nonzero at filled posts; null: none
    /// Shares of the ground for lib/land.glsl: red trees, green low plants, blue ice, alpha
    /// where they are known. Null: none.
    std::shared_ptr<const overlay::Photo> land_cover{};
    /// What stands on the heightfield's posts, for lib/houses.glsl. Null: nothing.
    std::shared_ptr<const OverlayRaster> houses{};
    bool climate_alone = false;  ///< lib/land.glsl knows nothing but that map
    SkyViewFuture sky{};         ///< sky-view factor of the heightfield, if being computed
    ShadowsOn shadows_on = ShadowsOn::Processor;  ///< what computes the sun's shadows
};

/// Which ground a frame needs its whole program for.
struct DetailedGround {
    glm::dvec3 eye_m{0};
    double exaggeration = 1;
    double near_m = 0;             ///< ground nearer to the eye
    double water_posts_per_m = 0;  ///< and around water, by the distance: so many posts
};

/// Tiles of a view with resident pages. May be drawn repeatedly.
class TileSelection {
  public:
    int triangles() const { return triangles_; }
    double tolerance() const { return tolerance_; }  ///< as LodView, after the vertex budget
    int finest_level() const;                        ///< 0: all posts; 0 without tiles
    double nearest_m() const;  ///< distance from the eye to the nearest tile; 0 without tiles

  private:
    friend class Terrain;
    struct Tile {
        TileDraw draw;
        float height_layer = 0;
        float morph_start_m = 0, per_morph_m = 0;
    };
    std::vector<Tile> tiles_;
    int triangles_ = 0;
    double tolerance_ = 0;
};

/// A heightfield on the device. Draws one 65 x 65 grid of vertices for each tile of a view,
/// displaced by height pages. Pages are made when first needed.
class Terrain {
  public:
    /// @param heightfield  must outlive this
    /// @param finer        source of a heightfield of means; its posts are drawn near the eye. Else
    ///     null
    /// @param frame        the DEM's local frame, for all positions; must outlive this
    Terrain(const dem::Heightfield& heightfield, const geo::LocalFrame& frame,
            const TerrainOptions& options, const dem::Source* finer = nullptr);

    const dem::Pyramid& pyramid() const { return pyramid_; }
    const dem::Grid& grid() const { return grid_; }  ///< of the pyramid's posts

    /// Sets the bounds of displacement. Other bounds change serial().
    void displace(const Displacement& displacement);

    /// Selects the tiles of a view and makes their height pages.
    /// @param keep  another selection whose pages must stay resident
    TileSelection select(const LodView& view, const TileSelection* keep = nullptr);
    /// Selects the tiles of a frame with the option's pixel error, and makes its pages.
    /// @param picture_px  size of the picture that the frame belongs to [px]
    /// @param frame_px    size of the frame [px]
    TileSelection select_for_frame(const FrameInputs& inputs, const glm::ivec2& picture_px,
                                   const glm::ivec2& frame_px);
    /// True if some of a selection's triangles may be in the view that it was made for. An
    /// orthographic view has ground in sight if it has tiles.
    bool sees_ground(const TileSelection& selection, const LodView& view);
    /// Selects tiles on the vertical through a camera's eye at the camera's levels, for
    /// GroundProbe.
    TileSelection select_below(const FrameInputs& inputs, const glm::ivec2& picture_px);
    /// True if the last frame had all its pages, as always with Loading::Wait.
    bool is_complete() const { return complete_; }
    /// True if pages are being made in the background.
    bool is_making_pages() const {
        return heights_.is_making() || surface_.is_making() || overlay_.is_making() ||
               rasters_.is_making();
    }

    /// Draws with the bound program, framebuffer and textures. The program gets positions relative
    /// to `origin_m`. A selection is valid until the next one is made, unless that keeps it.
    void draw(const TileSelection& selection, const glm::dvec3& origin_m);

    /// The tiles of a selection with the inputs of lib/tile.glsl.
    std::vector<TileMesh::Tile> tiles_of(const TileSelection& selection,
                                         const glm::dvec3& origin_m);
    /// TileTree::box() and hidden().
    std::optional<Box> box(const glm::dvec2& first, const glm::dvec2& last, double exaggeration) {
        return tree_.box(first, last, exaggeration);
    }
    bool hidden(const Box& box, const LodView& view) const { return tree_.hidden(box, view); }
    /// Boxes that have all detailed ground of a selection: of windows of its tiles.
    std::vector<Box> boxes(const TileSelection& selection, const DetailedGround& detailed);

    /// As draw(), of the walls below the edges of the ground.
    void draw_sides(const TileSelection& selection, const glm::dvec3& origin_m);

    /// Extent of the ground along three axes [m]: of a selection's tiles within a distance of its
    /// eye, or of the whole DEM without a selection. Slightly too large, as it is made of boxes.
    /// nullopt without tiles.
    struct Extent {
        glm::dvec3 low, high;
    };
    std::optional<Extent> extent(const glm::dmat3& axes, double exaggeration,
                                 const TileSelection* selection = nullptr,
                                 double nearer_than_m = 0);

    /// Adds a layer to the normal pages, for programs that read "surface_pages" or "water_pages".
    /// The first call of each discards all pages. These layers are never removed, so that switching
    /// an effect off and on does not remake the pages.
    void require_surface_pages();
    void require_water_pages();
    void
    require_house_pages();  ///< of TerrainOptions::houses; without them nothing stands anywhere

    /// Sets the overlay for programs that read it; null: none. Another one discards its pages.
    void set_overlay(std::shared_ptr<const OverlayRaster> raster);
    /// Sets the rasters of effects, by the resources of their textures: "drape.photo". Those that
    /// were set before keep their pages.
    void set_rasters(NamedRasters rasters);
    const GroundRasters& rasters() const { return rasters_; }
    /// Sets the fields of effects, by the resources of their textures.
    void set_fields(NamedFields fields) { fields_.set(std::move(fields)); }
    const Fields& fields() const { return fields_; }

    /// Climate and land cover.
    NaturalGround& natural() { return natural_; }
    HeightMeans& height_means() { return height_means_; }

    /// Sun and sky light after occlusion by terrain.
    GroundLight& light() { return light_; }
    const GroundLight& light() const { return light_; }

    /// Textures by their samplers' names: of a PageLayer, of GroundLight, or "page_table", the slot
    /// and level of the finest resident tile page. Null for other names.
    const gl::Texture* texture(std::string_view name) const;
    /// Unique in the process; changes with displacement.
    std::uint64_t serial() const { return serial_; }
    bool has_voids() const { return pyramid_.has_voids(); }
    /// True if triangles are counter-clockwise as seen from above. False on grids with reversed
    /// rows.
    bool winds_counterclockwise();
    double normal_spacing_m() const { return normal_spacing_m_; }  ///< of the finest normal pages
    /// Writes the members of the posts, of the page layers and of the overlay.
    void write(GroundBlock& block) const;

  private:
    TileSelection select_in_background(const LodView& view);
    /// A selection of tiles with resident pages.
    TileSelection ready(const LodView& view, const std::vector<TileDraw>& draws);
    /// Largest error of drawn ground [px]: the option's, up to twice that for exaggerated heights,
    /// whose slopes would take twice as many triangles that nobody sees.
    double pixel_error(double exaggeration) const;
    /// What a frame draws, with that pixel error.
    LodView view_of(const FrameInputs& inputs, const glm::ivec2& picture_px) const;
    bool is_detailed(const Box& box, const glm::ivec2& first, const glm::ivec2& last,
                     const DetailedGround& detailed);
    /// Whether that is few enough vertices, or as coarse as it may be to save them.
    bool in_budget(const LodView& wanted, double tolerance,
                   const std::vector<TileDraw>& draws) const;
    /// The view's tolerance, or the smallest larger one that is in_budget().
    double tolerance_in_budget(const LodView& wanted);
    int raster_slots() const;  ///< pages of a raster at most
    void prepare_surface(const LodView& view, Loading loading, bool deterministic);
    /// Creates surface_, without pages, if a layer was added or changed since.
    void update_surface_layers();
    std::vector<std::byte> make_normals(const TileKey& key) const;
    std::vector<std::byte> make_water(const TileKey& key) const;
    TileMesh::Instance instance_of(const TileSelection::Tile& tile, const glm::dvec3& origin_m);

    std::uint64_t serial_;
    TerrainOptions options_;
    std::optional<dem::Pyramid> own_pyramid_;  // unless one was given
    const dem::Pyramid& pyramid_;
    const dem::Grid& grid_;
    const geo::LocalFrame& frame_;
    TileTree tree_;
    glm::dvec3 polar_axis_;
    NaturalGround natural_;
    GroundLight light_;
    HeightMeans height_means_;
    double normal_spacing_m_ = 0;
    int normal_levels_ = 1;
    int normal_layers_ = 1;
    std::int64_t surface_bytes_ = 0;  // of a page in all its layers
    std::int64_t view_bytes_ = 0;     // of the heights and triangles that select() has selected

    bool has_surface_pages_ = false, has_water_pages_ = false;
    const Array2d<float>* drawn_m_;  // all posts in memory
    const dem::Grid* drawn_grid_;
    int reduction_;
    std::optional<dem::Water> own_water_;  // unless one was given
    std::optional<WaterField> water_;
    std::optional<WetPosts> wet_posts_;  // made when first asked for
    gl::Texture dry_;   // for programs that read "water_pages" where there is nothing to tell
    gl::Texture bare_;  // as that, "house_pages"
    bool table_is_narrowed_ = false;  ///< lists only the pages of a deterministic frame
    bool complete_ = true;
    PageTable page_table_;
    TileMesh mesh_;
    Sides sides_;
    // Last members: their threads read the members above.
    PageCache heights_;  // by tile
    PageCache surface_;  // normals and other data by place
    GroundRasters overlay_, rasters_;
    Fields fields_;
};

}  // namespace relevo::render
