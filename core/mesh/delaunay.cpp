#include "mesh/delaunay.h"

namespace relevo::mesh {
namespace {

/// Whether d is inside the circle through a, b, c, whose twice_area() is positive.
bool is_in_circle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                  const LatticePoint& d) {
    const std::int64_t ax = a.column - d.column, ay = a.row - d.row;
    const std::int64_t bx = b.column - d.column, by = b.row - d.row;
    const std::int64_t cx = c.column - d.column, cy = c.row - d.row;
    const std::int64_t aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return aa * (bx * cy - by * cx) - bb * (ax * cy - ay * cx) + cc * (ax * by - ay * bx) > 0;
}

}  // namespace

std::int64_t twice_area(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    return std::int64_t{b.column - a.column} * (c.row - a.row) -
           std::int64_t{b.row - a.row} * (c.column - a.column);
}

Delaunay::Delaunay(int columns, int rows) {
    points_ = {{0, 0}, {columns - 1, 0}, {columns - 1, rows - 1}, {0, rows - 1}};
    const std::uint32_t a = add_triangle(), b = add_triangle();
    set(a, {0, 1, 2});
    set(b, {2, 3, 0});
    link(3 * a + 2, 3 * b + 2);
}

std::array<std::uint32_t, 3> Delaunay::corners(std::uint32_t triangle) const {
    const std::size_t first = std::size_t{3} * triangle;
    return {corners_[first], corners_[first + 1], corners_[first + 2]};
}

std::uint32_t Delaunay::neighbour(std::uint32_t triangle, int edge) const {
    const std::uint32_t twin = twins_[std::size_t{3} * triangle + static_cast<std::size_t>(edge)];
    return twin == kNone ? kNone : twin / 3;
}

std::uint32_t Delaunay::add_triangle() {
    corners_.insert(corners_.end(), 3, 0);
    twins_.insert(twins_.end(), 3, kNone);
    return triangles() - 1;
}

void Delaunay::set(std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i)
        corners_[std::size_t{3} * triangle + i] = corners[i];
    if (changed_) changed_->push_back(triangle);
}

void Delaunay::link(std::uint32_t edge, std::uint32_t twin) {
    twins_[edge] = twin;
    if (twin != kNone) twins_[twin] = edge;
}

void Delaunay::insert(std::uint32_t triangle, const LatticePoint& point,
                      std::vector<std::uint32_t>& changed) {
    changed_ = &changed;
    const std::uint32_t index = points();
    points_.push_back(point);
    std::uint32_t on_edge = kNone;
    for (std::uint32_t edge = 3 * triangle; edge < 3 * triangle + 3; ++edge)
        if (twice_area(points_[corners_[edge]], points_[corners_[next(edge)]], point) == 0)
            on_edge = edge;
    if (on_edge == kNone)
        split_triangle(triangle, index);
    else
        split_edge(on_edge, index);
    while (!suspects_.empty()) {
        const std::uint32_t edge = suspects_.back();
        suspects_.pop_back();
        if (must_flip(edge)) flip(edge);
    }
    changed_ = nullptr;
}

void Delaunay::split_triangle(std::uint32_t t, std::uint32_t point) {
    const auto [a, b, c] = corners(t);
    const std::uint32_t beyond_bc = twins_[3 * t + 1], beyond_ca = twins_[3 * t + 2];
    const std::uint32_t u = add_triangle(), v = add_triangle();
    set(t, {a, b, point});
    set(u, {b, c, point});
    set(v, {c, a, point});
    link(3 * u, beyond_bc);
    link(3 * v, beyond_ca);
    link(3 * t + 1, 3 * u + 2);
    link(3 * u + 1, 3 * v + 2);
    link(3 * v + 1, 3 * t + 2);
    suspects_.insert(suspects_.end(), {3 * t, 3 * u, 3 * v});
}

void Delaunay::split_edge(std::uint32_t edge, std::uint32_t point) {
    // (a, b, c) becomes (a, point, c) and (point, b, c).
    const std::uint32_t t = edge / 3, twin = twins_[edge];
    const std::uint32_t a = corners_[edge], b = corners_[next(edge)], c = corners_[previous(edge)];
    const std::uint32_t beyond_bc = twins_[next(edge)], beyond_ca = twins_[previous(edge)];
    const std::uint32_t u = add_triangle();
    set(t, {a, point, c});
    set(u, {point, b, c});
    link(3 * t + 2, beyond_ca);
    link(3 * u + 1, beyond_bc);
    link(3 * t + 1, 3 * u + 2);
    suspects_.insert(suspects_.end(), {3 * t + 2, 3 * u + 1});
    twins_[3 * t] = twins_[3 * u] = kNone;
    if (twin == kNone) return;
    // (b, a, d) on the other side becomes (b, point, d) and (point, a, d).
    const std::uint32_t v = twin / 3, d = corners_[previous(twin)];
    const std::uint32_t beyond_ad = twins_[next(twin)], beyond_db = twins_[previous(twin)];
    const std::uint32_t w = add_triangle();
    set(v, {b, point, d});
    set(w, {point, a, d});
    link(3 * v + 2, beyond_db);
    link(3 * w + 1, beyond_ad);
    link(3 * v + 1, 3 * w + 2);
    link(3 * t, 3 * w);
    link(3 * u, 3 * v);
    suspects_.insert(suspects_.end(), {3 * v + 2, 3 * w + 1});
}

bool Delaunay::must_flip(std::uint32_t edge) const {
    const std::uint32_t twin = twins_[edge];
    if (twin == kNone) return false;
    return is_in_circle(points_[corners_[edge]], points_[corners_[next(edge)]],
                        points_[corners_[previous(edge)]], points_[corners_[previous(twin)]]);
}

void Delaunay::flip(std::uint32_t edge) {
    // (a, b, p) and (b, a, d) become (a, d, p) and (d, b, p).
    const std::uint32_t twin = twins_[edge], t = edge / 3, u = twin / 3;
    const std::uint32_t a = corners_[edge], b = corners_[next(edge)], p = corners_[previous(edge)];
    const std::uint32_t d = corners_[previous(twin)];
    const std::uint32_t beyond_bp = twins_[next(edge)], beyond_pa = twins_[previous(edge)];
    const std::uint32_t beyond_ad = twins_[next(twin)], beyond_db = twins_[previous(twin)];
    set(t, {a, d, p});
    set(u, {d, b, p});
    link(3 * t, beyond_ad);
    link(3 * t + 2, beyond_pa);
    link(3 * u, beyond_db);
    link(3 * u + 1, beyond_bp);
    link(3 * t + 1, 3 * u + 2);
    suspects_.insert(suspects_.end(), {3 * t, 3 * u});
}

}  // namespace relevo::mesh
