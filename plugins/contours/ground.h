#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <relevo/plugin.hpp>

namespace contours {

/// A place on a contour line where a label may stand.
struct Place {
    double lat_deg = 0, lon_deg = 0, level_m = 0;
    double azimuth_deg = 0;                 ///< along the line
    glm::dvec3 at_m{0};                     ///< in the local frame, exaggerated
    glm::dvec3 up{0}, along{0}, uphill{0};  ///< unit vectors
    double slope = 0;                       ///< metres of height a metre uphill, not exaggerated
    double straight_m = 0;                  ///< how far the line is straight on either side
};

/// Heights of a rectangle of nodes.
class Block {
  public:
    Block(const relevo::plugin::Heights& heights, int level, glm::ivec2 first, glm::ivec2 size)
        : first_(first),
          size_(size),
          heights_m_(heights.read(level, first.x, first.y, size.x, size.y)) {}

    glm::ivec2 first() const { return first_; }
    glm::ivec2 size() const { return size_; }
    double at(int column, int row) const {
        return static_cast<double>(heights_m_[static_cast<std::size_t>(row * size_.x + column)]);
    }
    /// Bilinear. @param node  of the level, within the block; NaN outside
    double between(glm::dvec2 node) const;

  private:
    glm::ivec2 first_, size_;
    std::vector<float> heights_m_;
};

/// The DEM's ground. Posts are (column, row), and need not be whole.
class Ground {
  public:
    /// To be made in each frame.
    Ground(const relevo::plugin::Heights& heights, const relevo::plugin::Geo& geo,
           double exaggeration)
        : heights_(heights), geo_(geo), about_(heights.describe()), exaggeration_(exaggeration) {}

    glm::ivec2 posts() const { return {about_.columns, about_.rows}; }
    int levels() const { return about_.levels; }
    /// Columns and rows of nodes of a level of detail.
    glm::ivec2 nodes(int level) const { return (posts() - 2) / (1 << level) + 2; }
    const relevo::plugin::Heights& heights() const { return heights_; }

    /// A point above a post; nullopt where the DEM's map has no such place.
    std::optional<glm::dvec3> local(glm::dvec2 post, double height_m) const;

    /// The place on a contour near a post, on the nodes of a level of detail.
    /// @param from  the level of detail at which the line passes `post`
    /// @returns nullopt where a label would not be good: the line bends, the ground is flat or a
    ///     void, or finer nodes have no such line here
    std::optional<Place> place(glm::dvec2 post, double level_m, int from, int to) const;

  private:
    std::optional<glm::dvec2> nearest_crossing(glm::dvec2 post, double level_m, int level) const;
    bool is_flat(glm::dvec2 post, double level_m, int level) const;
    bool set_axes(Place& place, glm::dvec2 post, glm::dvec2 change_a_post) const;

    const relevo::plugin::Heights& heights_;
    const relevo::plugin::Geo& geo_;
    relevo_heights about_;
    double exaggeration_;
};

/// Calls body(a, b, node) for the crossings of edges between neighbouring nodes with a level: where
/// it is, in nodes of the block.
template <typename Body>
void each_edge(const Block& block, const Body& body) {
    const glm::ivec2 size = block.size();
    for (int row = 0; row < size.y; ++row)
        for (int column = 0; column < size.x; ++column) {
            const double here = block.at(column, row);
            if (column + 1 < size.x)
                body(here, block.at(column + 1, row), column, row, glm::ivec2(1, 0));
            if (row + 1 < size.y)
                body(here, block.at(column, row + 1), column, row, glm::ivec2(0, 1));
        }
}

}  // namespace contours
