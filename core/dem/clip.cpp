#include "dem/clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/placement.h"

namespace relevo::dem {
namespace {

constexpr double kOnSide = 1e-6;  // of a post: one that lies on a side is in

/// Along the sides of the unit square, once round.
std::vector<glm::dvec2> outline() {
    constexpr int kSteps = 32;
    constexpr glm::dvec2 kCorners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    std::vector<glm::dvec2> points;
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < kSteps; ++i)
            points.push_back(glm::mix(kCorners[side], kCorners[side + 1], double(i) / kSteps));
    return points;
}

struct PostRange {
    glm::dvec2 least{std::numeric_limits<double>::infinity()},
        most{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec2& point) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) return;
        least = glm::min(least, point);
        most = glm::max(most, point);
    }
};

[[noreturn]] void refuse_clip(const Grid& grid, const Clip& clip, std::string_view who) {
    PostRange range;
    const geo::Crs& crs = clip.crs.value_or(grid.crs());
    for (const glm::dvec2& at : outline()) {
        const double column = at.x * (grid.columns() - 1), row = at.y * (grid.rows() - 1);
        range.add(clip.crs ? crs.from_geodetic(grid.place(column, row))
                           : grid.affine()(column, row));
    }
    bad_input(fmt::format(
        "{}: {}: not one post of the DEM is in it; in {} they lie from {:.10g},{:.10g} to "
        "{:.10g},{:.10g}{}",
        who, clip.text, crs.name(), range.least.x, range.least.y, range.most.x, range.most.y,
        clip.crs || crs.is_geographic() ? "" : "; for degrees pass --clip-crs EPSG:4326"));
}

/// Columns and rows of a rectangle's sides, without a break where longitudes begin again.
PostRange range_of(const Grid& grid, const Clip& clip) {
    PostRange range;
    glm::dvec2 last(0.5 * (grid.columns() - 1), 0.5 * (grid.rows() - 1));
    for (const glm::dvec2& at : outline()) {
        const double x = clip.west + at.x * (clip.east - clip.west),
                     y = clip.south + at.y * (clip.north - clip.south);
        const glm::dvec2 post =
            clip.crs ? grid.post(clip.crs->to_geodetic(x, y), last) : grid.affine().inverse({x, y});
        if (std::isfinite(post.x) && std::isfinite(post.y)) last = post;
        range.add(post);
    }
    return range;
}

/// Whether one of the grid's columns is between two places, and not on one.
bool has_column(const Grid& grid, double from, double to) {
    return std::max(std::floor(from + kOnSide) + 1, 0.0) <=
           std::min(std::ceil(to - kOnSide) - 1, grid.columns() - 1.0);
}

/// Moves a range to the turn of longitude on which the grid is. @throws Error (BadInput) if a part
/// of it is at one end of the grid's rows and the rest at the other
void turn_to_grid(PostRange& range, const Grid& grid, const Clip& clip, std::string_view who) {
    const double turn = grid.turn_columns();
    if (turn == 0) return;
    if (range.most.x - range.least.x > turn - 1) {
        range.least.x = 0;
        range.most.x = grid.columns() - 1;
        return;
    }
    const double middle = 0.5 * (range.least.x + range.most.x);
    const double moved = turn * std::round((0.5 * (grid.columns() - 1) - middle) / turn);
    range.least.x += moved;
    range.most.x += moved;
    const bool is_inside = range.least.x > -1 && range.most.x < grid.columns();
    for (const double other : {-turn, turn})
        if (!is_inside && has_column(grid, range.least.x + other, range.most.x + other))
            bad_input(fmt::format(
                "{}: {}: crosses the edge of the DEM, whose rows go from {:.10g} to {:.10g} in {}; "
                "take the parts on both sides one by one",
                who, clip.text, grid.affine()(-0.5, 0).x, grid.affine()(grid.columns() - 0.5, 0).x,
                grid.crs().name()));
}

}  // namespace

Clip parse_clip(std::string_view text, std::string_view who) {
    const std::vector<std::string> pieces = split(text, ',');
    std::array<double, 4> numbers{};
    bool good = pieces.size() == numbers.size();
    for (std::size_t i = 0; good && i < numbers.size(); ++i) {
        const std::optional<double> number = parse_number(trimmed(pieces[i]));
        good = number.has_value();
        numbers[i] = number.value_or(0);
    }
    const auto [west, south, east, north] = numbers;
    if (!good || !(west < east) || !(south < north))
        bad_usage(
            fmt::format("{}: {}: expected WEST,SOUTH,EAST,NORTH, numbers of the DEM's CRS or of "
                        "--clip-crs, west less than east and south less than north",
                        who, text.empty() ? "\"\"" : text));
    return {west, south, east, north, {}, std::string(text)};
}

Window window_of(const Grid& grid, const Clip& clip, std::string_view who) {
    PostRange range = range_of(grid, clip);
    if (!(range.least.x <= range.most.x)) refuse_clip(grid, clip, who);
    turn_to_grid(range, grid, clip, who);
    const auto first = [](double least) {
        return static_cast<int>(std::ceil(std::max(least, 0.0) - kOnSide));
    };
    const auto last = [](double most, int posts) {
        return static_cast<int>(std::floor(std::min(most, posts - 1.0) + kOnSide));
    };
    if (!(range.least.x < grid.columns() && range.least.y < grid.rows()))
        refuse_clip(grid, clip, who);
    const int column = first(range.least.x), row = first(range.least.y);
    const int columns = last(range.most.x, grid.columns()) - column + 1,
              rows = last(range.most.y, grid.rows()) - row + 1;
    if (columns < 1 || rows < 1) refuse_clip(grid, clip, who);
    return {column, row, columns, rows};
}

Window crop_of(const Grid& grid, const std::string& text) {
    const Bounds edges = parse_bounds(text, "--crop");
    const Clip clip{edges.west_deg,
                    edges.south_deg,
                    edges.east_deg,
                    edges.north_deg,
                    geo::Crs::parse("EPSG:4326", "--crop"),
                    text};
    const Window window = window_of(grid, clip, "--crop");
    if (window.columns < 2 || window.rows < 2)
        bad_input(fmt::format("--crop: {}: {} x {} posts, expected 2 x 2 at least", text,
                              window.columns, window.rows));
    return window;
}

}  // namespace relevo::dem
