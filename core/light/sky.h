#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "base/array2d.h"
#include "base/units.h"
#include "dem/posts.h"
#include "geo/local_frame.h"
#include "light/edge_ground.h"
#include "light/shadows.h"
#include "light/sweep.h"
#include "sun/refraction.h"

/// The sun over the grid of a DEM, as sweeps need it; shared by what makes rasters.
namespace relevo::light {

/// Sweeps over all posts of a DEM, in memory or not.
/// @param posts  outlives it
Sweep sweep_over(const dem::Posts& posts);

/// The heights of a part, and of the posts beside it.
struct PartHeights {
    std::vector<float> buffer;
    dem::Posts::View view;

    PartHeights(const dem::Posts& posts, const SweepWindow& part);
    float at(int column, int row) const { return *view.at(column, row); }
};

/// A tile of a DEM, and the sun over it but for its height.
struct SunTile {
    SweepWindow window;  ///< that the sun is made for
    SweepWindow part;    ///< of it, whose posts are wanted; they have the same figures in any part
    SweepSun path;       ///< its tangents are not set
    /// Of a band: posts all over it, which its sun is fitted to; the window is around it. None: the
    /// tile is all of its window.
    std::vector<GridPair> marks{};
};

/// A window between rays of a sun: over each band of posts between two of them, side by side, the
/// sun is one. What a sun over a grid in degrees differs by, it does across its rays.
struct SunBands {
    std::vector<SunTile> tiles;
    std::vector<SweepSun> rays;  ///< after each band but the last

    /// Them and their suns, as sweeps over a part of the window have them.
    std::vector<Sweep::Blocks::Band> over(const SweepWindow& part) const;
};

/// What is the same of a DEM for all suns.
class DemSky {
  public:
    /// @param posts, air  outlive this
    /// @throws Error (BadInput) for a refraction that no air has
    DemSky(const dem::Posts& posts, const ShadowOptions& options);

    const dem::Posts& posts() const { return posts_; }
    const dem::Grid& grid() const { return posts_.grid(); }
    const glm::dvec2& spacing_m() const { return spacing_m_; }  ///< the grid's post_spacing_m()
    double widest_spacing_m() const { return std::max(spacing_m_.x, spacing_m_.y); }
    /// Where its corners, the middles of its sides and its own middle are.
    const std::array<geo::Geodetic, 9>& marks() const { return marks_; }
    const geo::LocalFrame& frame() const { return frame_; }
    double curvature() const { return curvature_; }  ///< of lines of sight over the ground [1/m]
    double relief_m() const { return relief_m_; }
    /// Edges of shadows need be no lower. That is so far under the lowest post that a margin which
    /// it bounds tells nothing of when shade will come, nor, where discs are asked for, of the
    /// part of one that any ground in sight hides.
    float floor_m() const { return floor_m_; }
    /// Ground that is farther off is under the horizon of the smooth Earth, be it and the eye on
    /// whatever height.
    double horizon_reach_m() const;
    bool has_air() const { return !airs_.empty(); }
    /// A sun without air that no post sees: from the highest one the sea's horizon dips, and air
    /// lifts the sun by up to 0.7 degrees.
    double lowest_sun_rad() const;
    /// How many levels of air matter to a sun: the lowest post's and the highest one's where the
    /// two see it otherwise, else what is between them.
    std::size_t levels(double elevation_rad) const;
    double level_height_m(std::size_t level) const;
    /// @param level  0: of the lowest post, 1: of the highest one, kBetween: the mean of both
    double apparent_rad(double elevation_rad, std::size_t level) const;
    static constexpr std::size_t kBetween = 2;

  private:
    const dem::Posts& posts_;
    glm::dvec2 spacing_m_;
    std::array<geo::Geodetic, 9> marks_;
    geo::LocalFrame frame_;
    double curvature_, relief_m_;
    float floor_m_;
    std::vector<sun::Refraction> airs_;  // over the lowest post and the highest one, or none
};

/// A sun over the grid of a DEM.
class SunSky {
  public:
    SunSky(const DemSky& dem, const SunOverDem& sun);
    /// A sun that stands so over a place.
    SunSky(const DemSky& dem, const geo::Geodetic& place, const SunOverDem& sun);
    /// A direction that is the same at every place, from true north there, and level.
    SunSky(const DemSky& dem, double azimuth_rad);

    const DemSky& dem() const { return dem_; }
    std::size_t levels() const { return levels_; }
    /// The first of its levels, for DemSky::apparent_rad(); where there is another one that is 1.
    std::size_t first_level() const { return levels_ == 2 ? 0 : DemSky::kBetween; }
    /// How sweeps of all its tiles go, so that their posts come in one order.
    bool along_columns() const { return along_columns_; }
    /// Whether they come from the same side, too, in the middle of the DEM.
    bool goes_like(const SunSky& other) const {
        return along_columns_ == other.along_columns_ && from_first_ == other.from_first_;
    }

    /// The same, swept as another one is; none where rays would go too far aside.
    std::optional<SunSky> going_like(const SunSky& other) const;

    /// The sun is under the horizon of every post.
    bool is_night() const;

    /// Of the sun without air at a post, or at a place.
    double elevation_rad(double column, double row) const { return at(column, row).elevation_rad; }
    double elevation_rad(const geo::Geodetic& place) const { return at(place).elevation_rad; }

    /// Likewise towards it, local ENU, a unit vector.
    glm::dvec3 direction(double column, double row) const;

    /// The ray through the middle of a window, as a cubic over the grid.
    std::optional<SunTile> tile(const SweepWindow& window) const;

    /// A window in bands over each of which the sun is one; none where they would be too narrow.
    /// Their rays go through that diagonal of it which all rays cross.
    std::optional<SunBands> bands(const SweepWindow& window, double tolerance_rad) const;

    /// The tile's sun with the heights of a part of the disc.
    /// @param offset_rad  of that part over the centre
    SweepSun sun(const SunTile& tile, std::size_t level, double offset_rad) const;

    /// As far as ground can shade: where a ray has risen over all relief of a round Earth.
    double reach_m(double apparent_rad) const;

    /// How far off a tile's sun is anywhere on it [rad].
    /// @param enough_rad  where it is off by more, by how much does not matter
    double error_rad(const SunTile& tile, double enough_rad = kPi) const;

  private:
    struct Local {
        double azimuth_rad, elevation_rad;  // without air
    };
    Local at(const geo::Geodetic& place) const;
    Local at(double column, double row) const { return at(dem_.grid().place(column, row)); }
    class BandMaker;
    void find_way();
    glm::dvec2 middle_step() const;
    glm::dvec2 step(const glm::dvec2& post) const;
    std::optional<SweepSun> cubic(const glm::dvec2& middle, double far_m,
                                  const glm::dvec3& shares) const;
    std::optional<SweepSun> ray(const glm::dvec2& middle, const SweepWindow& window) const;
    SweepSun fitted(const SunTile& tile, const std::function<double(const GridPair&)>& of) const;
    double path_error_rad(const SunTile& tile, const glm::dvec2& post, const Local& sun) const;

    const DemSky& dem_;
    glm::dvec3 direction_{0};
    std::size_t levels_;
    std::optional<double> azimuth_rad_;  // instead of `direction_`
    bool along_columns_ = false, from_first_ = false;
};

/// How far a tile's sun may be off where it is looked at, unless it is so high that no shadow is
/// moved by a tenth of a post for it; 0.05 degrees anywhere.
constexpr double kSunTolerance_rad = radians(0.04);

/// The tiles of a window over each of which a sun is one, for all suns given. They are long towards
/// suns that stand alike, so that little is swept twice.
/// @param part  of the window: tiles without a post of it are left out
/// @throws Error (BadInput) where a grid is so coarse or so near to a pole that there are none
std::vector<SweepWindow> divide(const std::vector<SunSky>& suns, const SweepWindow& window,
                                const SweepWindow& part, double tolerance_rad = kSunTolerance_rad);

/// A window over which each of some suns is one, or has bands.
struct BandedWindow {
    SweepWindow window;
    std::vector<SunBands> bands;  ///< of each sun; none: all are one
};

/// Such windows of a window: few large ones.
/// @param suns  one after the other in time, not long apart
/// @param part  as divide() has it
/// @throws Error as divide()
std::vector<BandedWindow> divide_in_bands(std::span<const SunSky> suns, const SweepWindow& window,
                                          const SweepWindow& part);

/// Calls `body` with each of them, on several threads.
void each_window(const std::vector<SweepWindow>& windows,
                 const std::function<void(const SweepWindow&)>& body);

inline SweepWindow whole(const dem::Grid& grid) {
    return {0, 0, grid.columns(), grid.rows()};
}

/// The window of options, where one without posts stands for all.
inline SweepWindow window_of(const dem::Window& asked, const dem::Grid& grid) {
    if (asked.columns == 0) return whole(grid);
    return {asked.column, asked.row, asked.columns, asked.rows};
}

/// What two windows have in common; without columns or rows where that is nothing.
SweepWindow common(const SweepWindow& a, const SweepWindow& b);

/// The tile of a sun on one of its windows, where the posts of a part are wanted.
SunTile tile_of(const SunSky& sky, const SweepWindow& window, const SweepWindow& part);

/// A figure for each post of a window, in the order in which sweeps come to them.
class TileValues {
  public:
    TileValues(const SweepWindow& window, float value, bool along_columns = false);
    TileValues() : TileValues({}, 0) {}
    /// Of another window from now on, in the same memory.
    void cover(const SweepWindow& window, float value, bool along_columns);
    /// Some of them, turned so.
    TileValues part(const SweepWindow& window, bool along_columns) const;

    /// Along columns, or along rows, which is how they begin.
    void turn(bool along_columns);
    /// The same where all of them are to be set.
    void turn_unset(bool along_columns) { along_columns_ = along_columns; }
    float* of(const SweepRun& run) { return values_.data() + index_of(run); }
    const float* of(const SweepRun& run) const { return values_.data() + index_of(run); }
    /// Puts them where the window is.
    /// @param of  the window that `all` has the posts of
    void put(Array2d<float>& all, const SweepWindow& of) const;
    const SweepWindow& window() const { return window_; }
    std::span<float> all() { return values_; }
    /// The figures of one of the window's rows; only where they are not turned.
    const float* row(int row) const {
        return values_.data() + std::ptrdiff_t{row - window_.row} * window_.columns;
    }

  private:
    std::ptrdiff_t index_of(const SweepRun& run) const {
        const int line = run.line - (run.along_column ? window_.column : window_.row);
        const int first = run.first - (run.along_column ? window_.row : window_.column);
        return std::ptrdiff_t{line} * (run.along_column ? window_.rows : window_.columns) + first;
    }

    SweepWindow window_;
    bool along_columns_;
    std::vector<float> values_;
};

/// The edges of shadow over a tile, the posts' own air and the ground beyond the DEM considered.
class TileEdges {
  public:
    /// @param sky         outlives this
    /// @param offset_rad  of the part of the disc over its centre
    TileEdges(const SunSky& sky, const SunTile& tile, double offset_rad);

    /// Those that are swept: one, or two for the air of the lowest post and of the highest one.
    const std::vector<SweepSun>& suns() const { return suns_; }
    /// @param sweep    calls its argument with edges of one of them, each post's once; it is called
    ///     with one after the other
    /// @param scratch  of a window that holds those posts, turned as the sweeps go
    /// @param use      takes the posts and their edges
    void each(const std::function<void(std::size_t sun, const Sweep::Use&)>& sweep,
              TileValues& scratch, const Sweep::Use& use) const;
    /// Those of a run of kRun posts at most.
    /// @param run      with the edges of the last one that is swept
    /// @param other_m  those of the first one, where there are two
    /// @param room     for as many
    /// @return where they are: there, or what the run has
    const float* find(const SweepRun& run, const float* other_m, float* room) const;
    static constexpr int kRun = RayEdges::kLongestRun;

    /// Takes tangents to change from post to post as those of another sun do.
    void go_like(const SweepSun& other) {
        for (SweepSun& sun : suns_)
            sun.tangent_a_post = other.tangent_a_post;
    }

  private:
    const DemSky& dem_;
    std::vector<SweepSun> suns_;
    bool over_earth_;                // nowhere lower than level
    std::optional<RayEdges> edges_;  // else
};

/// Calls `use` with the posts of a tile's part and the edge of the shadow over each, on several
/// threads.
/// @param offset_rad  of the part of the disc over its centre
/// @param scratch     of a window that holds that part, turned as the sun's sweeps go
void each_edge(const SunSky& sky, const Sweep& sweep, const SunTile& tile, double offset_rad,
               TileValues& scratch, const Sweep::Use& use);

/// The same with the tangent of the elevation of the horizon, from the ground at each post. Where
/// nothing of the DEM is higher, it is that of the ground beyond the DEM.
void each_horizon(const SunSky& direction, const Sweep& sweep, const SunTile& tile,
                  const Sweep::Use& use);

}  // namespace relevo::light
