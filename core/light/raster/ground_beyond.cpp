#include "light/raster/ground_beyond.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace relevo::light {
namespace {

constexpr float kNowhere_m = -std::numeric_limits<float>::infinity();

glm::dvec2 turned(const glm::dvec2& v, bool along_columns) {
    return along_columns ? glm::dvec2(v.y, v.x) : v;
}

}  // namespace

GroundBeyond::GroundBeyond(const dem::Posts& posts, const SunTile& tile, double reach_m)
    : ray_(tile.ray), along_columns_(tile.ray.along_columns) {
    for (glm::dvec2* const each : {&ray_.reference, &ray_.first, &ray_.second, &ray_.third})
        *each = turned(*each, along_columns_);
    const Window& w = tile.posts.window;
    first_row_ = along_columns_ ? w.column : w.row;
    const int rows = along_columns_ ? w.columns : w.rows;
    std::vector<double> shifts;
    for (const double s : ray_.distances_m(first_row_, first_row_ + rows)) {
        row_distance_m_.push_back(static_cast<float>(s));
        shifts.push_back(ray_.reference.x + ray_.way(s).x);
    }
    double begin_m = std::numeric_limits<double>::infinity(), end_m = -begin_m;
    double first = begin_m, last = -begin_m;
    for (const SunTile::Mark& mark : tile.marks) {
        const glm::dvec2 post = turned(mark.post, along_columns_);
        const double s = ray_.distance_m(post.y);
        if (std::isnan(s)) continue;
        const double line = post.x - ray_.reference.x - ray_.way(s).x;
        begin_m = std::min(begin_m, s), end_m = std::max(end_m, s);
        first = std::min(first, line), last = std::max(last, line);
    }
    line_column_.reserve(shifts.size());
    if (!(first <= last)) {
        line_column_.assign(shifts.size(), std::numeric_limits<int>::max());
        return;
    }
    // No farther than the grid goes, be rays bent.
    const Window all{0, 0, posts.grid().columns(), posts.grid().rows()};
    double out_m = -end_m;
    for (const SunTile::Mark& mark : tile.marks)
        out_m = std::max(out_m, ray_.distance_m(turned(mark.post, along_columns_).y) +
                                    1.1 * way_in(all, mark.post, tile.ray.first));
    // Rays are bent between the marks.
    const int beside = 8 + static_cast<int>((last - first) / 32);
    const int step = posts.thinning();
    const double step_m = step / std::max(std::abs(ray_.first.x), std::abs(ray_.first.y));
    const double until_m = std::min(end_m + reach_m, out_m + beside * step_m);
    first_line_ = static_cast<int>(std::floor(first)) - beside;
    // A ray that has turned back meets no edge.
    for (const double shift : shifts)
        line_column_.push_back(std::isnan(shift)
                                   ? std::numeric_limits<int>::max()
                                   : static_cast<int>(std::ceil(shift - 0.5)) + first_line_);
    const int lines = static_cast<int>(std::ceil(last)) + beside + 1 - first_line_;
    for (int line = 0; line < lines; line += step) {
        const int middle = std::min(line + step / 2, lines - 1);
        const Edge edge = edge_of(posts, first_line_ + middle, begin_m - step_m, until_m, step_m);
        const auto end = static_cast<std::size_t>(std::min(line + step, lines));
        height_m_.resize(end, static_cast<float>(edge.height_m));
        distance_m_.resize(end, static_cast<float>(edge.distance_m));
    }
}

/// The last ground of a line: looked for from where no line is on the grid any more.
Edge GroundBeyond::edge_of(const dem::Posts& posts, double line, double begin_m, double end_m,
                           double step_m) const {
    std::array<std::pair<double, double>, EdgeFinder::kHeights> last;
    std::size_t count = 0;
    for (double s = end_m; s >= begin_m && count < last.size(); s -= step_m) {
        const glm::dvec2 post =
            turned(ray_.reference + glm::dvec2(line, 0) + ray_.way(s), along_columns_);
        if (!is_on(posts.grid(), post)) continue;
        const double height_m = height_near(posts, post);
        if (!std::isnan(height_m)) last[count++] = {s, height_m};
    }
    EdgeFinder finder;
    while (count > 0) {
        --count;
        finder.add(last[count].first, last[count].second);
    }
    return finder.edge().value_or(Edge{-std::numeric_limits<double>::infinity(), kNowhere_m});
}

void GroundBeyond::find(int row, int column, int count, float* height_m, float* distance_m) const {
    const int lines = static_cast<int>(height_m_.size());
    auto k = static_cast<std::size_t>((along_columns_ ? column : row) - first_row_);
    if (!along_columns_) {
        // The lines of posts next to each other are, too.
        const std::ptrdiff_t line = std::ptrdiff_t{column} - line_column_[k];
        const auto begin = std::clamp<std::ptrdiff_t>(-line, 0, count),
                   end = std::clamp<std::ptrdiff_t>(lines - line, begin, count);
        std::fill_n(distance_m, count, kNowhere_m);
        std::fill_n(height_m, count, kNowhere_m);
        for (std::ptrdiff_t i = begin; i < end; ++i) {
            height_m[i] = height_m_[static_cast<std::size_t>(line + i)];
            distance_m[i] = distance_m_[static_cast<std::size_t>(line + i)] - row_distance_m_[k];
        }
        return;
    }
    for (int i = 0; i < count; ++i, ++k) {
        const int line = row - line_column_[k];
        const bool has = line >= 0 && line < lines;
        const auto at = static_cast<std::size_t>(has ? line : 0);
        height_m[i] = has ? height_m_[at] : kNowhere_m;
        distance_m[i] = has ? distance_m_[at] - row_distance_m_[k] : kNowhere_m;
    }
}

}  // namespace relevo::light
