#include "dem/lines_over.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"

namespace relevo::dem {
namespace {

constexpr double kMostBend = 0.005;   // posts between a line and its chord
constexpr double kStraightPosts = 4;  // shorter segments are not tested
constexpr int kMostHalvings = 10;
constexpr double kMargin = 64;  // posts around the DEM

bool is_finite(const glm::dvec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

}  // namespace

LinesOver::LinesOver(geo::Crs crs, const Grid& dem)
    : crs_(std::move(crs)), dem_(dem), turn_(crs_.is_geographic() ? 2 * kPi / crs_.unit_si() : 0) {}

LinesOver::Vertex LinesOver::vertex(const glm::dvec2& at, const geo::Geodetic& place,
                                    const std::optional<glm::dvec2>& near) const {
    return {at, near ? dem_.post(place, *near) : dem_.post(place), place};
}

std::vector<PlacedLine> LinesOver::placed(std::vector<glm::dvec2> vertices) const {
    // The shorter way between two longitudes.
    if (turn_ > 0)
        for (std::size_t i = 1; i < vertices.size(); ++i)
            vertices[i].x =
                vertices[i - 1].x + std::remainder(vertices[i].x - vertices[i - 1].x, turn_);
    std::vector<geo::Geodetic> places(vertices.size());
    crs_.to_geodetic(vertices, places);

    std::vector<PlacedLine> result;
    PlacedLine line;
    const auto end_line = [&] {
        if (line.posts.size() > 1) add_turns(line, result);
        line = {};
    };
    std::optional<Vertex> before;
    double along_m = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vertex here =
            vertex(vertices[i], places[i], before ? std::optional(before->post) : std::nullopt);
        if (!is_finite(here.post)) {
            end_line();
            before.reset();
            continue;
        }
        if (before) {
            const double step_m = geo::geodesic(before->place, here.place).distance_m;
            add_between(line, *before, here, along_m, along_m + step_m, 0);
            along_m += step_m;
        }
        line.posts.push_back(here.post);
        line.along_m.push_back(along_m);
        before = here;
    }
    end_line();
    return result;
}

/// Adds the vertices that a segment needs between its ends.
void LinesOver::add_between(PlacedLine& line, const Vertex& a, const Vertex& b, double from_m,
                            double to_m, int depth) const {
    const double length = distance(a.post, b.post);
    if (depth == kMostHalvings || length < kStraightPosts || !may_cross(a.post, b.post)) return;
    if (line.posts.size() > kMostPlacedVertices) return;  // too many: who reads the file refuses it
    const glm::dvec2 middle = 0.5 * (a.at + b.at);
    const Vertex between = vertex(middle, crs_.to_geodetic(middle.x, middle.y), a.post);
    if (!is_finite(between.post)) return;
    // Long segments are halved anyway: a bend may be the same on both sides of the middle.
    const bool is_long = length > 0.25 * std::max(dem_.columns(), dem_.rows());
    if (!is_long && distance(between.post, 0.5 * (a.post + b.post)) <= kMostBend) return;
    const double middle_m = 0.5 * (from_m + to_m);
    add_between(line, a, between, from_m, middle_m, depth + 1);
    line.posts.push_back(between.post);
    line.along_m.push_back(middle_m);
    add_between(line, between, b, middle_m, to_m, depth + 1);
}

/// Whether a segment, bent by half its length at most, may come near the DEM.
bool LinesOver::may_cross(const glm::dvec2& a, const glm::dvec2& b) const {
    const double around = kMargin + 0.5 * distance(a, b);
    const glm::dvec2 low = glm::min(a, b) - around, high = glm::max(a, b) + around;
    const bool at_rows = high.y >= 0 && low.y <= dem_.rows();
    return at_rows && (dem_.columns_per_turn() || (high.x >= 0 && low.x <= dem_.columns()));
}

bool LinesOver::is_near(const PlacedLine& line) const {
    glm::dvec2 low = line.posts.front(), high = low;
    for (const glm::dvec2& post : line.posts) {
        low = glm::min(low, post);
        high = glm::max(high, post);
    }
    return high.x >= -kMargin && high.y >= -kMargin && low.x <= dem_.columns() - 1 + kMargin &&
           low.y <= dem_.rows() - 1 + kMargin;
}

/// Adds a line on each turn of longitude on which it is near the DEM.
void LinesOver::add_turns(const PlacedLine& line, std::vector<PlacedLine>& to) const {
    const std::optional<int> turn = dem_.columns_per_turn();
    for (int i = turn ? -1 : 0; i <= (turn ? 1 : 0); ++i) {
        PlacedLine turned = line;
        for (glm::dvec2& post : turned.posts)
            post.x += i * turn.value_or(0);
        if (is_near(turned)) to.push_back(std::move(turned));
    }
}

}  // namespace relevo::dem
