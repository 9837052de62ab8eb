#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/window.h"
#include "dem/posts.h"
#include "geo/local_frame.h"
#include "light/sweep/sweep.h"
#include "sun/refraction.h"

namespace relevo::light {

/// What the air over a DEM does to light.
struct LightPath {
    /// Terrestrial refraction: a line of sight over the ground is bent by this part of the Earth's
    /// curvature, as HorizonOptions::refraction.
    double refraction = 0.13;
    /// Refraction of the sun, by the air over a place at its height; none: the sun is where it is
    /// without air.
    std::function<sun::Refraction(const geo::Geodetic&)> air;
};

/// What of a DEM is the same for all suns over it.
///
/// A DEM that goes round the Earth is repeated for half a turn on either side, so that ground
/// shades across the meridian at which its columns begin, and one with dem::Posts::rim() has that:
/// posts and windows here are those of this larger grid.
class SunTerrain {
  public:
    /// Another DEM, in which this one lies or around which it lies: both have one relief and one
    /// air.
    struct Nesting {
        const dem::Posts* around = nullptr;  ///< a wider one, whose ground and Earth shade, too
        const dem::Posts* site = nullptr;    ///< a finer one, whose ground is left to it

        const dem::Posts* other() const { return around ? around : site; }
    };
    /// @param posts       outlive this
    /// @param with_discs  parts of the sun's disc are asked for, and not its centre alone
    /// @throws Error (BadInput) for a refraction that no air has
    SunTerrain(const dem::Posts& posts, const LightPath& path, bool with_discs,
               const Nesting& nesting);
    SunTerrain(const dem::Posts& posts, const LightPath& path, bool with_discs)
        : SunTerrain(posts, path, with_discs, Nesting{}) {}

    const dem::Posts& given() const { return given_; }  ///< the DEM as it is
    const dem::Posts& posts() const { return posts_; }
    const dem::Grid& grid() const { return posts_.grid(); }
    /// Where the DEM as it is lies on the grid: inside of what is repeated, or of its rim.
    Window window() const {
        return {before_.x, before_.y, given_.grid().columns(), given_.grid().rows()};
    }
    /// That with what is repeated on either side.
    Window whole_grid() const { return {0, 0, grid().columns(), grid().rows()}; }
    /// A window of the DEM as it is; where it has no posts, all of it.
    Window window_of(const Window& given) const {
        if (given.is_empty()) return window();
        return {given.column + before_.x, given.row + before_.y, given.columns, given.rows};
    }
    /// Whether a wider DEM has the ground around this one.
    bool is_nested() const { return is_nested_; }
    const Sweep& sweep() const { return sweep_; }
    const geo::LocalFrame& frame() const { return frame_; }
    const glm::dvec2& spacing_m() const { return spacing_m_; }  ///< the grid's post_spacing_m()
    double widest_spacing_m() const { return std::max(spacing_m_.x, spacing_m_.y); }
    /// Where its corners, the middles of its sides and its own middle are.
    const std::array<geo::Geodetic, 9>& marks() const { return marks_; }
    double curvature() const { return curvature_; }  ///< of lines of sight over the ground [1/m]
    double lowest_m() const { return lowest_m_; }
    double relief_m() const { return relief_m_; }

    /// Shadows need be no lower. That is so far under the lowest post that a clearance which it
    /// bounds tells nothing of when shade will come, nor, where discs are asked for, of the part of
    /// one that any ground in sight hides.
    float floor_m() const { return floor_m_; }
    /// Ground that is farther off is under the horizon of the smooth Earth, be it and the eye on
    /// whatever height.
    double horizon_reach_m() const;
    /// A sun without air that no post sees: from the highest one the sea's horizon dips, and air
    /// lifts the sun by up to 0.7 degrees.
    double lowest_sun_rad() const;

    /// Air as posts of some height have it.
    enum Air { kOfLowest, kOfHighest, kMean };
    /// The elevation at which a sun is seen through it.
    double apparent_rad(double elevation_rad, Air air) const;
    /// Whether the lowest post sees a sun otherwise than the highest one, by so much that each
    /// needs a sweep of its own; else the mean of both serves.
    bool airs_differ(double elevation_rad) const;

  private:
    const dem::Posts& given_;
    glm::ivec2 before_{0};  // columns and rows of the grid before it
    std::unique_ptr<const dem::Heightfield> rimmed_;
    std::optional<dem::Posts> larger_;  // of a DEM round the Earth, or with a rim
    const dem::Posts& posts_;
    bool is_nested_;
    Sweep sweep_;
    glm::dvec2 spacing_m_;
    std::array<geo::Geodetic, 9> marks_;
    geo::LocalFrame frame_;
    double curvature_, lowest_m_, relief_m_;
    float floor_m_;
    std::vector<sun::Refraction> airs_;  // over the lowest post and the highest one, or none
};

/// How far off ground can shade the posts of a DEM from a sun, or stand over their horizon [m]:
/// SunField::shade_m(), SunTerrain::horizon_reach_m().
/// @param refraction  terrestrial
double shade_reach_m(const dem::Posts& posts, double refraction, double apparent_rad);
double horizon_reach_m(const dem::Posts& posts, double refraction);
/// @param curvature  of lines of sight over the ground [1/m]
double shade_reach_m(double relief_m, double curvature, double apparent_rad);

/// The posts of a grid under and around a window of another one, whose middle lies on it.
/// @throws Error (BadInput) where the window is not within the grid
Window window_over(const dem::Grid& grid, const dem::Grid& of, const Window& window);

/// The heights of a window, and of the posts beside it.
struct WindowHeights {
    std::vector<float> buffer;
    dem::Posts::View view;

    WindowHeights(const dem::Posts& posts, const Window& window);
    float at(int column, int row) const { return *view.at(column, row); }
};

}  // namespace relevo::light
