#pragma once

#include <cstddef>
#include <vector>

/// How lines of cells are shared out to the posts that are means of them.
namespace relevo::dem {

/// One part of a line of cells and how much of each cell lies in it: all of those inside.
struct Part {
    std::size_t first = 0;
    std::size_t count = 0;
    double first_weight = 1;
    double last_weight = 1;  // of more than one

    std::size_t end() const { return first + count; }
    double weight(std::size_t k) const {
        return k == 0 ? first_weight : k + 1 == count ? last_weight : 1.0;
    }
    double whole() const {
        return count == 1 ? first_weight
                          : first_weight + static_cast<double>(count - 2) + last_weight;
    }
};

/// The parts of a line that have cells of a piece, as the cells of one of its levels.
struct Parts {
    int first = 0;  // of them all
    std::vector<Part> parts;
};

/// Cuts a line of posts into parts of `each`, and keeps what of [first_part, end_part) lies on a
/// piece.
/// @param begin  of the line, in posts of the piece
/// @param per    cells in a post
/// @param cells  of the piece, at that level
Parts parts_within(double begin, double each, int first_part, int end_part, double per, int cells);

/// Parts that are added up at once.
struct Strip {
    std::size_t begin = 0, end = 0;    // of the parts
    std::size_t first = 0, width = 0;  // of their cells
};

/// As many parts as have so many cells, one at least.
std::vector<Strip> strips_of(const Parts& across, std::size_t most_cells);

}  // namespace relevo::dem
