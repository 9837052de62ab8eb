#pragma once

#include <cmath>
#include <vector>

#include <glm/vec2.hpp>

namespace relevo::light {

/// The way of light over the posts of a grid, from a post towards the sun. On a map it is nearly
/// straight; on a grid in degrees, or far away, it is bent. After s metres of ground it is at
///     reference + first * s + second * s^2 / 2 + third * s^3 / 6   (x: column, y: row).
/// A sweep takes the rays of all posts of a tile to be this one, moved from post to post.
struct Ray {
    glm::dvec2 reference{0};         ///< the post that it goes through: whole numbers
    glm::dvec2 first{0};             ///< derivatives of its place by s: [posts / m],
    glm::dvec2 second{0}, third{0};  ///< [posts / m^2], [posts / m^3]

    /// Whether a sweep goes from column to column instead of from row to row. Right where the ray
    /// passes more columns than rows; a ray along one row can only be swept so.
    bool along_columns = false;

    /// From the reference to where it is after s metres [posts].
    glm::dvec2 way(double s) const { return ((third * (s / 6) + second * 0.5) * s + first) * s; }
    /// The integral of way() from 0 to s [posts * m].
    glm::dvec2 way_integral(double s) const {
        return ((third * (s / 24) + second / 6.0) * s + first * 0.5) * s * s;
    }
    /// After how many metres it is at a row; below 0 away from the sun. NaN where it turns back
    /// before it comes there.
    double distance_m(double row) const;
    /// The same for rows [begin, end), faster.
    std::vector<double> distances_m(int begin, int end) const;
};

/// The sun over a tile of a grid.
struct SweepSun {
    Ray ray;
    /// Of the elevation at which the sun is seen from the ray's reference, and by how much more
    /// from each further column (x) and row (y): over a round Earth, with each metre towards the
    /// sun, by the curvature of the ground less that of the line of sight.
    double tangent = 0;
    glm::dvec2 tangent_per_post{0};

    double tangent_at(double column, double row) const {
        return tangent + tangent_per_post.x * (column - ray.reference.x) +
               tangent_per_post.y * (row - ray.reference.y);
    }
};

/// The sun over a map that is true to scale.
/// @param spacing_m      from column to column (x) and from row to row (y)
/// @param direction      horizontally to the sun: a unit vector of metres along columns and rows
/// @param elevation_rad  as seen from `reference`
/// @param reference      a post
/// @param curvature      of the ground under a line of sight [1/m]: (1 - k) / R; 0: a plane
SweepSun sun_over_map(const glm::dvec2& spacing_m, const glm::dvec2& direction,
                      double elevation_rad, const glm::dvec2& reference = {0, 0},
                      double curvature = 0);

}  // namespace relevo::light
