#include "light/ground_slope.h"

#include <cmath>

#include <glm/mat2x2.hpp>

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

    float here_m() const { return here_m_; }
    /// Beyond the last post the ground goes on as it came.
    double at_m(int columns, int rows) const {
        const float there_m = stored_m(columns, rows);
        if (!std::isnan(there_m)) return there_m;
        const float opposite_m = stored_m(-columns, -rows);
        return std::isnan(opposite_m) ? here_m_ : 2 * double{here_m_} - opposite_m;
    }

  private:
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

}  // namespace

void ground_slope(const dem::Grid& grid, const dem::Posts::View& heights, const SweepWindow& window,
                  TileValues& east, TileValues& north) {
    const glm::dmat2 metres = metres_a_post(grid, window.column + (window.columns - 1) / 2.0,
                                            window.row + (window.rows - 1) / 2.0);
    const glm::dmat2 from_posts = glm::inverse(glm::transpose(metres));
    for (int row = window.row; row < window.row + window.rows; ++row) {
        const SweepRun run{.along_column = false,
                           .line = row,
                           .first = window.column,
                           .count = window.columns,
                           .height_m = nullptr,
                           .found = nullptr};
        float *const to_east = east.of(run), *const to_north = north.of(run);
        for (int i = 0; i < window.columns; ++i) {
            const Around post(grid, heights, window.column + i, row);
            if (std::isnan(post.here_m())) continue;
            const auto rise = [&](int c, int r) { return post.at_m(c, r) - post.at_m(-c, -r); };
            const double diagonal = rise(1, 1), other = rise(1, -1);
            const glm::dvec2 a_post((diagonal + 2 * rise(1, 0) + other) / 8,
                                    (diagonal + 2 * rise(0, 1) - other) / 8);
            const glm::dvec2 slope = from_posts * a_post;
            to_east[i] = static_cast<float>(slope.x);
            to_north[i] = static_cast<float>(slope.y);
        }
    }
}

}  // namespace relevo::light
