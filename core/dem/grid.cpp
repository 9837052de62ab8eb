#include "dem/grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/units.h"

namespace relevo::dem {
namespace {

// The curvature of a parallel over a 64th of the widest raster (the whole Earth, at 60 degrees)
// changes its length by 0.04 %.
constexpr int kPathPieces = 64;

/// The length of the way over the ground from one post to another along the grid.
double path_m(const Grid& grid, const glm::dvec2& from, const glm::dvec2& to) {
    std::array<glm::dvec2, kPathPieces + 1> posts;
    for (int i = 0; i <= kPathPieces; ++i)
        posts[static_cast<std::size_t>(i)] = glm::mix(from, to, i / double{kPathPieces});
    std::array<geo::Geodetic, kPathPieces + 1> places;
    grid.place(posts, places);
    double length_m = 0;
    for (std::size_t i = 0; i < kPathPieces; ++i) {
        const double piece_m = geo::geodesic(places[i], places[i + 1]).distance_m;
        if (std::isfinite(piece_m)) length_m += piece_m;  // whole-Earth maps have corners in space
    }
    return length_m;
}

}  // namespace

Affine Affine::of_geotransform(std::span<const double, 6> t) {
    return {t[0] + (t[1] + t[2]) / 2, t[1], t[2], t[3] + (t[4] + t[5]) / 2, t[4], t[5]};
}

std::array<double, 6> Affine::geotransform() const {
    return {x0 - (x_column + x_row) / 2, x_column, x_row,
            y0 - (y_column + y_row) / 2, y_column, y_row};
}

glm::dvec2 Affine::inverse(const glm::dvec2& point) const {
    const double determinant = x_column * y_row - x_row * y_column;
    const double x = point.x - x0;
    const double y = point.y - y0;
    return {(x * y_row - y * x_row) / determinant, (y * x_column - x * y_column) / determinant};
}

Grid::Grid(int columns, int rows, const Affine& post_to_crs, geo::Crs crs)
    : columns_(columns), rows_(rows), affine_(post_to_crs), crs_(std::move(crs)) {
    assert(columns > 0 && rows > 0);
}

geo::Geodetic Grid::place(double column, double row) const {
    const glm::dvec2 point = affine_(column, row);
    return crs_.to_geodetic(point.x, point.y);
}

void Grid::place(std::span<const glm::dvec2> posts, std::span<geo::Geodetic> places) const {
    assert(posts.size() == places.size());
    constexpr std::size_t kBatch = 256;
    std::array<glm::dvec2, kBatch> points;
    for (std::size_t i = 0; i < posts.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, posts.size() - i);
        for (std::size_t k = 0; k < n; ++k)
            points[k] = affine_(posts[i + k].x, posts[i + k].y);
        crs_.to_geodetic(std::span(points).first(n), places.subspan(i, n));
    }
}

glm::dvec2 Grid::post(const geo::Geodetic& place) const {
    glm::dvec2 point = crs_.from_geodetic(place);
    if (crs_.is_geographic()) {
        const double turn = 2 * kPi / crs_.unit_si();
        const double middle = affine_((columns_ - 1) / 2.0, (rows_ - 1) / 2.0).x;
        point.x += turn * std::round((middle - point.x) / turn);
    }
    return affine_.inverse(point);
}

double Grid::turn_columns() const {
    if (!crs_.is_geographic() || affine_.x_column == 0 || affine_.y_column != 0) return 0;
    return 2 * kPi / crs_.unit_si() / std::abs(affine_.x_column);
}

glm::dvec2 Grid::post(const geo::Geodetic& place, const glm::dvec2& near) const {
    glm::dvec2 post = this->post(place);
    if (const double turn = turn_columns(); turn > 0)
        post.x -= turn * std::round((post.x - near.x) / turn);
    return post;
}

std::optional<int> Grid::columns_per_turn() const {
    constexpr double kApart = 0.01;  // columns: the last and the first are no farther from a whole
    const double turn = turn_columns();
    const bool is_whole = turn > 0 && std::abs(turn - std::round(turn)) < kApart;
    if (!is_whole || columns_ < std::lround(turn)) return std::nullopt;
    return static_cast<int>(std::lround(turn));
}

geo::Geodetic Grid::center() const {
    return place((columns_ - 1) / 2.0, (rows_ - 1) / 2.0);
}

double Grid::share_on_earth() const {
    constexpr int kSamples = 32;
    std::array<glm::dvec2, kSamples + 1> posts;
    std::array<geo::Geodetic, kSamples + 1> places;
    int found = 0;
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i)
            posts[static_cast<std::size_t>(i)] = {std::round((columns_ - 1.0) * i / kSamples),
                                                  std::round((rows_ - 1.0) * j / kSamples)};
        place(posts, places);
        found += static_cast<int>(std::ranges::count_if(
            places, [](const geo::Geodetic& at) { return std::isfinite(at.lat_rad); }));
    }
    return found / double{(kSamples + 1) * (kSamples + 1)};
}

glm::dvec2 Grid::post_spacing_m() const {
    const double column = (columns_ - 1) / 2.0;
    const double row = (rows_ - 1) / 2.0;
    const auto distance_m = [](const geo::Geodetic& a, const geo::Geodetic& b) {
        return geo::geodesic(a, b).distance_m;
    };
    return {distance_m(place(column - 0.5, row), place(column + 0.5, row)),
            distance_m(place(column, row - 0.5), place(column, row + 0.5))};
}

glm::dvec2 Grid::sides_m() const {
    const double column = (columns_ - 1) / 2.0;
    const double row = (rows_ - 1) / 2.0;
    return {path_m(*this, {0, row}, {columns_ - 1, row}),
            path_m(*this, {column, 0}, {column, rows_ - 1})};
}

double Grid::row_azimuth_rad() const {
    return geo::geodesic(center(), place(columns_ / 2.0, (rows_ - 1) / 2.0)).azimuth_rad;
}

glm::dvec2 Grid::extent_m() const {
    const double along_row_rad = row_azimuth_rad();
    const double along_column_rad =
        geo::geodesic(center(), place((columns_ - 1) / 2.0, rows_ / 2.0)).azimuth_rad;
    const glm::dvec2 side_m = sides_m();
    return {side_m.x * std::abs(std::sin(along_row_rad)) +
                side_m.y * std::abs(std::sin(along_column_rad)),
            side_m.x * std::abs(std::cos(along_row_rad)) +
                side_m.y * std::abs(std::cos(along_column_rad))};
}

Grid Grid::part(const Window& window, int columns, int rows) const {
    const double columns_each = window.columns / static_cast<double>(columns);
    const double rows_each = window.rows / static_cast<double>(rows);
    const double column = window.column + (columns_each - 1) / 2;
    const double row = window.row + (rows_each - 1) / 2;
    const glm::dvec2 first = affine_(column, row);
    return Grid(columns, rows,
                {first.x, affine_.x_column * columns_each, affine_.x_row * rows_each, first.y,
                 affine_.y_column * columns_each, affine_.y_row * rows_each},
                crs_);
}

}  // namespace relevo::dem
