#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "base/window.h"
#include "geo/crs.h"
#include "geo/geodetic.h"

namespace relevo::dem {

/// From post indices to coordinates of a CRS: x = x0 + x_column * column + x_row * row, y likewise.
/// Integer indices are posts, (0, 0) the first of the first row.
struct Affine {
    double x0 = 0;
    double x_column = 1;
    double x_row = 0;
    double y0 = 0;
    double y_column = 0;
    double y_row = -1;

    glm::dvec2 operator()(double column, double row) const {
        return {x0 + x_column * column + x_row * row, y0 + y_column * column + y_row * row};
    }
    /// From GDAL's geotransform, which has corners of cells at whole indices, and to it.
    static Affine of_geotransform(std::span<const double, 6> t);
    std::array<double, 6> geotransform() const;
    /// The indices of a point; the rows and columns must not be parallel.
    glm::dvec2 inverse(const glm::dvec2& point) const;

    friend bool operator==(const Affine&, const Affine&) = default;
};

using relevo::Window;

/// Where the posts of a raster are on the Earth. Row 0 is the first row of the file, whichever way
/// it runs; a post is the centre of its cell (files that say pixel-is-point are read so that this
/// holds for them too). Indices are columns 0 to columns - 1 and rows 0 to rows - 1; fractions lie
/// between posts, and the edge of the cells is at -0.5.
///
/// A value; every const function is safe on several threads at once.
class Grid {
  public:
    Grid(int columns, int rows, const Affine& post_to_crs, geo::Crs crs);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    const geo::Crs& crs() const { return crs_; }
    const Affine& affine() const { return affine_; }

    /// The place of a post or between posts, on the ellipsoid (height 0). Latitude and longitude
    /// are NaN where the CRS has no place for it.
    /// Accuracy: that of PROJ, 1 mm tested (tests/geo/test_crs.cpp, tests/dem/test_grid.cpp).
    geo::Geodetic place(double column, double row) const;

    /// The same for many; x is the column, y the row. Measured in UTM 0.27 us a post against 0.30
    /// us
    /// with a call for each, 0.8 us through a change of datum (tests/dem/bench_dem.cpp); what
    /// counts is that threads then meet once a batch and not once a post.
    /// @param places  as many as `posts`
    void place(std::span<const glm::dvec2> posts, std::span<geo::Geodetic> places) const;

    /// The column (x) and row (y), with fractions, of a place: the inverse of place(), within
    /// 1 mm on the ground. May lie outside of the grid. NaN where the CRS cannot express the place.
    /// On a grid that counts longitudes past 180 degrees, the turn nearest to its centre.
    glm::dvec2 post(const geo::Geodetic& place) const;
    /// The same, on the turn of longitude that is nearest to a post.
    glm::dvec2 post(const geo::Geodetic& place, const glm::dvec2& near) const;

    /// Columns from a longitude to the same one again, with fractions; 0 where no row of a grid
    /// with such a CRS has both.
    double turn_columns() const;

    /// How many columns a turn of longitude has, where the grid goes round the Earth, so that its
    /// first column follows on its last one.
    std::optional<int> columns_per_turn() const;

    /// The middle of the grid, on the ellipsoid.
    geo::Geodetic center() const;

    /// Share of posts that the CRS has a place for, from a sample all over the grid: below 1 where
    /// a map of the world has corners beside the globe, or where rows go on past a pole.
    double share_on_earth() const;

    /// Ground metres from post to post at the centre: x along a row, y along a column. Geodesic,
    /// so 30 m in UTM are 29.99 to 30.01 m and a degree of longitude shrinks with the latitude.
    glm::dvec2 post_spacing_m() const;

    /// Ground metres from the first post to the last: x along the middle row, y along the middle
    /// column, whichever way they run.
    glm::dvec2 sides_m() const;

    /// Azimuth of the middle row at the centre, from the first post towards the last [rad]. 90
    /// degrees where the grid is neither turned nor mirrored.
    double row_azimuth_rad() const;

    /// Ground metres that the posts span from west to east (x) and from south to north (y), from
    /// the first post to the last: the box, oriented to true north, around the middle row and the
    /// middle column as they run at the centre.
    glm::dvec2 extent_m() const;

    /// The grid of what read() makes of a window: its cells are equal parts of the window's, each
    /// post in the middle of its cell. With as many posts as the window has, the posts themselves.
    Grid part(const Window& window, int columns, int rows) const;

  private:
    int columns_;
    int rows_;
    Affine affine_;
    geo::Crs crs_;
};

}  // namespace relevo::dem
