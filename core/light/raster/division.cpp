#include "light/raster/division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::light {
namespace {

constexpr int kLeastWindow = 2;  // posts a side
constexpr int kLeastWidth = 6;   // posts across a tile between rays

std::array<Window, 2> halves(const Window& window, bool of_columns) {
    std::array<Window, 2> halves{window, window};
    int Window::*const first = of_columns ? &Window::column : &Window::row;
    int Window::*const count = of_columns ? &Window::columns : &Window::rows;
    halves[0].*count = window.*count / 2;
    halves[1].*first += halves[0].*count;
    halves[1].*count -= halves[0].*count;
    return halves;
}

/// The posts of a tile within as small a window as has them; none: it has no posts.
std::optional<TilePosts> trimmed(TilePosts posts, bool along_columns) {
    const auto ranges = ranges_of(posts, along_columns);
    if (!ranges) return std::nullopt;
    int line = -1, last_line = -1, begin = 0, end = 0;
    for (int i = 0; i < static_cast<int>(ranges->size()); ++i) {
        const auto& [from, to] = (*ranges)[static_cast<std::size_t>(i)];
        if (from >= to) continue;
        if (line < 0) line = i, begin = from, end = to;
        last_line = i, begin = std::min(begin, from), end = std::max(end, to);
    }
    Window& w = posts.window;
    if (line < 0)
        w.rows = 0;
    else if (along_columns)
        w = {w.column + line, begin, last_line - line + 1, end - begin};
    else
        w = {begin, w.row + line, end - begin, last_line - line + 1};
    return posts;
}

class Division {
  public:
    Division(const SunField& sun, const Window& part, double tolerance_rad, std::size_t most)
        : sun_(sun), part_(part), tolerance_rad_(tolerance_rad), most_(most) {}

    void divide(const Window& window) {
        if (common(window, part_).is_empty() || tiles_.size() > most_) return;
        const std::optional<SunTile> whole = sun_.tile({window});
        const double error_rad = whole ? sun_.error_rad(*whole) : kPi;
        if (error_rad <= tolerance_rad_) return add(*whole);
        if (cut_between_rays(window, error_rad)) return;
        halve(window);
    }
    std::vector<SunTile> take() { return std::move(tiles_); }

  private:
    void add(const SunTile& tile) {
        if (!common(tile.posts.window, part_).is_empty()) tiles_.push_back(tile);
    }

    void halve(const Window& window) {
        const bool wide = window.columns > kLeastWindow, high = window.rows > kLeastWindow;
        if (!wide && !high) refuse();
        const glm::dvec2 step =
            sun_.step({window.column + window.columns / 2, window.row + window.rows / 2});
        const glm::dvec2 size_m =
            sun_.terrain().spacing_m() * glm::dvec2(window.columns, window.rows);
        // Along its rays while that leaves it no longer than wide by far; else across.
        const bool along_columns = std::abs(step.y) < std::abs(step.x);
        const double length_m = along_columns ? size_m.x : size_m.y,
                     width_m = along_columns ? size_m.y : size_m.x;
        const bool of_columns = length_m > width_m / 4 ? along_columns : !along_columns;
        for (const Window& half : halves(window, of_columns ? wide : !high))
            divide(half);
    }

    [[noreturn]] void refuse() const {
        bad_input(fmt::format(
            "sun: {}: the sun's direction on this grid changes by more than 0.05 degrees within {} "
            "posts; expected a map on which it does not, such as UTM: gdalwarp -t_srs",
            sun_.terrain().grid().crs().name(), kLeastWindow));
    }

    /// One tile after the other, each as wide as the error of the last one lets it be.
    bool cut_between_rays(const Window& window, double error_of_all_rad) {
        const glm::dvec2 step =
            sun_.step({window.column + window.columns / 2, window.row + window.rows / 2});
        if (!std::isfinite(step.x + step.y)) return false;
        const bool along_columns = std::abs(step.y) < std::abs(step.x);
        const int posts = along_columns ? window.rows : window.columns;
        const auto at = [&](double share) { return on_diagonal(window, step, share); };
        std::vector<SunTile> tiles;
        double from = 0, width = std::clamp(0.9 * tolerance_rad_ / error_of_all_rad, 0.02, 0.5);
        std::optional<Ray> begin, end;
        constexpr int kMostTries = 400;
        for (int tries = 0; tries < kMostTries; ++tries) {
            const int left = static_cast<int>(std::ceil((1 - from) / width - 1e-9));
            const bool is_last = left <= 1;
            const double to = is_last ? 1 : from + (1 - from) / left;
            end.reset();
            if (!is_last && !(end = sun_.ray(at(to), window))) return false;
            const std::optional<TilePosts> some = trimmed({window, begin, end}, along_columns);
            if (!some) return false;
            double error_rad = 0;
            std::optional<SunTile> tile;
            if (!some->window.is_empty()) {
                tile = sun_.tile(*some);
                if (!tile || tile->ray.goes_along_columns() != along_columns)
                    error_rad = kPi;
                else
                    error_rad = sun_.error_rad(*tile);
            }
            const double share = 0.97 * tolerance_rad_ / std::max(error_rad, 1e-9);
            if (error_rad > tolerance_rad_) {
                width = (to - from) * std::min(share, 0.9);
                if (width * posts < kLeastWidth) return false;
                continue;
            }
            if (tile) tiles.push_back(*tile);
            if (is_last) {
                for (const SunTile& each : tiles)
                    add(each);
                return true;
            }
            width = (to - from) * std::min(1.5, share);
            from = to;
            begin = end;
        }
        return false;
    }

    /// A post on that diagonal of a window which all rays cross, from the side where lines of a
    /// sweep begin.
    static glm::dvec2 on_diagonal(const Window& window, const glm::dvec2& step, double share) {
        const bool along_columns = std::abs(step.y) < std::abs(step.x);
        glm::dvec2 shares(share);
        if (step.x * step.y > 0) (along_columns ? shares.x : shares.y) = 1 - share;
        return glm::dvec2(std::round(window.column + shares.x * (window.columns - 1)),
                          std::round(window.row + shares.y * (window.rows - 1)));
    }

    const SunField& sun_;
    Window part_;
    double tolerance_rad_;
    std::size_t most_;
    std::vector<SunTile> tiles_;
};

}  // namespace

std::vector<SunTile> divide(const SunField& sun, const Window& window, const Window& part,
                            double tolerance_rad, std::size_t most) {
    Division division(sun, part, tolerance_rad, most);
    division.divide(window);
    return division.take();
}

}  // namespace relevo::light
