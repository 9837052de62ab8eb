#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/units.h"
#include "light/raster/sun_terrain.h"
#include "light/sweep/sweep.h"
#include "sun/position.h"

namespace relevo::light {

/// Where the sun stands over a place, such as the middle of a DEM.
struct SunOverDem {
    double azimuth_rad = 0;  ///< of its centre, clockwise from true north
    /// Of its centre: without air where LightPath::air says what the air does, else as seen.
    double elevation_rad = 0;
    double semidiameter_rad = 0;  ///< half the disc's width

    static SunOverDem of(const sun::Position& position) {
        return {position.azimuth_rad, position.elevation_rad, position.semidiameter_rad};
    }
};

/// Posts over which the sun is one: its rays have one shape, and the elevation at which it is seen
/// is linear over them.
struct SunTile {
    TilePosts posts;
    Ray ray;
    /// Posts all over it, and the sun's elevation there without air [rad]: what it is fitted to.
    struct Mark {
        glm::dvec2 post{0};
        double elevation_rad = 0;
    };
    std::array<Mark, 9> marks;
    bool is_night = false;  ///< no post of it sees the sun; there is no ray
};

/// How far a straight way from a post stays in a window [m].
/// @param a_metre  of the way, in posts
double way_in(const Window& window, const glm::dvec2& post, const glm::dvec2& a_metre);

/// A sun over the grid of a DEM. It is one direction in space; over a round Earth it stands
/// otherwise at every place.
class SunField {
  public:
    /// A sun that stands so over a place. @param terrain  outlives this
    SunField(const SunTerrain& terrain, const geo::Geodetic& place, const SunOverDem& sun);
    /// A direction that is the same at every place, from true north there, and level.
    SunField(const SunTerrain& terrain, double azimuth_rad);
    /// A direction as of a sun that is level over a place.
    static SunField level(const SunTerrain& terrain, const geo::Geodetic& place,
                          double azimuth_rad);

    /// The same sun or direction over another DEM. @param terrain  outlives what is returned
    SunField over(const SunTerrain& terrain) const;

    const SunTerrain& terrain() const { return *terrain_; }
    /// Whether it needs sweeps for the air of the lowest post and for that of the highest one.
    bool has_two_airs() const { return two_airs_; }
    SunTerrain::Air first_air() const {
        return two_airs_ ? SunTerrain::kOfLowest : SunTerrain::kMean;
    }
    /// The sun is under the horizon of every post, or of every post of a window.
    bool is_night() const { return is_night(terrain_->window()); }
    bool is_night(const Window& window) const;

    /// Without air, at a place.
    SunOverDem at(const geo::Geodetic& place) const;
    SunOverDem at(const glm::dvec2& post) const {
        return at(terrain_->grid().place(post.x, post.y));
    }
    /// Towards it, a unit vector of SunTerrain::frame(); not of a direction from true north.
    const glm::dvec3& direction() const { return direction_; }

    /// As far as ground can shade: where a ray has risen over all relief of a round Earth.
    double shade_m(double apparent_rad) const;
    /// So far, and some posts at least.
    double reach_m(double apparent_rad) const;

    /// The posts of a window between two rays as one tile, whose window is no larger than they
    /// need: empty where there are none. No tile where rays turn back or cross, or where the grid's
    /// CRS does not express them.
    /// @param along_columns  how sweeps are to go
    std::optional<SunTile> tile(const TilePosts& posts, bool along_columns) const;
    /// The ray through a post: towards the sun for as far as ground shades posts of a window, and
    /// to the window's end away from the sun.
    std::optional<Ray> ray(const glm::dvec2& post, const Window& window, bool along_columns) const;
    /// A tile's sun, or its disc's part that is so much higher than the centre.
    SweepSun sun(const SunTile& tile, SunTerrain::Air air, double offset_rad) const;
    /// How far off a tile's sun is anywhere on it [rad].
    double error_rad(const SunTile& tile) const;
    /// Towards the sun from a post, posts for each metre; NaN where the CRS does not express that.
    glm::dvec2 step(const glm::dvec2& post) const;

  private:
    double curvature_along_ray(double tangent) const;
    double path_error_rad(const SunTile& tile, const SunTile::Mark& mark) const;

    const SunTerrain* terrain_;
    glm::dvec3 direction_{0};
    std::optional<double> azimuth_rad_;  // instead
    bool two_airs_ = false;
    bool is_level_ = false;  // a direction, no sun: it is never night
};

}  // namespace relevo::light
