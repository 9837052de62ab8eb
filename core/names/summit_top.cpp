#include "names/summit_top.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/glm.hpp>

namespace relevo::names {
namespace {

constexpr double kStart_m = 100;          ///< the ascent begins at the highest post so near
constexpr double kNear_m = 150;           ///< least reach of the ascent
constexpr double kFar_m = 600;            ///< its reach from a coarse entry
constexpr double kHeightError_m = 60;     ///< of a coarse entry
constexpr double kCoarsestPosts_m = 200;  ///< that show tops
constexpr int kMostStart = 64;            ///< posts each way, where meridians meet

bool is_coarse(const Entry& entry) {
    return entry.source == 'N' || entry.source == 'O';
}

Summit unmoved(const Entry& entry) {
    Summit summit{.entry = &entry, .place = entry.place};
    if (entry.size) summit.height_m = *entry.size;
    return summit;
}

/// The posts around a place.
class Hill {
  public:
    Hill(const dem::Grid& grid, const geo::Geodetic& place, const PostHeight& height_m)
        : height_m_(height_m), post_(grid.post(place)), nearest_(glm::round(post_)) {
        const geo::Geodetic here = grid.place(post_.x, post_.y);
        column_m_ = step_m(here, grid.place(post_.x + 1, post_.y));
        row_m_ = step_m(here, grid.place(post_.x, post_.y + 1));
    }

    double spacing_m() const { return std::max(glm::length(column_m_), glm::length(row_m_)); }
    double height_m(const glm::ivec2& post) const { return height_m_(post.x, post.y); }
    double distance_m(const glm::ivec2& post) const {
        return glm::length(offset_m(glm::dvec2(post) - post_));
    }

    /// The highest post within kStart_m, else the nearest one.
    glm::ivec2 start() const {
        glm::ivec2 best = nearest_;
        const auto reach = [](const glm::dvec2& step_m) {
            return static_cast<int>(
                std::min<double>(kMostStart, kStart_m / glm::length(step_m) + 1));
        };
        const glm::ivec2 most(reach(column_m_), reach(row_m_));
        for (int row = -most.y; row <= most.y; ++row)
            for (int column = -most.x; column <= most.x; ++column) {
                const glm::ivec2 post = nearest_ + glm::ivec2(column, row);
                const bool is_higher =
                    std::isnan(height_m(best)) || height_m(post) > height_m(best);
                if (is_higher && distance_m(post) <= kStart_m) best = post;
            }
        return best;
    }

    /// The local top above a post; nullopt beyond `most_m` of the place, and next to ground without
    /// a height, which may be higher.
    std::optional<glm::ivec2> top(glm::ivec2 post, double most_m) const {
        for (;;) {
            if (!(distance_m(post) <= most_m)) return std::nullopt;
            double steepest = 0;
            glm::ivec2 next = post;
            for (int row = -1; row <= 1; ++row)
                for (int column = -1; column <= 1; ++column) {
                    if (column == 0 && row == 0) continue;
                    const double rise_m = height_m(post + glm::ivec2(column, row)) - height_m(post);
                    if (std::isnan(rise_m)) return std::nullopt;
                    const double slope = rise_m / glm::length(offset_m({column, row}));
                    if (slope > steepest) {
                        steepest = slope;
                        next = post + glm::ivec2(column, row);
                    }
                }
            if (next == post) return post;
            post = next;
        }
    }

  private:
    static glm::dvec2 step_m(const geo::Geodetic& from, const geo::Geodetic& to) {
        const geo::Geodesic way = geo::geodesic(from, to);
        return way.distance_m * glm::dvec2(std::sin(way.azimuth_rad), std::cos(way.azimuth_rad));
    }
    glm::dvec2 offset_m(const glm::dvec2& posts) const {
        return posts.x * column_m_ + posts.y * row_m_;
    }

    const PostHeight& height_m_;
    glm::dvec2 post_;
    glm::ivec2 nearest_;
    glm::dvec2 column_m_, row_m_;  // east and north, from post to post
};

}  // namespace

bool is_on(const dem::Grid& grid, const geo::Geodetic& place) {
    const glm::dvec2 post = grid.post(place);
    return post.x > -0.5 && post.y > -0.5 && post.x < grid.columns() - 0.5 &&
           post.y < grid.rows() - 0.5;
}

std::string label(const Summit& summit) {
    if (!summit.height_m) return std::string(summit.entry->name);
    return fmt::format("{} {}{:.0f} m", summit.entry->name, summit.height_is_of_dem ? "~" : "",
                       *summit.height_m);
}

Summit on_top(const Entry& entry, const dem::Grid& grid, const PostHeight& height_m) {
    Summit summit = unmoved(entry);
    const Hill hill(grid, entry.place, height_m);
    if (!(hill.spacing_m() <= kCoarsestPosts_m)) return summit;
    const double reach_m = is_coarse(entry) ? kFar_m : std::max(kNear_m, 2 * hill.spacing_m());
    const std::optional<glm::ivec2> top = hill.top(hill.start(), reach_m);
    if (!top) return summit;
    const double top_m = hill.height_m(*top);
    if (is_coarse(entry) && !(entry.size && std::abs(top_m - *entry.size) < kHeightError_m))
        return summit;
    summit.place = grid.place(top->x, top->y);
    summit.is_moved = true;
    summit.height_is_of_dem = !summit.height_m;
    if (!summit.height_m) summit.height_m = top_m;
    return summit;
}

std::vector<Summit> summits_on(const Gazetteer& gazetteer, const dem::Grid& grid,
                               const PostHeight& height_m, const Near& near) {
    std::vector<Summit> summits;
    for (const Entry* const entry : gazetteer.within(Kind::Summit, near))
        if (is_on(grid, entry->place)) summits.push_back(on_top(*entry, grid, height_m));
    // A top has one name: that with a height, else the nearest.
    std::map<std::pair<double, double>, Summit*> tops;
    const auto rank = [](const Summit& summit) {
        return std::pair(!summit.entry->size,
                         geo::geodesic(summit.entry->place, summit.place).distance_m);
    };
    for (Summit& summit : summits) {
        if (!summit.is_moved) continue;
        Summit*& owner = tops[{summit.place.lat_rad, summit.place.lon_rad}];
        if (!owner) owner = &summit;
        if (owner == &summit) continue;
        Summit* other = &summit;
        if (rank(*other) < rank(*owner)) std::swap(owner, other);
        *other = unmoved(*other->entry);
    }
    return summits;
}

Near around(const dem::Grid& grid) {
    // Corners of a grid in degrees may lie farther out than its middle row and column suggest.
    constexpr double kMargin = 1.1;
    const geo::Geodetic centre = grid.center();
    double radius_m = glm::length(grid.sides_m()) / 2;
    for (const double row : {0.0, grid.rows() - 1.0})
        for (const double column : {0.0, grid.columns() - 1.0}) {
            const geo::Geodetic corner = grid.place(column, row);
            if (!std::isnan(corner.lat_rad))
                radius_m = std::max(radius_m, geo::geodesic(centre, corner).distance_m);
        }
    return {centre, kMargin * radius_m};
}

}  // namespace relevo::names
