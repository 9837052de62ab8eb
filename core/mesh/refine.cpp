#include "mesh/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "mesh/spans.h"

// A right-triangulated irregular network (P. Lindstrom et al., SIGGRAPH 1996) was rejected. It
// needs a grid of a power of two plus one, and is refined to single cells along every outline of a
// void and every edge that does not fit it.
namespace relevo::mesh {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Inserts posts until none is left that has to be a vertex.
class Refinement {
  public:
    Refinement(const Array2d<float>& height_m, Array2d<std::uint8_t>& roles, double error_m)
        : height_m_(height_m),
          roles_(roles),
          error_m_(error_m),
          mesh_(height_m.width(), height_m.height()) {
        for (std::uint32_t point = 0; point < mesh_.points(); ++point)
            mark(mesh_.point(point));
        changed_ = {0, 1};
        look_at_changed();
    }

    /// @returns whether the triangles are enough
    bool run(std::int64_t max_triangles, const std::function<void(double)>& on_share) {
        constexpr int kPosts = 4096;  // between two words
        for (int posts = 0; !queue_.empty();) {
            const Entry entry = queue_.top();
            queue_.pop();
            if (entry.version != state_[entry.triangle].version) continue;
            if (on_share && posts++ % kPosts == 0) on_share(share_done(entry.urgency));
            if (mesh_.triangles() + 2 > max_triangles) return false;
            const LatticePoint post = state_[entry.triangle].farthest;
            mark(post);
            mesh_.insert(entry.triangle, post, changed_);
            look_at_changed();
        }
        return true;
    }

    GridMesh ground() const;

  private:
    /// A triangle whose farthest post has to become a vertex.
    struct Entry {
        float urgency;
        std::uint32_t triangle, version;
        bool operator<(const Entry& other) const { return urgency < other.urgency; }
    };
    struct State {
        LatticePoint farthest;
        std::uint32_t version = 0;
    };

    /// Half of the error takes about twice as many triangles, until all posts are vertices.
    double share_done(double urgency) const {
        const double all = static_cast<double>(height_m_.width()) * height_m_.height();
        return std::min(1.0, std::max(error_m_ / urgency, mesh_.points() / all));
    }

    void mark(const LatticePoint& post) { roles_.at(post.column, post.row) |= kVertex; }

    void look_at_changed() {
        std::ranges::sort(changed_);
        const auto rest = std::ranges::unique(changed_);
        changed_.erase(rest.begin(), rest.end());
        state_.resize(mesh_.triangles());
        for (const std::uint32_t triangle : changed_) {
            State& state = state_[triangle];
            ++state.version;
            const float urgency = look_at(triangle, state.farthest);
            if (urgency > 0) queue_.push({urgency, triangle, state.version});
        }
        changed_.clear();
    }

    /// Finds the post of a triangle that is farthest from it. Fixed posts are farther than all
    /// others, and of them the one nearest to the middle, which leaves no slivers.
    /// @returns 0 where none has to be a vertex
    float look_at(std::uint32_t triangle, LatticePoint& farthest) const;

    float height_m(const LatticePoint& post) const {
        const float height = height_m_.at(post.column, post.row);
        return std::isnan(height) ? 0 : height;  // of triangles that do not stay
    }

    bool is_ground(std::uint32_t triangle) const {
        LatticePoint sum;
        for (const std::uint32_t corner : mesh_.corners(triangle)) {
            sum.column += mesh_.point(corner).column;
            sum.row += mesh_.point(corner).row;
        }
        // No triangle has cells of both kinds: the one at its centroid speaks for all.
        return is_ground_cell(height_m_, sum.column / 3, sum.row / 3);
    }

    const Array2d<float>& height_m_;
    Array2d<std::uint8_t>& roles_;
    const double error_m_;
    Delaunay mesh_;
    std::vector<State> state_;
    std::priority_queue<Entry> queue_;
    std::vector<std::uint32_t> changed_;
};

float Refinement::look_at(std::uint32_t triangle, LatticePoint& farthest) const {
    const auto indices = mesh_.corners(triangle);
    const std::array<LatticePoint, 3> at{mesh_.point(indices[0]), mesh_.point(indices[1]),
                                         mesh_.point(indices[2])};
    const auto doubled = static_cast<double>(twice_area(at[0], at[1], at[2]));
    if (doubled < 2) return 0;  // has no other post
    // The plane over the triangle: height = at its first corner + by column + by row.
    const double a = height_m(at[0]), b = height_m(at[1]) - a, c = height_m(at[2]) - a;
    const double column_b = at[1].column - at[0].column, row_b = at[1].row - at[0].row;
    const double column_c = at[2].column - at[0].column, row_c = at[2].row - at[0].row;
    const double by_column = (b * row_c - c * row_b) / doubled;
    const double by_row = (c * column_b - b * column_c) / doubled;
    const double middle_column = (at[0].column + at[1].column + at[2].column) / 3.0;
    const double middle_row = (at[0].row + at[1].row + at[2].row) / 3.0;
    double worst_m = error_m_, nearest = std::numeric_limits<double>::infinity();
    bool any = false;
    const Spans spans(at);
    for (int row = spans.first_row; row <= spans.last_row; ++row) {
        const auto [first, last] = spans.columns(row);
        const auto heights = height_m_.row(row);
        const auto roles = roles_.row(row);
        const double start_m = a + by_row * (row - at[0].row) - by_column * at[0].column;
        for (int column = first; column <= last; ++column) {
            const std::uint8_t role = roles[static_cast<std::size_t>(column)];
            if (!(role & kGround) || role & kVertex) continue;
            if (role & kFixed) {
                const double distance = std::hypot(column - middle_column, row - middle_row);
                if (distance < nearest) {
                    nearest = distance;
                    farthest = {column, row};
                }
                continue;
            }
            const double off_m =
                std::abs(heights[static_cast<std::size_t>(column)] - start_m - by_column * column);
            if (off_m > worst_m) {
                worst_m = off_m;
                any = true;
                if (!std::isfinite(nearest)) farthest = {column, row};
            }
        }
    }
    if (std::isfinite(nearest)) return kInfinite;
    return any ? static_cast<float>(worst_m) : 0;
}

GridMesh Refinement::ground() const {
    GridMesh result;
    std::vector<std::uint32_t> index_of(mesh_.points(), Delaunay::kNone);
    const auto index = [&](std::uint32_t point) {
        if (index_of[point] == Delaunay::kNone) {
            index_of[point] = static_cast<std::uint32_t>(result.points.size());
            result.points.push_back(mesh_.point(point));
        }
        return index_of[point];
    };
    for (std::uint32_t triangle = 0; triangle < mesh_.triangles(); ++triangle) {
        if (!is_ground(triangle)) continue;
        const auto corners = mesh_.corners(triangle);
        // Rows count downwards: the other way round on the map.
        for (const std::size_t i : {0, 2, 1})
            result.corners.push_back(index(corners[i]));
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t beyond = mesh_.neighbour(triangle, static_cast<int>(i));
            if (beyond == Delaunay::kNone || !is_ground(beyond))
                result.border.push_back({index(corners[(i + 1) % 3]), index(corners[i])});
        }
    }
    return result;
}

}  // namespace

bool is_ground_cell(const Array2d<float>& height_m, int column, int row) {
    if (column < 0 || row < 0 || column + 1 >= height_m.width() || row + 1 >= height_m.height())
        return false;
    const float* const above = height_m.row(row).data() + column;
    const float* const below = height_m.row(row + 1).data() + column;
    return !std::isnan(above[0] + above[1] + below[0] + below[1]);
}

namespace {

/// The cells around a post, clockwise from the one before it in its row and above it.
struct Around {
    std::array<bool, 4> ground;   ///< is of ground
    std::array<bool, 4> outside;  ///< of the grid
};

Around around(const Array2d<float>& height_m, int column, int row) {
    Around result{};
    constexpr std::array<std::array<int, 2>, 4> kCells{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    for (std::size_t i = 0; i < 4; ++i) {
        const int c = column + kCells[i][0], r = row + kCells[i][1];
        result.outside[i] =
            c < 0 || r < 0 || c + 1 >= height_m.width() || r + 1 >= height_m.height();
        result.ground[i] = is_ground_cell(height_m, c, r);
    }
    return result;
}

}  // namespace

Array2d<std::uint8_t> ground_roles(const Array2d<float>& height_m) {
    Array2d<std::uint8_t> roles(height_m.width(), height_m.height());
    for (int row = 0; row < height_m.height(); ++row)
        for (int column = 0; column < height_m.width(); ++column) {
            if (std::isnan(height_m.at(column, row))) continue;
            const Around cells = around(height_m, column, row);
            bool ground = false, is_void = false;
            for (std::size_t i = 0; i < 4; ++i) {
                ground = ground || cells.ground[i];
                is_void = is_void || (!cells.ground[i] && !cells.outside[i]);
            }
            roles.at(column, row) =
                static_cast<std::uint8_t>(ground ? kGround | (is_void ? kFixed : 0) : 0);
        }
    return roles;
}

std::int64_t cut_corner_contacts(Array2d<float>& height_m) {
    std::int64_t all = 0, cut = 1;
    while (cut > 0) {
        cut = 0;
        for (int row = 1; row + 1 < height_m.height(); ++row)
            for (int column = 1; column + 1 < height_m.width(); ++column) {
                if (std::isnan(height_m.at(column, row))) continue;
                const auto ground = around(height_m, column, row).ground;
                if (ground[0] != ground[2] || ground[1] != ground[3] || ground[0] == ground[1])
                    continue;
                height_m.at(column, row) = std::numeric_limits<float>::quiet_NaN();
                ++cut;
            }
        all += cut;
    }
    return all;
}

std::optional<GridMesh> refine(const Array2d<float>& height_m, Array2d<std::uint8_t>& roles,
                               double error_m, std::int64_t max_triangles,
                               const std::function<void(double)>& on_share) {
    // Three edges a triangle are numbered with 32 bits.
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    Refinement refinement(height_m, roles, error_m);
    if (!refinement.run(std::min(max_triangles, kMost), on_share)) return std::nullopt;
    return refinement.ground();
}

}  // namespace relevo::mesh
