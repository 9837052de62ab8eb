#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "dem/grid.h"
#include "dem/pyramid.h"
#include "geo/local_frame.h"
#include "render/displacement.h"
#include "render/patch_net.h"
#include "scene/camera.h"

/// Which tiles of a DEM's pyramid a view is drawn from.
///
/// After F. Strugar, Continuous Distance-Dependent Level of Detail for Rendering Heightmaps,
/// Journal of Graphics, GPU and Game Tools 14(4), 2009: each level has a range, the distance from
/// the eye up to which it is drawn; over the last third of it the vertices glide onto the triangles
/// of the next coarser level, so that levels meet without cracks and change without a jump. Here
/// the ranges follow from what each level is known to be wrong by.
namespace relevo::render {

/// A tile of dem::Pyramid.
struct TileKey {
    int level = 0;
    glm::ivec2 at{0, 0};  ///< column and row of the tile in its level

    std::uint64_t packed() const {
        return static_cast<std::uint64_t>(level) << 56 | static_cast<std::uint64_t>(at.y) << 28 |
               static_cast<std::uint64_t>(at.x);
    }
    friend bool operator==(const TileKey&, const TileKey&) = default;
};

/// A box along the axes of the local frame [m].
struct Box {
    glm::dvec3 low{0}, high{0};

    /// From a point to the nearest of the box; 0 inside.
    double distance(const glm::dvec3& point) const;
    /// Whether it lies wholly on the negative side of one of the planes (xyz normal, w offset).
    bool outside(std::span<const glm::dvec4> planes) const;
};

/// What is seen, and how well it has to be drawn.
struct LodView {
    /// Half-spaces whose intersection holds all that can be seen.
    std::vector<glm::dvec4> planes;
    /// From where; none for an orthographic view, which sees each tile as coarse as it alone may
    /// be.
    std::optional<glm::dvec3> eye_m;
    /// Largest angle [rad] by which a point of the picture may be displaced, or with no eye the
    /// largest distance [m]. 0: every post is drawn.
    double tolerance = 0;
    double exaggeration = 1;

    /// @param pixel_error  tolerance in pixels at the picture's middle
    static LodView of_camera(const scene::Camera& camera, int width_px, int height_px,
                             double pixel_error, double exaggeration);
};

/// A tile to draw.
struct TileDraw {
    TileKey key;
    std::uint8_t quadrants = 0xf;  ///< bit x + 2 y: the part of it that is drawn
    double distance_m = 0;         ///< of its box from the eye
};

/// Up to where each level is drawn [m].
struct LodRanges {
    struct Range {
        double range_m = 0;
        double morph_start_m = 0;  ///< from here to range_m vertices glide to the coarser level
    };
    std::vector<Range> levels;
};

/// The tiles of a DEM as a quadtree in space.
class TileTree {
  public:
    /// All must outlive this.
    TileTree(const dem::Pyramid& pyramid, const dem::Grid& grid, const geo::LocalFrame& frame);

    /// How far effects move the ground from now on: boxes and ranges hold where it ends up too.
    void displace(const Displacement& displacement);
    const Displacement& displacement() const { return displacement_; }

    /// Where the tile's part of the DEM lies; u and v run over that part. Kept once asked for.
    const PatchNet& net(const TileKey& key);

    /// Holds all of a tile's posts, where they are and where effects move them.
    Box box(const TileKey& key, double exaggeration);

    /// Ranges that keep the tolerance of a view from an eye, and are far enough apart for levels to
    /// meet.
    LodRanges ranges(const LodView& view);

    /// The tiles to draw, nearest first. Every visible post is covered exactly once. In an
    /// orthographic view levels do not meet: skirts have to hang down to the lowest ground.
    std::vector<TileDraw> select(const LodView& view);

    /// Which tiles can be drawn.
    struct Resident {
        std::function<bool(const TileKey&)> is_there;
        /// Filled with those that a view asks for, there or not, and those that stand above them.
        std::vector<TileKey>& needed;
    };
    /// The same from an eye, with a coarser tile in the place of those that are not there. The root
    /// has to be.
    std::vector<TileDraw> select(const LodView& view, const Resident& resident);

    /// Tiles that can be seen at no more than `nearest` levels from the top; for pages that are
    /// chosen by distance alone.
    /// @param wanted  whether a tile at this distance is to be divided further
    template <typename Wanted, typename Take>
    void visit(const LodView& view, const TileKey& key, int last_level, const Wanted& wanted,
               const Take& take) {
        if (pyramid_->bounds(key.level, key.at).empty()) return;
        const Box b = box(key, view.exaggeration);
        if (hidden(b, view)) return;
        take(key);
        if (key.level <= last_level || !wanted(key.level, view.eye_m ? b.distance(*view.eye_m) : 0))
            return;
        for_children(
            key, [&](const TileKey& child, int) { visit(view, child, last_level, wanted, take); });
    }

    TileKey root() const { return {pyramid_->levels() - 1, {0, 0}}; }

  private:
    struct Node {
        PatchNet net;
        Box box;
        double exaggeration = -1;  ///< that the box was made with
    };

    template <typename Visit>
    void for_children(const TileKey& key, const Visit& visit) const {
        const glm::ivec2 count = pyramid_->tiles(key.level - 1);
        for (int q = 0; q < 4; ++q) {
            const glm::ivec2 at = 2 * key.at + glm::ivec2(q & 1, q >> 1);
            if (at.x < count.x && at.y < count.y) visit(TileKey{key.level - 1, at}, q);
        }
    }

    Node& node(const TileKey& key);
    double net_error_m(int level) const;
    void measure_relief();
    std::vector<TileDraw> select_orthographic(const LodView& view);
    std::vector<TileDraw> select_from_eye(const LodView& view, const Resident* resident);
    bool hidden(const Box& box, const LodView& view) const;
    bool below_horizon(const Box& box, const LodView& view) const;

    const dem::Pyramid* pyramid_;
    const dem::Grid* grid_;
    const geo::LocalFrame* frame_;
    glm::dvec3 earth_centre_m_;
    glm::dvec3 polar_axis_;
    double longest_spacing_m_ = 0;
    Displacement displacement_;
    double lowest_m_ = 0;           // of the whole ground, displaced
    std::vector<double> error_m_;   // by level
    std::vector<double> relief_m_;  // largest of a tile, displaced, by level
    std::unordered_map<std::uint64_t, Node> nodes_;
};

}  // namespace relevo::render
