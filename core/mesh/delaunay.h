#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace relevo::mesh {

/// A point with whole coordinates: a post of a grid.
struct LatticePoint {
    int column = 0, row = 0;
    friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

/// Twice the area of a triangle in columns and rows, positive where a, b, c turn from the columns'
/// direction to the rows'.
std::int64_t twice_area(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c);

/// A Delaunay triangulation of a rectangle of lattice points, which grows by insertion: the point
/// splits its triangle, or the two at its edge, and edges are flipped until no circumcircle has a
/// point inside. Exact: integers of 64 bits.
/// Source: L. Guibas, J. Stolfi, ACM Trans. Graph. 4, 1985; C. L. Lawson, 1977 (flips).
///
/// An edge from a post to its neighbour in the row or the column is in every Delaunay triangulation
/// that has both, because no third lattice point is in the circle around it.
class Delaunay {
  public:
    /// Points along a side, so that squares of squares have room in 64 bits.
    static constexpr int kMaxSide = 1 << 15;
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// Two triangles between the corners (0, 0) and (columns - 1, rows - 1); 2 to kMaxSide of both.
    Delaunay(int columns, int rows);

    std::uint32_t triangles() const { return static_cast<std::uint32_t>(corners_.size() / 3); }
    std::uint32_t points() const { return static_cast<std::uint32_t>(points_.size()); }
    const LatticePoint& point(std::uint32_t index) const { return points_[index]; }
    /// Indices of a triangle's points; twice_area() of them is positive.
    std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const;
    /// The triangle beyond the edge from corner `edge` to the next; kNone at the rectangle's sides.
    std::uint32_t neighbour(std::uint32_t triangle, int edge) const;

    /// Inserts a point that is not there yet.
    /// @param triangle  that has it inside or on an edge
    /// @param changed   gets the new triangles and the changed ones; some may come twice
    void insert(std::uint32_t triangle, const LatticePoint& point,
                std::vector<std::uint32_t>& changed);

  private:
    // A half-edge 3 t + i leads from corner i of the triangle t to the next one.
    static std::uint32_t next(std::uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
    static std::uint32_t previous(std::uint32_t edge) {
        return edge % 3 == 0 ? edge + 2 : edge - 1;
    }

    std::uint32_t add_triangle();
    void set(std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners);
    void link(std::uint32_t edge, std::uint32_t twin);
    void split_triangle(std::uint32_t triangle, std::uint32_t point);
    void split_edge(std::uint32_t edge, std::uint32_t point);
    void flip(std::uint32_t edge);
    bool must_flip(std::uint32_t edge) const;

    std::vector<LatticePoint> points_;
    std::vector<std::uint32_t> corners_, twins_;
    std::vector<std::uint32_t> suspects_;  ///< edges opposite to the new point
    std::vector<std::uint32_t>* changed_ = nullptr;
};

}  // namespace relevo::mesh
