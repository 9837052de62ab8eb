#include "ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace contours {
namespace {

using relevo::plugin::Geo;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = 3.14159265358979323846;

/// Nodes around a line that are searched for it on the next finer level.
constexpr int kSearch = 4;
/// A line's direction is that of nodes so many levels coarser, up to so many of them away.
constexpr int kCoarser = 2, kReach = 8;
/// A line bends where it is off its direction by this fraction of the way.
constexpr double kBend = 0.5;
/// The DEM ends at least so many times as far away as a line counts as straight.
constexpr double kRim = 1.6;
/// Ground is flat where this fraction of the nodes around has the line's height ...
constexpr double kFlatFraction = 0.25, kFlat_m = 0.002;
/// ... or where it is less steep.
constexpr double kFlatSlope = 1e-4;

/// The block of nodes around a post, `reach` on each side.
Block around(const relevo::plugin::Heights& heights, glm::dvec2 post, int level, int reach) {
    const glm::dvec2 node = post / static_cast<double>(1 << level);
    return {heights, level, glm::ivec2(glm::round(node)) - reach, glm::ivec2(2 * reach + 1)};
}

/// Change of height from node to node, right and down: of the plane that fits 5 x 5 nodes best.
glm::dvec2 change_a_node(const Block& block, glm::ivec2 middle) {
    glm::dvec2 sum(0);
    for (int row = -2; row <= 2; ++row)
        for (int column = -2; column <= 2; ++column)
            sum += block.at(middle.x + column, middle.y + row) * glm::dvec2(column, row);
    return sum / 50.0;  // the sum of the squares of the columns, and of the rows
}

/// How far a line is straight, in nodes. @param change  of the height a node
/// @param last    node of the DEM
double straight_nodes(const Block& block, glm::dvec2 node, double level_m, glm::dvec2 change,
                      glm::dvec2 last) {
    const double steep = length(change);
    const glm::dvec2 along = glm::dvec2(-change.y, change.x) / steep;
    for (int away = 1; away < kReach; ++away)
        for (const double side : {-1.0, 1.0}) {
            const glm::dvec2 at = node + side * away * along;
            const double off_m = block.between(at) - level_m;
            const glm::dvec2 end = node + side * kRim * away * along;
            const bool is_outside =
                any(lessThan(end, glm::dvec2(0))) || any(greaterThan(end, last));
            if (is_outside || !(std::abs(off_m) <= steep * std::max(kBend * away, 1.0)))
                return away - 1;
        }
    return kReach - 1;
}

glm::dvec3 vector_of(const Geo::Point& point) {
    return {point[0], point[1], point[2]};
}

}  // namespace

double Block::between(glm::dvec2 node) const {
    const glm::dvec2 inside = node - glm::dvec2(first_);
    const glm::dvec2 low = glm::floor(inside), share = inside - low;
    const int column = static_cast<int>(low.x), row = static_cast<int>(low.y);
    if (column < 0 || row < 0 || column + 1 >= size_.x || row + 1 >= size_.y) return kNaN;
    return glm::mix(glm::mix(at(column, row), at(column + 1, row), share.x),
                    glm::mix(at(column, row + 1), at(column + 1, row + 1), share.x), share.y);
}

std::optional<glm::dvec3> Ground::local(glm::dvec2 post, double height_m) const {
    const auto place = geo_.from_post({post.x, post.y});
    if (!place) return std::nullopt;
    return vector_of(geo_.to_local({(*place)[0], (*place)[1], height_m * exaggeration_}));
}

std::optional<glm::dvec2> Ground::nearest_crossing(glm::dvec2 post, double level_m,
                                                   int level) const {
    const Block block = around(heights_, post, level, kSearch);
    const glm::dvec2 wanted = post / static_cast<double>(1 << level) - glm::dvec2(block.first());
    const glm::dvec2 last(nodes(level) - 1);
    std::optional<glm::dvec2> nearest;
    double least = kSearch * kSearch;
    each_edge(block, [&](double a, double b, int column, int row, glm::ivec2 way) {
        if (!((a < level_m) != (b < level_m)) || std::isnan(a) || std::isnan(b)) return;
        const glm::dvec2 at = glm::dvec2(column, row) + (level_m - a) / (b - a) * glm::dvec2(way);
        const double away = dot(at - wanted, at - wanted);
        const glm::dvec2 node = at + glm::dvec2(block.first());
        // Nodes beyond the rim repeat it.
        if (away >= least || std::min(node.x, node.y) < 0 || any(greaterThan(node, last))) return;
        least = away;
        nearest = node * static_cast<double>(1 << level);
    });
    return nearest;
}

bool Ground::is_flat(glm::dvec2 post, double level_m, int level) const {
    const Block block = around(heights_, post, level, 3);
    int flat = 0;
    for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 7; ++column)
            flat += std::abs(block.at(column, row) - level_m) < kFlat_m ? 1 : 0;
    return flat > kFlatFraction * 49;
}

/// Fills what depends on where the local frame's axes are here.
/// @param change_a_post  of the height, right and down
bool Ground::set_axes(Place& place, glm::dvec2 post, glm::dvec2 change_a_post) const {
    const auto at = geo_.from_post({post.x, post.y});
    const auto right = local(post + glm::dvec2(1, 0), place.level_m);
    const auto down = local(post + glm::dvec2(0, 1), place.level_m);
    if (!at || !right || !down) return false;
    place.lat_deg = (*at)[0];
    place.lon_deg = (*at)[1];
    const double height_m = place.level_m * exaggeration_;
    const auto point = [&](double lat_deg, double above_m) {
        return vector_of(geo_.to_local({lat_deg, place.lon_deg, height_m + above_m}));
    };
    place.at_m = point(place.lat_deg, 0);
    place.up = normalize(point(place.lat_deg, 1000) - place.at_m);
    // Towards the equator, so that there is such a place at the poles.
    const double step_deg = place.lat_deg > 0 ? -1e-3 : 1e-3;
    const glm::dvec3 north =
        normalize((point(place.lat_deg + step_deg, 0) - place.at_m) / step_deg);
    const glm::dvec3 east = cross(north, place.up);
    // The vector whose products with both steps are the changes of height.
    const glm::dvec3 x = *right - place.at_m, y = *down - place.at_m;
    const double xx = dot(x, x), xy = dot(x, y), yy = dot(y, y);
    const double det = xx * yy - xy * xy;
    if (!(det > 1e-9 * xx * yy)) return false;
    const glm::dvec3 gradient = ((yy * change_a_post.x - xy * change_a_post.y) * x +
                                 (xx * change_a_post.y - xy * change_a_post.x) * y) /
                                det;
    place.slope = length(gradient);
    if (!(place.slope > kFlatSlope)) return false;
    place.uphill = gradient / place.slope;
    place.along = cross(place.up, place.uphill);
    place.azimuth_deg = std::atan2(dot(place.along, east), dot(place.along, north)) * 180 / kPi;
    place.straight_m *= std::sqrt(std::sqrt(det));
    return true;
}

std::optional<Place> Ground::place(glm::dvec2 post, double level_m, int from, int to) const {
    std::optional<glm::dvec2> at = post;
    for (int level = from - 1; level >= to && at; --level)
        at = nearest_crossing(*at, level_m, level);
    if (!at || is_flat(*at, level_m, to)) return std::nullopt;
    const int coarse = std::min(to + kCoarser, levels() - 1);
    const double posts_a_node = 1 << coarse;
    const Block block = around(heights_, *at, coarse, kReach + 2);
    const glm::dvec2 change = change_a_node(block, glm::ivec2(kReach + 2));
    if (!(length(change) > 0)) return std::nullopt;  // a void, too
    const glm::dvec2 node = *at / posts_a_node;
    // The line is followed on coarser nodes, where it runs at another height than at `at`.
    const double here_m = block.between(node);
    Place place{.level_m = level_m};
    place.straight_m =
        posts_a_node * straight_nodes(block, node, here_m, change, nodes(coarse) - 1);
    if (place.straight_m <= 0 || !set_axes(place, *at, change / posts_a_node)) return std::nullopt;
    return place;
}

}  // namespace contours
