#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "dem/heightfield.h"
#include "dem/posts.h"
#include "geo/geodetic.h"
#include "light/point/apparent_elevation.h"
#include "light/point/line_of_sight.h"

namespace relevo::light {

struct HorizonOptions {
    /// 0 to 10 000 m above the ground, which the sun's light is computed for.
    double eye_height_m = 0;
    bool eye_above_ground = true;  ///< else above the zero of the DEM's heights
    /// Terrestrial refraction: the curvature of a line of sight in units of the Earth's. 0.13 is
    /// C. F. Gauss's mean, 0.25 and more is common over cold or wet ground.
    double refraction = 0.13;
    /// For comparison with programs that compute on the map: straight lines in a projected CRS,
    /// its metres as metres of the ground, over a sphere of this radius. True north is where it is
    /// at the viewpoint. None: geodesics over the WGS 84 ellipsoid and its curvature.
    std::optional<double> map_radius_m;
    /// Few directions will be asked for: each line of sight is followed by itself, as exactly as
    /// those that are prepared for all directions together. A viewpoint with one direction takes a
    /// thirtieth of the time, 34 us (tests/light/bench_light.cpp, horizon_of_one_direction).
    bool few_directions = false;
};

/// Of the Earth: Mount Everest [m].
inline constexpr double kHighestTerrain_m = 8850;

/// The horizon in one direction.
struct HorizonPoint {
    double azimuth_rad = 0;    ///< clockwise from true north [0, 2 pi)
    double elevation_rad = 0;  ///< apparent: terrestrial refraction included
    /// To the blocking point, over the ellipsoid; NaN where the DEM blocks nothing and the horizon
    /// is that of the smooth Earth beyond it.
    double distance_m = 0;
    glm::dvec2 post{0};   ///< column and row of the blocking point; NaN without
    double height_m = 0;  ///< of the blocking point; NaN without
    /// How far the DEM was followed this way: to its edge, to a void that reaches it, or to where
    /// nothing in it could be seen. Ground beyond such a void is in the horizon all the same.
    double reach_m = 0;
    /// A void within the DEM lies where terrain as high as its highest post would stand over this
    /// horizon.
    bool hole = false;
    /// How high such terrain would stand in the nearest void; -pi/2 without one.
    double hole_rad = -1.5707963267948966;
};

/// Another point as seen from a viewpoint.
struct Sight {
    double azimuth_rad = 0;
    double elevation_rad = 0;  ///< apparent
    double distance_m = 0;
    bool visible = false;      ///< no ground of the DEM stands before it
    double hidden_by_rad = 0;  ///< elevation of that ground over the point; 0 where visible
    /// It is seen through a void of the DEM, where terrain as high as its highest post would hide
    /// it.
    bool hole = false;
};

class Fan;

/// What of the sky the terrain hides from one point. Where the posts end that of their
/// Posts::surroundings() goes on, but not on a map.
///
/// The horizon in a direction is the highest of all crossings of the line of sight with the rows
/// and columns of the grid, where heights are linear from post to post: every post in the way
/// counts, and none is read twice. Blocks of posts that cannot stand over what was found so
/// far are skipped; of a DEM that memory does not hold, the others are read as they come. Voids are
/// passed over and reported. A value that refers to the posts it was made from; safe on several
/// threads at once.
///
/// Accuracy: 0.0001 degrees against crossings computed independently, 720 directions at 60 points
/// of 30 m SRTM (tests/light/test_horizon.cpp); the heights themselves are another matter. Speed:
/// about 10 us a direction (tests/light/bench_light.cpp).
class TerrainHorizon {
  public:
    /// @param posts  outlives this
    /// @param place  its height plays no part
    /// @throws Error (BadInput) where the point is outside of the DEM or in a void of it, where
    ///     the ground is at a height that has no air, where the eye is under the ground or more
    ///     than 10 km above it, for a refraction that no air has, for a map without metres; here
    ///     and later where the file is damaged that posts are read from
    TerrainHorizon(const dem::Posts& posts, const geo::Geodetic& place,
                   const HorizonOptions& options = {});
    /// The same over heights in memory.
    /// @param field  all posts, not means of them; outlives this
    TerrainHorizon(const dem::Heightfield& field, const geo::Geodetic& place,
                   const HorizonOptions& options = {});
    TerrainHorizon(const TerrainHorizon&) = delete;
    TerrainHorizon& operator=(const TerrainHorizon&) = delete;
    ~TerrainHorizon();

    /// The place of the ground at the viewpoint, where the sun is to be computed for.
    const geo::Geodetic& place() const { return place_; }
    double eye_m() const { return eye_m_; }           ///< height of the eye, above the DEM's zero
    glm::dvec2 post() const { return given(post_); }  ///< column and row of the viewpoint
    const HorizonOptions& options() const { return options_; }
    const dem::Posts& posts() const { return given_; }

    HorizonPoint at(double azimuth_rad) const;

    /// Elevation alone.
    double elevation_rad(double azimuth_rad) const { return at(azimuth_rad).elevation_rad; }

    /// The highest ground of the DEM no farther away than `distance_m`, to draw ridges before
    /// ridges; -pi/2 where none is that near.
    double elevation_within_rad(double azimuth_rad, double distance_m) const;

    /// `count` directions from north on, clockwise; on several threads.
    std::vector<HorizonPoint> profile(int count) const;

    /// Where the blocking point is, with its height; latitude NaN where there is none.
    geo::Geodetic place_of(const HorizonPoint& point) const;

    /// How far the DEM goes towards a point of the horizon, also where the line of sight was not
    /// followed to the edge; kFarthestSeen_m at most.
    double edge_m(const HorizonPoint& point) const;
    static constexpr double kFarthestSeen_m = 1e6;  ///< nothing on Earth is seen from farther

    /// Apparent elevations in a direction.
    ApparentElevation towards(double azimuth_rad) const;

    /// Another point, by its height above the DEM's zero. The DEM within one and a half posts of
    /// it does not hide it.
    /// @throws Error (BadInput) for a height that is not within -12 to 20 km, a point farther away
    ///     than kFarthestSeen_m
    Sight sight(const geo::Geodetic& target) const;

    /// Azimuth from the map's north of the direction that is true north here, to turn map azimuths
    /// into true ones.
    double true_north_on_map_rad() const { return true_north_on_map_rad_; }

    /// "terrain horizon: ..., eye 2 m above the ground", to be printed with results.
    std::string description() const;

  private:
    HighestCrossing look(double azimuth_rad, double until_m, std::vector<TracePoint>& line) const;
    double ground_beyond_rad(double azimuth_rad, const HighestCrossing& highest,
                             const std::vector<TracePoint>& line) const;
    double hole_rad(double azimuth_rad, const HighestCrossing& highest) const;
    void check_eye() const;

    TerrainHorizon(std::unique_ptr<const dem::Posts> owned, const geo::Geodetic& place,
                   const HorizonOptions& options);

    HighestCrossing look_around(double azimuth_rad, double from_m, double until_m,
                                const HighestCrossing& on_site,
                                std::vector<TracePoint>& line) const;
    const dem::Posts& farthest_posts() const { return around_ ? *around_ : *posts_; }
    glm::dvec2 given(glm::dvec2 post) const;

    std::unique_ptr<const dem::Posts> owned_;  // those of a heightfield
    const dem::Posts& given_;
    /// A DEM that goes round the Earth, with the place in its middle: lines of sight end before
    /// they are half way round. Columns are of this one, but for those that callers get.
    std::optional<dem::Posts> unrolled_;
    const dem::Posts* posts_;
    std::optional<dem::Posts> unrolled_around_;  // likewise of Posts::surroundings()
    const dem::Posts* around_ = nullptr;
    std::unique_ptr<const Fan> fan_around_;
    std::unique_ptr<const Fan> fan_;  // none on a map
    HorizonOptions options_;
    geo::Geodetic place_;
    glm::dvec2 post_{0};
    double eye_m_ = 0;
    double true_north_on_map_rad_ = 0;
};

}  // namespace relevo::light
