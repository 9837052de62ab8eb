#include "output/mesh_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/spans.h"

namespace relevo::output {
namespace {

constexpr int kTrianglesAtOnce = 1024;
constexpr std::size_t kPostsAtOnce = 1 << 14;

/// The distances of some triangles' posts.
class Distances {
  public:
    Distances(const mesh::GridMesh& mesh, const std::vector<glm::vec3>& position_m,
              const Array2d<float>& height_m, const Array2d<std::uint8_t>& roles,
              const GroundFrame& frame)
        : mesh_(mesh), position_m_(position_m), height_m_(height_m), roles_(roles), frame_(frame) {}

    void add(std::size_t triangle) {
        // Clockwise on the map, as spans have it.
        std::array<mesh::LatticePoint, 3> at{};
        for (std::size_t i = 0; i < 3; ++i)
            at[i] = mesh_.points[mesh_.corners[3 * triangle + (3 - i) % 3]];
        const mesh::Spans spans(at);
        for (int row = spans.first_row; row <= spans.last_row; ++row) {
            const auto [first, last] = spans.columns(row);
            for (int column = first; column <= last; ++column) {
                if (!(roles_.at(column, row) & mesh::kGround)) continue;
                if (roles_.at(column, row) & mesh::kVertex) continue;
                posts_.emplace_back(column, row);
                heights_.push_back(height_m_.at(column, row));
                triangle_of_.push_back(triangle);
                weights_.push_back(weight(at, {column, row}));
            }
            if (posts_.size() >= kPostsAtOnce) measure();
        }
    }

    void measure() {
        points_.resize(posts_.size());
        frame_.place(posts_, heights_, points_);
        for (std::size_t i = 0; i < posts_.size(); ++i) {
            const auto corner = [&](std::size_t k) {
                return glm::dvec3(position_m_[mesh_.corners[3 * triangle_of_[i] + k]]);
            };
            const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
            const double off_m = std::abs(glm::dot(points_[i].at_m - corner(0), normal) /
                                          glm::dot(normal, points_[i].up));
            worst_m = std::max(worst_m, off_m);
            sum_m += weights_[i] * off_m;
        }
        posts_.clear();
        heights_.clear();
        triangle_of_.clear();
        weights_.clear();
    }

    double worst_m = 0, sum_m = 0;

  private:
    /// Posts on an edge count for both of its triangles.
    static double weight(const std::array<mesh::LatticePoint, 3>& at,
                         const mesh::LatticePoint& post) {
        for (std::size_t i = 0; i < 3; ++i)
            if (mesh::twice_area(at[i], at[(i + 1) % 3], post) == 0) return 0.5;
        return 1;
    }

    const mesh::GridMesh& mesh_;
    const std::vector<glm::vec3>& position_m_;
    const Array2d<float>& height_m_;
    const Array2d<std::uint8_t>& roles_;
    const GroundFrame& frame_;
    std::vector<glm::dvec2> posts_;
    std::vector<double> heights_, weights_;
    std::vector<std::size_t> triangle_of_;
    std::vector<GroundFrame::Point> points_;
};

/// How far 32 bits of their coordinates move the mesh's own points.
MeshError of_points(const mesh::GridMesh& mesh, const std::vector<glm::vec3>& position_m,
                    const Array2d<float>& height_m, const GroundFrame& frame) {
    MeshError sum;
    std::vector<glm::dvec2> posts;
    std::vector<double> heights;
    std::vector<GroundFrame::Point> points;
    for (std::size_t begin = 0; begin < mesh.points.size(); begin += kPostsAtOnce) {
        const std::size_t end = std::min(mesh.points.size(), begin + kPostsAtOnce);
        posts.clear();
        heights.clear();
        for (std::size_t i = begin; i < end; ++i) {
            posts.emplace_back(mesh.points[i].column, mesh.points[i].row);
            heights.push_back(height_m.at(mesh.points[i].column, mesh.points[i].row));
        }
        points.resize(posts.size());
        frame.place(posts, heights, points);
        for (std::size_t i = begin; i < end; ++i) {
            const GroundFrame::Point& exact = points[i - begin];
            const double off_m =
                std::abs(glm::dot(glm::dvec3(position_m[i]) - exact.at_m, exact.up));
            sum.worst_m = std::max(sum.worst_m, off_m);
            sum.mean_m += off_m;
        }
    }
    return sum;
}

}  // namespace

MeshError mesh_error(const mesh::GridMesh& mesh, const std::vector<glm::vec3>& position_m,
                     const Array2d<float>& height_m, const Array2d<std::uint8_t>& roles,
                     const GroundFrame& frame) {
    const std::size_t triangles = mesh.triangles();
    const int parts =
        static_cast<int>((triangles + kTrianglesAtOnce - 1) / std::size_t{kTrianglesAtOnce});
    std::vector<MeshError> of_part(static_cast<std::size_t>(parts));
    parallel_for(0, parts, 1, [&](int first, int last) {
        for (int part = first; part < last; ++part) {
            Distances distances(mesh, position_m, height_m, roles, frame);
            const auto begin = static_cast<std::size_t>(part) * kTrianglesAtOnce;
            for (std::size_t t = begin; t < std::min(triangles, begin + kTrianglesAtOnce); ++t)
                distances.add(t);
            distances.measure();
            of_part[static_cast<std::size_t>(part)] = {distances.worst_m, distances.sum_m};
        }
    });
    MeshError error = of_points(mesh, position_m, height_m, frame);
    for (const MeshError& part : of_part) {
        error.worst_m = std::max(error.worst_m, part.worst_m);
        error.mean_m += part.mean_m;
    }
    const auto posts =
        std::ranges::count_if(roles, [](std::uint8_t role) { return (role & mesh::kGround) != 0; });
    error.mean_m /= std::max<double>(1, static_cast<double>(posts));
    return error;
}

}  // namespace relevo::output
