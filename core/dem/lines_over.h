#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "dem/grid.h"
#include "dem/lines.h"

namespace relevo::dem {

/// Places lines of a CRS on a DEM's grid, as read_lines() describes.
class LinesOver {
  public:
    /// @param dem  must outlive this
    LinesOver(geo::Crs crs, const Grid& dem);

    /// Posts and distances of a line, which may be several: it is cut where it has no place. Lines
    /// that are not near the DEM are omitted.
    /// @param vertices  coordinates of the CRS, two or more
    std::vector<PlacedLine> placed(std::vector<glm::dvec2> vertices) const;

  private:
    struct Vertex {
        glm::dvec2 at, post;
        geo::Geodetic place;
    };
    Vertex vertex(const glm::dvec2& at, const geo::Geodetic& place,
                  const std::optional<glm::dvec2>& near) const;
    void add_between(PlacedLine& line, const Vertex& a, const Vertex& b, double from_m, double to_m,
                     int depth) const;
    bool may_cross(const glm::dvec2& a, const glm::dvec2& b) const;
    void add_turns(const PlacedLine& line, std::vector<PlacedLine>& to) const;
    bool is_near(const PlacedLine& line) const;

    geo::Crs crs_;
    const Grid& dem_;
    double turn_;  // units of a turn of longitude; 0: projected
};

}  // namespace relevo::dem
