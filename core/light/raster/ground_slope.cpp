#include "light/raster/ground_slope.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "geo/local_frame.h"

namespace relevo::light {
namespace {

/// Metres to the east and to the north of the next column and of the next row.
glm::dmat2 metres_a_post(const dem::Grid& grid, double column, double row) {
    const geo::Geodetic place = grid.place(column, row);
    const geo::LocalFrame frame(place);
    const auto metres = [&](double c, double r) {
        return glm::dvec2(frame.to_local(grid.place(column + c, row + r)) -
                          frame.to_local(grid.place(column - c, row - r)));
    };
    return {metres(0.5, 0), metres(0, 0.5)};
}

/// Heights around a post.
class Around {
  public:
    Around(const dem::Grid& grid, const dem::Posts::View& heights, int column, int row)
        : grid_(grid), heights_(heights), column_(column), row_(row), here_m_(stored_m(0, 0)) {}

    /// From post to post along rows and along columns; of a hole none.
    glm::dvec2 rise() const {
        if (std::isnan(here_m_)) return {0, 0};
        const auto over = [&](int c, int r) { return at_m(c, r) - at_m(-c, -r); };
        const double diagonal = over(1, 1), other = over(1, -1);
        return {(diagonal + 2 * over(1, 0) + other) / 8, (diagonal + 2 * over(0, 1) - other) / 8};
    }

  private:
    /// Beyond the last post the ground goes on as it came.
    double at_m(int columns, int rows) const {
        const float there_m = stored_m(columns, rows);
        if (!std::isnan(there_m)) return there_m;
        const float opposite_m = stored_m(-columns, -rows);
        if (!std::isnan(opposite_m)) return 2 * double{here_m_} - opposite_m;
        // In a corner neither is there.
        return columns != 0 && rows != 0 ? at_m(columns, 0) + at_m(0, rows) - here_m_ : here_m_;
    }

    float stored_m(int columns, int rows) const {
        const int c = column_ + columns, r = row_ + rows;
        const bool inside = c >= 0 && r >= 0 && c < grid_.columns() && r < grid_.rows();
        return inside ? *heights_.at(c, r) : std::nanf("");
    }

    const dem::Grid& grid_;
    const dem::Posts::View& heights_;
    int column_, row_;
    float here_m_;
};

/// From rises a post to rises a metre; north is that of a post.
glm::dmat2 from_posts(const dem::Grid& grid, double column, double row) {
    return glm::inverse(glm::transpose(metres_a_post(grid, column, row)));
}

}  // namespace

glm::dvec2 rise_at(const dem::Posts& posts, int column, int row) {
    const dem::Grid& grid = posts.grid();
    const int left = std::max(0, column - 1), top = std::max(0, row - 1);
    const dem::Window around{left, top, std::min(grid.columns(), column + 2) - left,
                             std::min(grid.rows(), row + 2) - top};
    std::vector<float> buffer;
    return from_posts(grid, column, row) *
           Around(grid, posts.view(around, buffer), column, row).rise();
}

GroundSlope::GroundSlope(const SunTerrain& terrain, const WindowHeights& heights,
                         const Window& window)
    : GroundSlope(window) {
    fill(terrain, window, [&](int column, int row, const glm::dmat2& to_metres) {
        return to_metres * Around(terrain.grid(), heights.view, column, row).rise();
    });
}

GroundSlope::GroundSlope(const SunTerrain& terrain, const Window& window, const Plane& plane)
    : GroundSlope(window) {
    const double steep = std::tan(std::min(plane.tilt_rad, radians(89.999)));
    const glm::dvec2 rise =
        -steep * glm::dvec2(std::sin(plane.azimuth_rad), std::cos(plane.azimuth_rad));
    fill(terrain, window, [&](int, int, const glm::dmat2&) { return rise; });
}

void GroundSlope::fill(const SunTerrain& terrain, const Window& window,
                       const std::function<glm::dvec2(int, int, const glm::dmat2&)>& rise) {
    const dem::Grid& grid = terrain.grid();
    // Posts next to each other have one north: those of a block of the grid, whatever the window.
    constexpr int kTogether = 32;
    const auto fill_row = [&](int row) {
        for (int block = window.column / kTogether * kTogether; block < window.end_column();
             block += kTogether) {
            const int width = std::min(kTogether, grid.columns() - block);
            const int middle = block + width / 2,
                      middle_row = std::min(grid.rows() - 1, row | (kTogether / 2));
            const glm::dmat2 to_metres = from_posts(grid, middle, middle_row);
            const geo::Geodetic place = grid.place(middle, middle_row);
            const geo::Axes axes = terrain.frame().axes(place.lat_rad, place.lon_rad);
            const int end = std::min(block + width, window.end_column());
            for (int column = std::max(block, window.column); column < end; ++column) {
                const glm::dvec2 up = rise(column, row, to_metres);
                const glm::vec3 gradient(up.x * axes.east + up.y * axes.north);
                const int to_x = column - window.column, to_y = row - window.row;
                x.at(to_x, to_y) = gradient.x;
                y.at(to_x, to_y) = gradient.y;
                z.at(to_x, to_y) = gradient.z;
            }
        }
    };
    parallel_for(window.row, window.end_row(), kTogether, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            fill_row(row);
    });
}

std::array<float, kLongestRun> raised_over_planes(const SweepRun& run, const GroundSlope& planes,
                                                  const glm::ivec2& first,
                                                  const glm::vec3& towards) {
    std::array<float, kLongestRun> raised;
    for (int i = 0; i < run.count; ++i)
        raised[static_cast<std::size_t>(i)] =
            std::max(run.found[i], glm::dot(planes.at(first.x + i, first.y), towards));
    return raised;
}

}  // namespace relevo::light
