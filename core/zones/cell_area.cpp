#include "zones/cell_area.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "geo/ellipsoid.h"

namespace relevo::zones {
namespace {

constexpr int kNodes = 257;

/// Gauss and Legendre's places and weights between 0 and 1.
struct Node {
    double at, weight;
};
constexpr std::array<Node, 3> kThree = {
    {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}}};
constexpr std::array<Node, 5> kFive = {{{0.04691007703066802, 0.11846344252809454},
                                        {0.23076534494715845, 0.23931433524968324},
                                        {0.5, 0.28444444444444444},
                                        {0.76923465505284155, 0.23931433524968324},
                                        {0.95308992296933198, 0.11846344252809454}}};

/// Area of a square radian of longitude and latitude on the ellipsoid [m2].
double square_radian_m2(double lat_rad) {
    constexpr double kSquare = geo::kFlattening * (2 - geo::kFlattening);
    const double sine = std::sin(lat_rad), left = 1 - kSquare * sine * sine;
    return geo::kEquatorialRadius_m * geo::kEquatorialRadius_m * (1 - kSquare) * std::cos(lat_rad) /
           (left * left);
}

}  // namespace

CellArea::CellArea(const dem::Grid& grid, bool on_ellipsoid) : grid_(grid) {
    const dem::Affine& to = grid.affine();
    if (!on_ellipsoid && !grid.crs().is_geographic()) {
        const double unit = grid.crs().unit_si();
        alike_m2_ = std::abs(to.x_column * to.y_row - to.x_row * to.y_column) * unit * unit;
    } else if (!grid.crs().is_geographic()) {
        nodes_m2_ = Array2d<double>(kNodes, kNodes);
        for (int row = 0; row < kNodes; ++row)
            for (int column = 0; column < kNodes; ++column)
                nodes_m2_.at(column, row) = exact(glm::dvec2(column, row) / (kNodes - 1.0) *
                                                  glm::dvec2(grid.columns(), grid.rows()));
    }
}

double CellArea::exact(const glm::dvec2& place) const {
    const dem::Affine& to = grid_.affine();
    const geo::Crs& crs = grid_.crs();
    if (crs.is_geographic()) {
        const double unit = crs.unit_si(), lat = to(place.x - 0.5, place.y - 0.5).y * unit;
        return std::abs(to.x_column * to.y_row - to.x_row * to.y_column) * unit * unit *
               std::max(square_radian_m2(lat), 0.0);
    }
    const auto at = [&](double x, double y) {
        return grid_.place(place.x - 0.5 + x, place.y - 0.5 + y);
    };
    const geo::Geodetic west = at(-0.5, 0), east = at(0.5, 0), north = at(0, -0.5),
                        south = at(0, 0.5);
    const auto turn = [](double lon_rad) { return std::remainder(lon_rad, 2 * kPi); };
    return square_radian_m2(0.5 * (north.lat_rad + south.lat_rad)) *
           std::abs(turn(east.lon_rad - west.lon_rad) * (south.lat_rad - north.lat_rad) -
                    turn(south.lon_rad - north.lon_rad) * (east.lat_rad - west.lat_rad));
}

double CellArea::at(const glm::dvec2& place) const {
    if (alike_m2_) return *alike_m2_;
    const glm::dvec2 node = place * (kNodes - 1.0) / glm::dvec2(grid_.columns(), grid_.rows());
    const bool inside = node.x >= 0 && node.y >= 0 && node.x <= kNodes - 1 && node.y <= kNodes - 1;
    if (nodes_m2_.width() == 0 || !inside) return exact(place);
    const int column = std::min(static_cast<int>(node.x), kNodes - 2),
              row = std::min(static_cast<int>(node.y), kNodes - 2);
    const double x = node.x - column, y = node.y - row;
    return std::lerp(std::lerp(nodes_m2_.at(column, row), nodes_m2_.at(column + 1, row), x),
                     std::lerp(nodes_m2_.at(column, row + 1), nodes_m2_.at(column + 1, row + 1), x),
                     y);
}

/// From one x to another in a row one cell high.
double CellArea::to_the_right(double from, double to, double y) const {
    if (alike_m2_) return (to - from) * *alike_m2_;
    double sum = 0;
    for (const Node& node : kThree)
        sum += node.weight * at({std::lerp(from, to, node.at), y});
    return (to - from) * sum;
}

double CellArea::enclosed(std::span<const Edge> edges) const {
    if (edges.empty()) return 0;
    if (alike_m2_) return area(edges) * *alike_m2_;
    const double from = edges.front().low.x;
    double sum = 0;
    for (const Edge& edge : edges) {
        double behind = 0;
        for (const Node& node : kFive) {
            const glm::dvec2 place = edge.low + node.at * (edge.high - edge.low);
            behind += node.weight * to_the_right(from, place.x, place.y);
        }
        sum += (edge.enters ? -behind : behind) * (edge.high.y - edge.low.y);
    }
    return sum;
}

}  // namespace relevo::zones
