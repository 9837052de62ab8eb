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
#include "render/climate_volume.h"
#include "render/drape.h"
#include "render/ground_light.h"
#include "render/loading.h"
#include "render/lod.h"
#include "render/page_cache.h"
#include "render/sides.h"
#include "render/tile_mesh.h"
#include "render/water_field.h"

namespace relevo::render {

struct TerrainOptions {
    /// Error of the drawn surface in the picture [px], as TileTree counts it: four times the root
    /// mean square, which is so one pixel. 0 draws every post.
    double pixel_error = 4;
    /// Vertices in a frame above which the error is let grow.
    int vertex_budget = 250000;
    int max_array_layers = 2048;  ///< the device's
    /// Of the heightfield, made already; must outlive the terrain. Null: it makes its own.
    const dem::Pyramid* pyramid = nullptr;
    /// Of the heightfield's posts, for lib/water.glsl; both must outlive the terrain.
    const dem::Water* water = nullptr;              ///< null: it is looked for when needed
    const Array2d<std::uint8_t>* filled = nullptr;  ///< not 0 on posts that were holes
    SkyAhead sky{};                                 ///< of the heightfield, where it is on its way
    ShadowsOn shadows_on = ShadowsOn::Auto;         ///< where the sun's shadows are computed
};

/// The tiles of a view with their pages on the device, ready to draw any number of times.
class TileSelection {
  public:
    int triangles() const { return triangles_; }
    double tolerance() const { return tolerance_; }  ///< as LodView's, after the vertex budget
    int finest_level() const;                        ///< 0: every post; 0 for none
    double nearest_m() const;  ///< from the eye to the nearest tile; 0 for none

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

/// A heightfield on the device: one 65 x 65 grid of vertices, drawn once for every tile that a view
/// needs and displaced there by the elevation pages, which are made when first seen.
class Terrain {
  public:
    /// @param heightfield  must outlive this
    /// @param finer        where a heightfield of means was made from: its posts are drawn where
    /// they
    ///                     are near enough to be seen; null if there is none
    /// @param frame        the DEM's local frame; every position below is in it; must outlive this
    Terrain(const dem::Heightfield& heightfield, const geo::LocalFrame& frame,
            const TerrainOptions& options, const dem::Source* finer = nullptr);

    const dem::Pyramid& pyramid() const { return pyramid_; }
    const dem::Grid& grid() const { return grid_; }  ///< of the pyramid's posts

    /// How far effects move the ground from now on. Another bound makes it another ground, with a
    /// new serial().
    void displace(const Displacement& displacement);

    /// Chooses the tiles of a view and makes their height pages.
    /// @param keep  a selection that has to stay drawable beside the new one
    TileSelection select(const LodView& view, const TileSelection* keep = nullptr);
    /// A camera's view with the option's pixel error, and the pages that its picture needs.
    /// @param afresh  finer pages that are left from other pictures are not read
    TileSelection select_for_picture(const scene::Camera& camera, int width_px, int height_px,
                                     double exaggeration, Loading loading = Loading::Wait,
                                     bool afresh = false);
    /// The tiles on the vertical through a camera's eye, at the levels that its picture draws them
    /// at, with their pages: for GroundProbe.
    TileSelection select_below(const scene::Camera& camera, int width_px, int height_px,
                               double exaggeration, bool afresh);
    /// Whether the last picture had all its pages; so it is always where it waits for them.
    bool is_complete() const { return complete_; }
    /// Whether pages are still being made beside for it.
    bool is_making_pages() const { return heights_.is_making() || surface_.is_making(); }

    /// Draws with the program and framebuffer that are bound, and its textures. Positions are
    /// handed to the program relative to `origin_m`. A selection holds until the next one is made,
    /// save where that keeps it.
    void draw(const TileSelection& selection, const glm::dvec3& origin_m);

    /// Draws the walls below the edges of a selection's ground, likewise.
    void draw_sides(const TileSelection& selection, const glm::dvec3& origin_m);

    /// Least and greatest product of the ground's points with each of three axes [m]: of the tiles
    /// of a selection that come nearer to its eye than a distance, or of the whole DEM without a
    /// selection. Boxes around tiles: a little more than the ground. Empty where no tile is.
    struct Extent {
        glm::dvec3 low, high;
    };
    std::optional<Extent> extent(const glm::dmat3& axes, double exaggeration,
                                 const TileSelection* selection = nullptr,
                                 double nearer_than_m = 0);

    /// From now on pictures have surface pages beside the normal pages: for programs that read
    /// them.
    void keep_surface();

    /// Likewise water pages.
    void keep_water();

    /// From now on the ground of pictures has these colours, for programs that read them; null:
    /// none.
    void drape(std::shared_ptr<const Drape> drape);

    /// From now on the ground has its climate's tables, with the snow of a day (0 to 364).
    /// @returns them, for FrameBlock
    /// @throws Error (BadInput) where the map of the climate is missing or damaged
    const ClimateVolume& keep_climate(int day);
    /// What they are made from; opened when first asked for. @throws Error likewise
    const climate::ClimateMap& climate_map();

    /// What comes to the ground past the ground around it.
    GroundLight& light() { return light_; }
    const GroundLight& light() const { return light_; }

    /// What shaders read of the ground, by the sampler's name: a PageLayer's, one of GroundLight's,
    /// or "page_table", the slot and level of the finest page of the picture there is. Null for
    /// others.
    const gl::Texture* texture(std::string_view name) const;
    /// No two terrains of a process have the same.
    std::uint64_t serial() const { return serial_; }
    bool has_holes() const { return pyramid_.has_holes(); }
    /// Whether the triangles go round counter-clockwise as seen from above: not so on grids whose
    /// rows run the other way.
    bool winds_counterclockwise();
    int normal_levels() const { return normal_levels_; }           ///< of normal pages
    double normal_spacing_m() const { return normal_spacing_m_; }  ///< of the finest of them

  private:
    TileSelection select_beside(const LodView& view);
    /// Of tiles whose pages are there.
    TileSelection ready(const LodView& view, const std::vector<TileDraw>& draws);
    bool in_budget(const LodView& wanted, const std::vector<TileDraw>& draws) const;
    /// The view's tolerance, or the least coarser one that keeps its tiles in the vertex budget.
    double tolerance_in_budget(const LodView& wanted);
    void prepare_surface(const LodView& view, Loading loading, bool afresh);
    void clear_surface();
    /// @param only  pages that are read; null: all that are there
    void write_page_table(const std::vector<TileKey>* only);
    std::vector<std::byte> make_normals(const TileKey& key) const;
    TileMesh::Instance instance_of(const TileSelection::Tile& tile, const glm::dvec3& origin_m);
    std::vector<TileMesh::Tile> tiles_of(const TileSelection& selection,
                                         const glm::dvec3& origin_m);

    std::uint64_t serial_;
    TerrainOptions options_;
    std::optional<dem::Pyramid> own_pyramid_;  // where none was given
    const dem::Pyramid& pyramid_;
    const dem::Grid& grid_;
    const geo::LocalFrame& frame_;
    TileTree tree_;
    glm::dvec3 polar_axis_;
    GroundLight light_;
    double normal_spacing_m_ = 0;
    int normal_levels_ = 1;
    int normal_layers_ = 1;

    std::shared_ptr<const Drape> drape_;
    std::optional<climate::ClimateMap> climate_map_;
    std::optional<ClimateVolume> climate_;
    bool keeps_surface_ = false, keeps_water_ = false;
    const Array2d<float>* drawn_m_;  // as many posts as are in memory
    const dem::Grid* drawn_grid_;
    int reduction_;
    std::optional<dem::Water> own_water_;  // where none was given
    std::optional<WaterField> water_;
    bool table_is_narrowed_ = false;  ///< to the pages of a picture that was drawn afresh
    bool complete_ = true;
    gl::Texture page_table_;
    TileMesh mesh_;
    Sides sides_;
    // Last: threads make their pages from what stands above.
    PageCache heights_;  // of tiles
    PageCache surface_;  // of the picture: normals, and what else it reads by place
};

}  // namespace relevo::render
