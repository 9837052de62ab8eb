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

namespace relevo::dem {
namespace {

constexpr double kOnSide = 1e-6;  // of a post: one that lies on a side is in

/// Along the sides of the unit square, from corner to corner.
std::vector<glm::dvec2> outline() {
    constexpr int kSteps = 32;
    std::vector<glm::dvec2> points;
    for (int i = 0; i < kSteps; ++i) {
        const double t = double(i) / kSteps;
        for (const glm::dvec2& point : {glm::dvec2(t, 0), {1, t}, {1 - t, 1}, {0, 1 - t}})
            points.push_back(point);
    }
    return points;
}

struct Range {
    glm::dvec2 least{std::numeric_limits<double>::infinity()},
        most{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec2& point) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) return;
        least = glm::min(least, point);
        most = glm::max(most, point);
    }
};

[[noreturn]] void refuse(const Grid& grid, const Clip& clip, std::string_view who) {
    Range range;
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
    Range range;
    for (const glm::dvec2& at : outline()) {
        const double x = clip.west + at.x * (clip.east - clip.west),
                     y = clip.south + at.y * (clip.north - clip.south);
        range.add(clip.crs ? grid.post(clip.crs->to_geodetic(x, y))
                           : grid.affine().inverse({x, y}));
    }
    if (!(range.least.x <= range.most.x)) refuse(grid, clip, who);
    const auto first = [](double least) {
        return static_cast<int>(std::ceil(std::max(least, 0.0) - kOnSide));
    };
    const auto last = [](double most, int posts) {
        return static_cast<int>(std::floor(std::min(most, posts - 1.0) + kOnSide));
    };
    if (!(range.least.x < grid.columns() && range.least.y < grid.rows())) refuse(grid, clip, who);
    const int column = first(range.least.x), row = first(range.least.y);
    const int columns = last(range.most.x, grid.columns()) - column + 1,
              rows = last(range.most.y, grid.rows()) - row + 1;
    if (columns < 1 || rows < 1) refuse(grid, clip, who);
    return {column, row, columns, rows};
}

}  // namespace relevo::dem
