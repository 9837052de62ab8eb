#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "ground.h"

namespace contours {

/// What a frame shows.
struct View {
    glm::dvec3 eye_m{0}, right{0}, up{0}, forward{0};
    double focal_px = 0, half_width_px = 0, half_height_px = 0;

    explicit View(const relevo_frame& frame);
    /// Pixels a metre across the view.
    double px_per_m(const glm::dvec3& at_m) const { return focal_px / dot_forward(at_m); }
    double dot_forward(const glm::dvec3& at_m) const;  ///< depth [m]
    /// Right and up from the middle of the picture; the point is in front of the eye.
    glm::dvec2 project(const glm::dvec3& at_m) const;
    /// Whether some of a sphere may be in the picture.
    bool shows(const glm::dvec3& center_m, double radius_m) const;
};

/// A place with its importance.
struct Candidate {
    const Place* place;
    double rank;  ///< lower first
};

/// Places for labels, a quadtree over the DEM's posts. Each cell has one for each index line
/// through it: places depend on the ground alone. Cells that look small are not divided, so that
/// far ground has fewer. Places of large cells have lower ranks: they stay when the camera comes
/// nearer.
class Cells {
  public:
    /// Forgets what belongs to other ground or other lines.
    void update(std::uint64_t ground, double exaggeration, double step_m);
    /// Candidates for a frame. The places live until the next call.
    std::vector<Candidate> candidates(const Ground& ground, const View& view);

  private:
    using Key = std::tuple<int, int, int>;  // size as an exponent of 2 posts, column, row
    /// A line that passes a cell.
    struct Line {
        std::vector<glm::dvec2> posts;  // on it, the nearest to the cell's middle first
        double level_m;
        /// By level of detail, once they were asked for.
        std::map<int, std::optional<Place>> places;
    };
    struct Cell {
        glm::dvec3 center_m{0};
        double radius_m = 0, side_m = 0;
        int detail = 0;  // its lines are of that level
        std::vector<Line> lines;
    };
    static const std::optional<Place>& place(const Ground& ground, Line& line, int from, int to);
    Cell make(const Ground& ground, Key key) const;
    void add_lines(const Ground& ground, Key key, Cell& cell, double& lowest_m,
                   double& highest_m) const;
    Cell& cell(const Ground& ground, Key key);
    void visit(const Ground& ground, const View& view, Key key, std::vector<Candidate>& found);

    std::map<Key, Cell> cells_;
    std::uint64_t ground_ = 0;
    double exaggeration_ = 0, step_m_ = 0;
    int root_ = 0;
};

}  // namespace contours
