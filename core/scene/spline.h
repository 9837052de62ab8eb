#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace relevo::scene {

/// A centripetal Catmull-Rom spline: a curve through points, without loops or cusps between them.
/// C. Yuksel, S. Schaefer, J. Keyser, Parameterization and applications of Catmull-Rom curves,
/// Computer-Aided Design 43, 2011.
template <std::size_t kSize>
class CentripetalSpline {
  public:
    using Point = std::array<double, kSize>;

    /// @param points   two or more
    /// @param lengths  of the way from each point to the next, above 0, one fewer than points
    CentripetalSpline(std::vector<Point> points, const std::vector<double>& lengths)
        : points_(std::move(points)) {
        knots_.push_back(0);
        for (const double length : lengths)
            knots_.push_back(knots_.back() + std::sqrt(length));
    }

    std::size_t segments() const { return points_.size() - 1; }

    /// @param segment  from point `segment` to the next
    /// @param share    of the segment, 0 to 1
    Point at(std::size_t segment, double share) const {
        const double t = knots_[segment] + share * (knots_[segment + 1] - knots_[segment]);
        const Outer before = outer(segment, -1), after = outer(segment + 1, +1);
        const double t1 = knots_[segment], t2 = knots_[segment + 1];
        const Point &p1 = points_[segment], &p2 = points_[segment + 1];
        // Barry and Goldman's pyramid.
        const Point a1 = between(before.point, before.knot, p1, t1, t);
        const Point a2 = between(p1, t1, p2, t2, t);
        const Point a3 = between(p2, t2, after.point, after.knot, t);
        const Point b1 = between(a1, before.knot, a2, t2, t);
        const Point b2 = between(a2, t1, a3, after.knot, t);
        return between(b1, t1, b2, t2, t);
    }

  private:
    struct Outer {
        Point point;
        double knot;
    };

    /// The neighbour of a point; beyond the ends the reflection of the other neighbour.
    Outer outer(std::size_t of, int way) const {
        if (way < 0 ? of > 0 : of + 1 < points_.size()) {
            const std::size_t i = way < 0 ? of - 1 : of + 1;
            return {points_[i], knots_[i]};
        }
        const std::size_t i = way < 0 ? of + 1 : of - 1;
        Outer result{points_[of], 2 * knots_[of] - knots_[i]};
        for (std::size_t c = 0; c < kSize; ++c)
            result.point[c] = 2 * points_[of][c] - points_[i][c];
        return result;
    }

    static Point between(const Point& a, double knot_a, const Point& b, double knot_b, double t) {
        const double share = (t - knot_a) / (knot_b - knot_a);
        Point result;
        for (std::size_t c = 0; c < kSize; ++c)
            result[c] = a[c] + share * (b[c] - a[c]);
        return result;
    }

    std::vector<Point> points_;
    std::vector<double> knots_;
};

}  // namespace relevo::scene
