#include "cells.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace contours {
namespace {

/// Nodes along a side of a cell, as an exponent of 2; the least side of a cell in posts, the same.
constexpr int kNodes = 5, kLeast = 1;
/// Cells are divided while they look larger.
constexpr double kCell_px = 90;
/// Parts along each side of a cell, in each of which a place is tried.
constexpr int kParts = 4;
/// The largest cells are always divided: the Earth's curvature makes their spheres wrong.
constexpr int kAlways = 2;
/// Nodes of a place's level are up to so many pixels apart.
constexpr double kNode_px = 2;
constexpr std::size_t kMostCells = 50'000;

/// 0 to 1, the same for the same cell and line.
double fraction_of(int column, int row, double level_m) {
    auto bits = static_cast<std::uint32_t>(column) * 0x9e3779b1U ^
                static_cast<std::uint32_t>(row) * 0x85ebca77U ^
                static_cast<std::uint32_t>(std::llround(level_m)) * 0xc2b2ae3dU;
    bits ^= bits >> 15;
    bits *= 0x2c1b3c6dU;
    bits ^= bits >> 13;
    return static_cast<double>(bits & 0xffff) / 65536;
}

glm::dvec3 vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

}  // namespace

View::View(const relevo_frame& frame)
    : eye_m(vector_of(frame.eye_m)),
      right(vector_of(frame.right)),
      up(vector_of(frame.up)),
      forward(vector_of(frame.forward)),
      focal_px(0.5 * frame.height_px / std::tan(0.5 * frame.fov_y_rad)),
      half_width_px(0.5 * frame.width_px),
      half_height_px(0.5 * frame.height_px) {}

double View::dot_forward(const glm::dvec3& at_m) const {
    return dot(at_m - eye_m, forward);
}

glm::dvec2 View::project(const glm::dvec3& at_m) const {
    const glm::dvec3 from_eye = at_m - eye_m;
    return focal_px / dot(from_eye, forward) * glm::dvec2(dot(from_eye, right), dot(from_eye, up));
}

bool View::shows(const glm::dvec3& center_m, double radius_m) const {
    const glm::dvec3 from_eye = center_m - eye_m;
    const double x = std::abs(dot(from_eye, right)), y = std::abs(dot(from_eye, up));
    const double z = dot(from_eye, forward);
    // Distances from the planes of the picture's sides.
    const auto beyond = [&](double aside, double half_px) {
        return (aside * focal_px - z * half_px) / std::hypot(focal_px, half_px);
    };
    return z > -radius_m && beyond(x, half_width_px) < radius_m &&
           beyond(y, half_height_px) < radius_m;
}

void Cells::update(std::uint64_t ground, double exaggeration, double step_m) {
    if (ground == ground_ && exaggeration == exaggeration_ && step_m == step_m_ &&
        cells_.size() < kMostCells)
        return;
    cells_.clear();
    ground_ = ground;
    exaggeration_ = exaggeration;
    step_m_ = step_m;
}

/// Adds each index line, with places in several parts of the cell.
void Cells::add_lines(const Ground& ground, Key key, Cell& cell, double& lowest_m,
                      double& highest_m) const {
    const auto [size, column, row] = key;
    cell.detail = std::clamp(size - kNodes, 0, ground.levels() - 1);
    const int nodes = 1 << (size - cell.detail);
    const glm::ivec2 first = nodes * glm::ivec2(column, row);
    const Block block(ground.heights(), cell.detail, first,
                      glm::min(glm::ivec2(nodes + 1), ground.nodes(cell.detail) - first));
    // By index of the line and part of the cell: the crossing nearest to the cell's middle.
    std::map<std::pair<double, int>, std::pair<double, glm::dvec2>> nearest;
    each_edge(block, [&](double a, double b, int x, int y, glm::ivec2 way) {
        if (std::isnan(a)) return;
        lowest_m = std::min(lowest_m, a);
        highest_m = std::max(highest_m, a);
        if (std::isnan(b)) return;
        const double index = std::floor(std::max(a, b) / step_m_);
        // Lines at or below 0 m are in the sea, or its shore.
        if (index < 1 || std::floor(std::min(a, b) / step_m_) != index - 1) return;
        const glm::dvec2 at = glm::dvec2(x, y) + (index * step_m_ - a) / (b - a) * glm::dvec2(way);
        const int part = kParts * (y * kParts / (nodes + 1)) + x * kParts / (nodes + 1);
        const double away = distance(at, glm::dvec2(0.5 * nodes));
        const auto [known, is_new] = nearest.try_emplace({index, part}, away, at);
        if (!is_new && away < known->second.first) known->second = {away, at};
    });
    std::map<double, std::vector<std::pair<double, glm::dvec2>>> lines;
    for (const auto& [line, crossing] : nearest)
        lines[line.first].push_back(crossing);
    for (auto& [index, crossings] : lines) {
        std::ranges::sort(crossings, {}, [](const auto& crossing) { return crossing.first; });
        Line line{{}, index * step_m_, {}};
        for (const auto& [away, at] : crossings)
            line.posts.push_back(glm::min((at + glm::dvec2(first)) * std::exp2(cell.detail),
                                          glm::dvec2(ground.posts() - 1)));
        cell.lines.push_back(std::move(line));
    }
}

Cells::Cell Cells::make(const Ground& ground, Key key) const {
    const auto [size, column, row] = key;
    Cell cell;
    double lowest_m = 1e9, highest_m = -1e9;
    add_lines(ground, key, cell, lowest_m, highest_m);
    if (lowest_m > highest_m) return cell;  // no ground
    const double posts = 1 << size;
    const glm::dvec2 low = posts * glm::dvec2(column, row);
    const glm::dvec2 high = glm::min(low + posts, glm::dvec2(ground.posts() - 1));
    const auto middle = ground.local(0.5 * (low + high), 0.5 * (lowest_m + highest_m));
    if (!middle) return cell;
    cell.center_m = *middle;
    for (const glm::dvec2& corner :
         {low, high, glm::dvec2(low.x, high.y), glm::dvec2(high.x, low.y)})
        for (const double height_m : {lowest_m, highest_m})
            if (const auto at = ground.local(corner, height_m))
                cell.radius_m = std::max(cell.radius_m, distance(*at, *middle));
    const auto left = ground.local({low.x, 0.5 * (low.y + high.y)}, lowest_m);
    const auto right = ground.local({high.x, 0.5 * (low.y + high.y)}, lowest_m);
    cell.side_m = left && right ? distance(*left, *right) : cell.radius_m;
    return cell;
}

Cells::Cell& Cells::cell(const Ground& ground, Key key) {
    const auto known = cells_.find(key);
    if (known != cells_.end()) return known->second;
    return cells_.emplace(key, make(ground, key)).first->second;
}

/// The first good place of a line, at a level of detail.
const std::optional<Place>& Cells::place(const Ground& ground, Line& line, int from, int to) {
    const auto known = line.places.find(to);
    if (known != line.places.end()) return known->second;
    std::optional<Place>& place = line.places[to];
    for (std::size_t i = 0; i < line.posts.size() && !place; ++i)
        place = ground.place(line.posts[i], line.level_m, from, to);
    return place;
}

void Cells::visit(const Ground& ground, const View& view, Key key, std::vector<Candidate>& found) {
    const auto [size, column, row] = key;
    const glm::ivec2 first = (1 << size) * glm::ivec2(column, row);
    if (first.x >= ground.posts().x - 1 || first.y >= ground.posts().y - 1) return;
    Cell& here = cell(ground, key);
    if (here.radius_m <= 0) return;
    const bool is_large = size > root_ - kAlways;
    if (!is_large && !view.shows(here.center_m, here.radius_m)) return;
    for (Line& line : here.lines) {
        const double posts = 1 << size;
        const double px_per_m = view.px_per_m(here.center_m);
        if (!(px_per_m > 0)) continue;
        // The coarsest level whose nodes are near enough to each other in the picture.
        const double posts_a_px = posts / (here.side_m * px_per_m);
        const int wanted = static_cast<int>(std::floor(std::log2(kNode_px * posts_a_px)));
        const int detail = std::clamp(wanted, 0, here.detail);
        if (const std::optional<Place>& found_place = place(ground, line, here.detail, detail))
            found.push_back({&*found_place, root_ - size + fraction_of(column, row, line.level_m)});
    }
    const double nearest_m =
        std::max(distance(here.center_m, view.eye_m) - here.radius_m, 1e-3 * here.side_m);
    if (size <= kLeast || (!is_large && here.side_m * view.focal_px / nearest_m < kCell_px)) return;
    for (const glm::ivec2& child : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}})
        visit(ground, view, {size - 1, 2 * column + child.x, 2 * row + child.y}, found);
}

std::vector<Candidate> Cells::candidates(const Ground& ground, const View& view) {
    root_ = kLeast;
    while ((1 << root_) < std::max(ground.posts().x, ground.posts().y))
        ++root_;
    std::vector<Candidate> found;
    visit(ground, view, {root_, 0, 0}, found);
    return found;
}

}  // namespace contours
