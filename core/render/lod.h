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

/// Selects the tiles of a DEM's pyramid to draw.
///
/// After F. Strugar, Continuous Distance-Dependent Level of Detail for Rendering Heightmaps,
/// Journal of Graphics, GPU and Game Tools 14(4), 2009. A level is drawn up to its range, a
/// distance from the eye. Over the last third of the range, vertices morph onto the triangles of
/// the next coarser level, so that levels meet without cracks and change without popping. Here
/// ranges are derived from each level's measured error.
namespace relevo::render {

/// Pixels of the largest frame that vertex budgets are for. Pictures with more have as many times
/// the vertices, and are drawn in tiles.
inline constexpr double kFrame_px = 1 << 25;

/// A tile of dem::Pyramid.
struct TileKey {
    int level = 0;
    glm::ivec2 at{0, 0};  ///< column and row within the level

    std::uint64_t packed() const {
        return static_cast<std::uint64_t>(level) << 56 | static_cast<std::uint64_t>(at.y) << 28 |
               static_cast<std::uint64_t>(at.x);
    }
    friend bool operator==(const TileKey&, const TileKey&) = default;
};

/// An axis-aligned box in the local frame [m].
struct Box {
    glm::dvec3 low{0}, high{0};

    /// Distance of a point to the box; 0 inside.
    double distance(const glm::dvec3& point) const;
    /// True if the box is entirely on the negative side of one of the planes (xyz: normal, w:
    /// offset).
    bool outside(std::span<const glm::dvec4> planes) const;
};

/// A view volume and the required accuracy.
struct LodView {
    /// Half-spaces whose intersection is the view volume.
    std::vector<glm::dvec4> planes;
    /// Position of the eye; nullopt for an orthographic view, where each tile's level is
    /// independent of distance.
    std::optional<glm::dvec3> eye_m;
    /// Largest permitted displacement of a point as seen from the eye [rad], or for an orthographic
    /// view [m]. 0: all posts are drawn.
    double tolerance = 0;
    double exaggeration = 1;
    /// Ground beyond the Earth's limb is visible too, as in a map.
    bool sees_beyond_limb = false;
    /// Columns and rows of the DEM from x, y to z, w: what pages are made of. nullopt: of all that
    /// the planes leave.
    std::optional<glm::dvec4> posts{};
    /// Pictures of usual size that the picture is as large as, at least 1: it may have as many
    /// times the vertices of one.
    double frames = 1;

    /// @param pixel_error  tolerance in pixels at the frame's centre
    static LodView of_camera(const scene::Camera& camera, int width_px, int height_px,
                             double pixel_error, double exaggeration);

    /// False if a rectangle of posts is outside of `posts`.
    bool has_posts(const glm::dvec2& first, const glm::dvec2& last) const;

    /// All directions from a camera's eye, as accurate as of_camera().
    static LodView around_camera(const scene::Camera& camera, int width_px, int height_px,
                                 double pixel_error, double exaggeration);
};

/// A tile to draw.
struct TileDraw {
    TileKey key;
    std::uint8_t quadrants = 0xf;  ///< bit x + 2 y: quadrants to draw
    double distance_m = 0;         ///< from the eye to its box
};

/// Ranges of levels [m].
struct LodRanges {
    struct Range {
        double range_m = 0;
        double morph_start_m = 0;  ///< from here to range_m vertices morph to the coarser level
    };
    std::vector<Range> levels;
};

/// Spatial quadtree of a DEM's tiles.
class TileTree {
  public:
    /// All arguments must outlive this.
    TileTree(const dem::Pyramid& pyramid, const dem::Grid& grid, const geo::LocalFrame& frame);

    /// Sets the bounds of displacement, which extend boxes and ranges.
    void displace(const Displacement& displacement);
    const Displacement& displacement() const { return displacement_; }

    /// Proxy grid of a tile; u and v run from 0 to 1 over its part of the DEM. Cached until
    /// begin_frame().
    const PatchNet& net(const TileKey& key);

    /// Tiles kept without being used; 400 bytes each.
    static constexpr std::size_t kMostKept = 1 << 15;

    /// To be called before each frame. If more than kMostKept tiles are cached, those that the last
    /// frame did not use are freed: a flight over 100,000 x 100,000 posts passes millions.
    void begin_frame();
    std::size_t cached() const { return nodes_.size(); }

    /// Bounding box of a tile's posts, displaced and undisplaced.
    Box box(const TileKey& key, double exaggeration);

    /// Bounding box of a rectangle of posts, from first to last, as box(). nullopt if it has no
    /// ground.
    std::optional<Box> box(const glm::dvec2& first, const glm::dvec2& last, double exaggeration);

    /// True if a view shows nothing of a box.
    bool hidden(const Box& box, const LodView& view) const;

    /// Ranges that meet a view's tolerance and let adjacent levels morph without cracks.
    LodRanges ranges(const LodView& view);

    /// The tiles to draw, nearest first. Covers each visible post exactly once. In an orthographic
    /// view levels do not match at their edges: skirts have to reach the lowest ground.
    std::vector<TileDraw> select(const LodView& view);

    /// Which tiles have pages.
    struct Resident {
        std::function<bool(const TileKey&)> is_there;
        /// Receives the tiles that a view needs, with or without pages, and their ancestors.
        std::vector<TileKey>& needed;
    };
    /// As above for a perspective view, with coarser tiles in place of those without pages. The
    /// root must have a page.
    std::vector<TileDraw> select(const LodView& view, const Resident& resident);

    /// Visits visible tiles from `key` down to `last_level`, for pages that are selected by
    /// distance only.
    /// @param wanted  wanted(level, distance_m): true to visit a tile's children
    template <typename Wanted, typename Take>
    void visit(const LodView& view, const TileKey& key, int last_level, const Wanted& wanted,
               const Take& take) {
        if (pyramid_->bounds(key.level, key.at).empty()) return;
        const double posts = dem::Pyramid::kTileQuads << key.level;
        if (!view.has_posts(posts * glm::dvec2(key.at), posts * glm::dvec2(key.at + 1))) return;
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
        double exaggeration = -1;  ///< used for `box`; -1: not computed
        std::uint32_t frame = 0;   ///< that used it last
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
    Box box_of(const TileKey& key, const glm::dvec2& from, const glm::dvec2& to,
               double exaggeration);
    bool below_horizon(const Box& box, const LodView& view) const;

    const dem::Pyramid* pyramid_;
    const dem::Grid* grid_;
    const geo::LocalFrame* frame_;
    glm::dvec3 earth_centre_m_;
    glm::dvec3 polar_axis_;
    double longest_spacing_m_ = 0;
    Displacement displacement_;
    double lowest_m_ = 0;           // of all displaced ground
    std::vector<double> error_m_;   // error of a level
    std::vector<double> relief_m_;  // by level: largest height range of a tile, displaced
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::uint32_t frames_ = 0;  // begun
};

}  // namespace relevo::render
