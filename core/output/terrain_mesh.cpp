#include "output/terrain_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "mesh/refine.h"
#include "output/mesh_error.h"

namespace relevo::output {
namespace {

/// Of the error, for the bending of the Earth under straight triangles.
constexpr double kBendShare = 1.0 / 16;

/// Calls `body` with the frame's points of many lattice points, in pieces.
/// @param at    gives the post and its height
template <typename At, typename Body>
void each_placed(const GroundFrame& frame, std::size_t count, const At& at, const Body& body) {
    constexpr std::size_t kAtOnce = 1 << 14;
    std::vector<glm::dvec2> posts;
    std::vector<double> heights;
    std::vector<GroundFrame::Point> points;
    for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
        const std::size_t end = std::min(count, begin + kAtOnce);
        posts.clear();
        heights.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const std::pair<mesh::LatticePoint, double> one = at(i);
            posts.emplace_back(one.first.column, one.first.row);
            heights.push_back(one.second);
        }
        points.resize(posts.size());
        frame.place(posts, heights, points);
        for (std::size_t i = begin; i < end; ++i)
            body(i, points[i - begin]);
    }
}

/// Makes the mesh of one DEM.
class Maker {
  public:
    Maker(Array2d<float> height_m, const dem::Grid& grid, const GroundFrame& frame,
          const TerrainMeshOptions& options)
        : height_m_(std::move(height_m)), grid_(grid), frame_(frame), options_(options) {}

    TerrainMesh make() {
        check_size();
        if (options_.solid) result_.cut_posts = mesh::cut_corner_contacts(height_m_);
        const Array2d<std::uint8_t> roles = mesh::ground_roles(height_m_);
        count(roles);
        refine(roles);
        result_.ground_triangles = top_.triangles();
        if (options_.solid)
            close();
        else
            finish_surface();
        return std::move(result_);
    }

  private:
    void check_size() const {
        const int columns = height_m_.width(), rows = height_m_.height();
        if (columns < 2 || rows < 2)
            bad_input(fmt::format("{}: a mesh needs 2 x 2 posts, but the DEM has {} x {}",
                                  options_.name, columns, rows));
        if (std::max(columns, rows) > mesh::Delaunay::kMaxSide)
            bad_input(
                fmt::format("{}: {} x {} posts, expected at most {} a side; pass --crop W,S,E,N",
                            options_.name, columns, rows, mesh::Delaunay::kMaxSide));
    }

    void count(const Array2d<std::uint8_t>& roles) {
        std::int64_t with_height = 0;
        for (const float height : height_m_)
            with_height += !std::isnan(height);
        for (const std::uint8_t role : roles)
            result_.posts += (role & mesh::kGround) != 0;
        result_.lone_posts = with_height - result_.posts;
        if (result_.posts == 0)
            bad_input(
                fmt::format("{}: no four posts of a cell have heights; a mesh needs one such "
                            "cell",
                            options_.name));
    }

    double lowest_m() const {
        float lowest = std::numeric_limits<float>::max();
        for (const float height : height_m_)
            if (height < lowest) lowest = height;
        return double{lowest};
    }
    double highest_m() const {
        float highest = std::numeric_limits<float>::lowest();
        for (const float height : height_m_)
            if (height > highest) highest = height;
        return double{highest};
    }

    /// What 32 bits of a coordinate round by [m].
    double rounding_m() const {
        const std::vector<glm::dvec2> corners{{0, 0},
                                              {grid_.columns() - 1, 0},
                                              {0, grid_.rows() - 1},
                                              {grid_.columns() - 1, grid_.rows() - 1}};
        double most_m = 1;
        for (const double height_m : {lowest_m(), highest_m()}) {
            std::vector<GroundFrame::Point> points(4);
            frame_.place(corners, std::vector<double>(4, height_m), points);
            for (const GroundFrame::Point& point : points)
                if (const double far_m = glm::length(point.at_m); std::isfinite(far_m))
                    most_m = std::max(most_m, far_m);
        }
        return most_m * 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
    }

    /// Posts in a regular net become vertices, so that no triangle is so large that the ground
    /// bends away from it.
    void fix_net(Array2d<std::uint8_t>& roles, double allowed_m, double bend_m) const {
        if (bend_m <= 0) return;
        // All posts are within half the diagonal of a net's cell from the middle of their
        // triangle's circle: a quadratic leaves its chord there by bend * (step / sqrt(2))^2 / 2.
        const double most = std::sqrt(4 * allowed_m / bend_m);
        const int step = static_cast<int>(std::clamp(most, 1.0, double{mesh::Delaunay::kMaxSide}));
        for (int row = 0; row < roles.height(); row += step)
            for (int column = 0; column < roles.width(); column += step)
                fix(roles, column, row);
        for (int row = 0; row < roles.height(); row += step)
            fix(roles, roles.width() - 1, row);
        for (int column = 0; column < roles.width(); column += step)
            fix(roles, column, roles.height() - 1);
    }

    static void fix(Array2d<std::uint8_t>& roles, int column, int row) {
        if (roles.at(column, row) & mesh::kGround) roles.at(column, row) |= mesh::kFixed;
    }

    void refine(const Array2d<std::uint8_t>& roles_before) {
        const double rounding = rounding_m(), bend_m = frame_.bend_m();
        if (options_.error_m < 8 * rounding)
            bad_input(
                fmt::format("--error: {:g}: smaller than what 32-bit coordinates hold over this "
                            "DEM; pass {:.1g} or more, or --crop W,S,E,N",
                            options_.error_m, 10 * rounding));
        double allowed_m = options_.error_m - 4 * rounding;
        constexpr int kAttempts = 8;
        for (int attempt = 0; attempt < kAttempts; ++attempt, allowed_m *= 0.7) {
            Array2d<std::uint8_t> roles = roles_before;
            fix_net(roles, kBendShare * allowed_m, bend_m);
            auto refined = mesh::refine(height_m_, roles,
                                        bend_m > 0 ? (1 - kBendShare) * allowed_m : allowed_m,
                                        options_.max_triangles, options_.on_share);
            if (!refined) too_many();
            top_ = std::move(*refined);
            place_points();
            const MeshError error =
                mesh_error(top_, result_.surface.position_m, height_m_, roles, frame_);
            result_.worst_m = error.worst_m;
            result_.mean_m = error.mean_m;
            if (error.worst_m <= options_.error_m) return;
        }
        failed(
            fmt::format("{}: no mesh within {:g} m: the ground bends too much between posts; "
                        "the nearest is {:g} m off",
                        options_.name, options_.error_m, result_.worst_m));
    }

    [[noreturn]] void too_many() const {
        bad_input(
            fmt::format("{}: {} triangles are too few for an error of {:g} m; pass a larger "
                        "--error, --crop W,S,E,N, or a larger --memory, now {} MiB",
                        options_.name, options_.max_triangles, options_.error_m,
                        // Rounded up, as --memory has been divided into whole triangles.
                        (options_.max_triangles * mesh::kBytesATriangle + (1 << 20) - 1) >> 20));
    }

    double height_m(const mesh::LatticePoint& post) const {
        return height_m_.at(post.column, post.row);
    }

    void place_points() {
        std::vector<glm::vec3>& position_m = result_.surface.position_m;
        position_m.resize(top_.points.size());
        each_placed(
            frame_, position_m.size(),
            [&](std::size_t i) { return std::pair(top_.points[i], height_m(top_.points[i])); },
            [&](std::size_t i, const GroundFrame::Point& point) {
                position_m[i] = glm::vec3(point.at_m);
            });
    }

    void finish_surface() {
        mesh::Surface& surface = result_.surface;
        surface.normal.resize(top_.points.size());
        surface.texture.resize(top_.points.size());
        const glm::dvec2 posts(grid_.columns(), grid_.rows());
        for (std::size_t i = 0; i < top_.points.size(); ++i)
            surface.texture[i] =
                glm::vec2((glm::dvec2(top_.points[i].column, top_.points[i].row) + 0.5) / posts);
        // Of the posts before and behind each vertex, in its row and in its column.
        std::vector<glm::dvec3> ends(4);
        each_placed(
            frame_, 4 * top_.points.size(),
            [&](std::size_t i) {
                const mesh::LatticePoint post = beside(top_.points[i / 4], i % 4);
                return std::pair(post, height_m(post));
            },
            [&](std::size_t i, const GroundFrame::Point& point) {
                ends[i % 4] = point.at_m;
                if (i % 4 < 3) return;
                surface.normal[i / 4] =
                    glm::vec3(glm::normalize(glm::cross(ends[3] - ends[2], ends[1] - ends[0])));
            });
        surface.corners = std::move(top_.corners);
    }

    /// The post west (0), east (1), north (2) or south (3) of another one, or itself where that has
    /// no height.
    mesh::LatticePoint beside(const mesh::LatticePoint& post, std::size_t side) const {
        mesh::LatticePoint other = post;
        (side < 2 ? other.column : other.row) += side % 2 == 0 ? -1 : 1;
        const bool inside = other.column >= 0 && other.row >= 0 &&
                            other.column < height_m_.width() && other.row < height_m_.height();
        return inside && !std::isnan(height_m(other)) ? other : post;
    }

    double base_m() const {
        glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
        for (const glm::vec3& position : result_.surface.position_m) {
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
        const glm::vec3 size = high - low;
        if (!options_.base_m) return low.z - std::max(size.z / 10, std::max(size.x, size.y) / 50);
        if (*options_.base_m < low.z) return *options_.base_m;
        bad_input(fmt::format("--base: {:g}: expected a height below the lowest post, {:g} m",
                              *options_.base_m, low.z));
    }

    void close() {
        result_.base_m = base_m();
        Array2d<std::uint8_t> roles(height_m_.width(), height_m_.height());
        for (const auto& edge : top_.border)
            for (const std::uint32_t point : edge)
                roles.at(top_.points[point].column, top_.points[point].row) =
                    mesh::kGround | mesh::kFixed;
        const auto bottom = mesh::refine(height_m_, roles, std::numeric_limits<double>::infinity(),
                                         options_.max_triangles);
        if (!bottom) too_many();
        const auto place = [&](const mesh::LatticePoint& post) {
            const glm::dvec2 at(post.column, post.row);
            const double height = height_m(post);
            GroundFrame::Point point;
            frame_.place({&at, 1}, {&height, 1}, {&point, 1});
            return point.at_m;
        };
        result_.surface = mesh::solid(top_, *bottom, place, *result_.base_m);
    }

    Array2d<float> height_m_;
    const dem::Grid& grid_;
    const GroundFrame& frame_;
    const TerrainMeshOptions& options_;
    mesh::GridMesh top_;
    TerrainMesh result_;
};

}  // namespace

TerrainMesh terrain_mesh(Array2d<float> height_m, const dem::Grid& grid, const GroundFrame& frame,
                         const TerrainMeshOptions& options) {
    return Maker(std::move(height_m), grid, frame, options).make();
}

}  // namespace relevo::output
