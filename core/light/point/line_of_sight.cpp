#include "light/point/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::light {
namespace {

constexpr double kChunk_cells = 32;

/// One line of sight over the grid, followed outwards.
class LineOfSight {
  public:
    LineOfSight(const dem::Posts& posts, const ApparentElevation& elevation, double until_m)
        : posts_(posts),
          columns_(posts.grid().columns()),
          rows_(posts.grid().rows()),
          lowest_m_(posts.lowest_m()),
          highest_m_(posts.highest_m()),
          elevation_(elevation),
          until_m_(until_m) {}

    HighestCrossing follow(std::span<const TracePoint> line) {
        if (line.size() < 2) return found_;
        // Any length of the order of a post serves: what is nearer is the start itself.
        touching_m_ =
            1e-6 * line[1].distance_m / std::max(1e-9, glm::length(line[1].post - line[0].post));
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            if (!segment(line[i], line[i + 1])) break;
        return found_;
    }

  private:
    static TracePoint mix(const TracePoint& a, const TracePoint& b, double t) {
        return {a.post + t * (b.post - a.post), a.distance_m + t * (b.distance_m - a.distance_m)};
    }

    /// How much of the way from a to b lies within the posts.
    double inside(const TracePoint& a, const TracePoint& b) const {
        double t = 1;
        for (int axis = 0; axis < 2; ++axis) {
            const double first = -kSnap_cells;
            const double last = (axis == 0 ? columns_ : rows_) - 1 + kSnap_cells;
            const double from = a.post[axis], to = b.post[axis];
            if (to > last) t = std::min(t, (last - from) / (to - from));
            if (to < first) t = std::min(t, (first - from) / (to - from));
        }
        return std::max(t, 0.0);
    }

    /// @returns whether the line goes on
    bool segment(const TracePoint& from, const TracePoint& next) {
        double t = inside(from, next);
        const bool leaves = t < 1;
        TracePoint to = mix(from, next, t);
        found_.reach_m = to.distance_m;
        const bool ends = to.distance_m >= until_m_;
        if (ends) {
            if (from.distance_m >= until_m_) return false;
            t = (until_m_ - from.distance_m) / (to.distance_m - from.distance_m);
            to = mix(from, to, t);
        }
        if (!nothing_left_) {
            const glm::dvec2 cells = glm::abs(to.post - from.post);
            const int chunks =
                std::max(1, static_cast<int>(std::ceil(std::max(cells.x, cells.y) / kChunk_cells)));
            TracePoint a = from;
            for (int i = 1; i <= chunks && !nothing_left_; ++i) {
                const TracePoint b = i == chunks ? to : mix(from, to, i / double(chunks));
                chunk(a, b);
                a = b;
            }
        }
        return !leaves && !ends;
    }

    /// The highest tangent that height h can have between two distances.
    double bound(double h, double near_m, double far_m) const {
        const double rise = elevation_.rise(h, near_m);
        return rise > 0 ? rise / elevation_.run(lowest_m_, near_m)
                        : rise / elevation_.run(h, far_m);
    }

    void chunk(const TracePoint& a, const TracePoint& b) {
        const auto [c1, c2] = std::minmax(a.post.x, b.post.x);
        const auto [r1, r2] = std::minmax(a.post.y, b.post.y);
        const glm::ivec2 first(c1, r1), last(c2, r2);
        if (a.distance_m > touching_m_) {
            if (bound(highest_m_, a.distance_m, kFarthest_m) <= found_.tangent) {
                nothing_left_ = true;
                return;
            }
            const float h = posts_.bound_m(first.x, last.x, first.y, last.y);
            if (bound(h, a.distance_m, b.distance_m) <= found_.tangent) return;
        }
        // Rounding may put a crossing into the cell beside.
        const glm::ivec2 begin = glm::max(first - 1, 0);
        const glm::ivec2 end = glm::min(last + 3, glm::ivec2(columns_, rows_));
        thread_local std::vector<float> buffer;
        const dem::Posts::View view =
            posts_.view({begin.x, begin.y, end.x - begin.x, end.y - begin.y}, buffer);
        crossings<0>(a, b, view);
        crossings<1>(a, b, view);
    }

    /// All crossings with columns (axis 0) or rows (axis 1).
    template <int kAxis>
    void crossings(const TracePoint& a, const TracePoint& b, const dem::Posts::View& view) {
        constexpr int kOther = 1 - kAxis;
        const double begin = a.post[kAxis], way = b.post[kAxis] - begin;
        if (way == 0) return;
        const int lines = kAxis == 0 ? columns_ : rows_;
        const auto [low, high] = std::minmax(begin, b.post[kAxis]);
        const int first = std::max(0, static_cast<int>(std::ceil(low)));
        const int last = std::min(lines - 1, static_cast<int>(std::floor(high)));
        const int posts = kOther == 0 ? columns_ : rows_;
        const std::ptrdiff_t line = kAxis == 0 ? 1 : view.stride;
        const std::ptrdiff_t step = kAxis == 0 ? view.stride : 1;
        const int view_line = kAxis == 0 ? view.column : view.row;
        const int view_post = kAxis == 0 ? view.row : view.column;
        const double other_way = b.post[kOther] - a.post[kOther];
        const double distance = b.distance_m - a.distance_m;
        for (int i = first; i <= last; ++i) {
            const double t = (i - begin) / way;
            const double s = a.distance_m + t * distance;
            if (s <= touching_m_) continue;
            const double other = a.post[kOther] + t * other_way;
            const int k = std::clamp(static_cast<int>(other), 0, posts - 2);
            const double f = other - k;
            const float* h0 = view.first_m + (i - view_line) * line + (k - view_post) * step;
            double h = h0[0] + f * (h0[step] - h0[0]);
            if (h != h) {
                // A void at the far end of the edge does not spoil the post itself.
                h = f <= kSnap_cells ? h0[0] : f >= 1 - kSnap_cells ? h0[step] : kNaN;
                if (h != h) {
                    const int none = h0[0] != h0[0] ? k : k + 1;
                    if (kAxis == 0 ? posts_.is_outside(i, none) : posts_.is_outside(none, i))
                        continue;
                    found_.first_void_m = std::min(found_.first_void_m, s);
                    found_.last_void_m = std::max(found_.last_void_m, s);
                    continue;
                }
            }
            const double rise = elevation_.rise(h, s), run = elevation_.run(h, s);
            if (rise > found_.tangent * run) {
                found_.tangent = rise / run;
                found_.distance_m = s;
                found_.height_m = h;
                found_.post[kAxis] = i;
                found_.post[kOther] = other;
            }
        }
    }

    // Half the way round: the longest geodesic.
    static constexpr double kFarthest_m = 2.0e7;

    const dem::Posts& posts_;
    int columns_, rows_;
    double lowest_m_, highest_m_;
    const ApparentElevation& elevation_;
    double until_m_;
    double touching_m_ = 0;
    HighestCrossing found_;
    bool nothing_left_ = false;
};

}  // namespace

HighestCrossing highest_crossing(const dem::Posts& posts, const ApparentElevation& elevation,
                                 std::span<const TracePoint> line, double until_m) {
    return LineOfSight(posts, elevation, until_m).follow(line);
}

}  // namespace relevo::light
