#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "dem/lines.h"

namespace relevo::render {

/// A straight segment in place of the vertices from `first` to `last` of a piece.
struct LinePart {
    std::uint32_t piece = 0, first = 0, last = 0;
};

struct LineBox {
    glm::dvec2 low, high;
};

/// The part of a segment in a box, as fractions of the segment; nullopt if it is outside.
std::optional<std::pair<double, double>> clipped(const glm::dvec2& a, const glm::dvec2& b,
                                                 const LineBox& box);

/// Lines near a DEM, cut where they leave it, for make_line_index(). Coordinates are posts.
class LinePieces {
  public:
    /// @param lines       must outlive this
    /// @param size_posts  columns and rows of the DEM; lines more than 64 posts away are dropped
    LinePieces(const std::vector<dem::PlacedLine>& lines, const glm::ivec2& size_posts);

    const std::vector<LinePart>& all() const { return all_; }
    std::size_t segments() const { return importance_.size() - pieces_.size(); }
    const glm::dvec2& low() const { return low_; }  ///< of the box around all vertices
    const glm::dvec2& high() const { return high_; }

    const glm::dvec2& first(const LinePart& part) const { return vertex(part.piece, part.first); }
    const glm::dvec2& last(const LinePart& part) const { return vertex(part.piece, part.last); }
    int number(const LinePart& part) const { return line(part).number; }
    /// Metres along the line, at a fraction of a part.
    double along_m(const LinePart& part, double fraction) const;

    /// All segments of the lines that pass a box; nullopt for more than `most`.
    std::optional<std::vector<LinePart>> exact(const std::vector<LinePart>& parts,
                                               const LineBox& box, std::size_t most) const;
    /// Parts that are no farther than `tolerance` from the lines, and pass a box.
    std::vector<LinePart> refined(const std::vector<LinePart>& parts, const LineBox& box,
                                  double tolerance) const;

  private:
    struct Piece {
        std::uint32_t line, first, count;  // vertices of a line
        std::size_t importance;            // of its first vertex
    };
    void add(std::uint32_t line, std::uint32_t first, std::uint32_t count);
    const glm::dvec2& vertex(std::uint32_t piece, std::uint32_t i) const {
        return lines_[pieces_[piece].line].posts[pieces_[piece].first + i];
    }
    const dem::PlacedLine& line(const LinePart& part) const {
        return lines_[pieces_[part.piece].line];
    }
    void rate(const Piece& piece);
    void rate(const Piece& piece, std::uint32_t first, std::uint32_t last);

    const std::vector<dem::PlacedLine>& lines_;
    std::vector<Piece> pieces_;
    std::vector<LinePart> all_;
    std::vector<float> importance_;  // simplified lines have vertices of more than the tolerance
    glm::dvec2 low_{1e30}, high_{-1e30};
};

}  // namespace relevo::render
