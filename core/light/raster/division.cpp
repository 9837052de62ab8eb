#include "light/raster/division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::light {
namespace {

constexpr int kLeastWindow = 2;  // posts a side
/// Posts across a tile between rays: each of its lines has some.
constexpr int kLeastWidth = 6;

std::array<Window, 2> halves(const Window& window, bool of_columns) {
    std::array<Window, 2> halves{window, window};
    int Window::*const first = of_columns ? &Window::column : &Window::row;
    int Window::*const count = of_columns ? &Window::columns : &Window::rows;
    halves[0].*count = window.*count / 2;
    halves[1].*first += halves[0].*count;
    halves[1].*count -= halves[0].*count;
    return halves;
}

class Division {
  public:
    Division(const SunField& sun, const Window& part, double tolerance_rad, std::size_t most)
        : sun_(sun), part_(part), tolerance_rad_(tolerance_rad), most_(most) {}

    /// @param along_columns  how sweeps of the window around go
    void divide(const Window& window, std::optional<bool> along_columns = {}) {
        if (common(window, part_).is_empty() || tiles_.size() > most_) return;
        if (sun_.is_night(window)) return add({.posts = {window}, .is_night = true});
        const glm::dvec2 middle(window.column + (window.columns - 1) / 2,
                                window.row + (window.rows - 1) / 2);
        const Way way = way_of(sun_.step(middle), along_columns);
        const std::optional<SunTile> whole = sun_.tile({window}, way.along_columns);
        const double error_rad = whole ? sun_.error_rad(*whole) : kPi;
        if (error_rad <= tolerance_rad_) return add(*whole);
        if (cut_between_rays(window, way, error_rad)) return;
        halve(window, way);
    }
    std::vector<SunTile> take() { return std::move(tiles_); }

  private:
    void add(const SunTile& tile) {
        if (!common(tile.posts.window, part_).is_empty()) tiles_.push_back(tile);
    }

    /// How rays go in the middle of a window [posts a metre], and how sweeps do.
    struct Way {
        glm::dvec2 step;
        bool along_columns;
    };
    /// Sweeps go as they do around, so that tiles are long, unless that leads too far aside.
    static Way way_of(const glm::dvec2& step, std::optional<bool> around) {
        constexpr double kAside = 1.6;
        const double x = std::abs(step.x), y = std::abs(step.y);
        if (around && (*around ? y < kAside * x : x < kAside * y)) return {step, *around};
        return {step, y < x};
    }

    void halve(const Window& window, const Way& way) {
        const bool wide = window.columns > kLeastWindow, high = window.rows > kLeastWindow;
        if (!wide && !high) refuse();
        const glm::dvec2 size_m =
            sun_.terrain().spacing_m() * glm::dvec2(window.columns, window.rows);
        // Along its rays while that leaves it no longer than wide by far; else across.
        const double length_m = way.along_columns ? size_m.x : size_m.y,
                     width_m = way.along_columns ? size_m.y : size_m.x;
        const bool of_columns = length_m > width_m / 4 ? way.along_columns : !way.along_columns;
        for (const Window& half : halves(window, of_columns ? wide : !high))
            divide(half, way.along_columns);
    }

    [[noreturn]] void refuse() const {
        bad_input(fmt::format(
            "sun: {}: the sun's direction on this grid changes by more than 0.05 degrees within {} "
            "posts; expected a map on which it does not, such as UTM: gdalwarp -t_srs",
            sun_.terrain().grid().crs().name(), kLeastWindow));
    }

    /// One tile after the other, each as wide as the error of the last one lets it be.
    bool cut_between_rays(const Window& window, const Way& way, double error_of_all_rad) {
        if (!std::isfinite(way.step.x + way.step.y)) return false;
        const int posts = way.along_columns ? window.rows : window.columns;
        const auto ray_at = [&](double share) {
            return sun_.ray(on_diagonal(window, way, share), window, way.along_columns);
        };
        std::vector<SunTile> tiles;
        const double least = double(kLeastWidth) / posts;
        double from = 0;
        double width =
            std::max(least, std::clamp(0.9 * tolerance_rad_ / error_of_all_rad, 0.02, 0.5));
        std::optional<Ray> begin, end;
        constexpr int kMostTries = 400;
        for (int tries = 0; tries < kMostTries; ++tries) {
            const int most = static_cast<int>((1 - from) / least + 1e-9),
                      left = std::min(static_cast<int>(std::ceil((1 - from) / width - 1e-9)),
                                      std::max(1, most));
            const bool is_last = left <= 1;
            const double to = is_last ? 1 : from + (1 - from) / left;
            if (to - from < least - 1e-9) return false;
            end.reset();
            if (!is_last && !(end = ray_at(to))) return false;
            const std::optional<SunTile> tile = sun_.tile({window, begin, end}, way.along_columns);
            if (!tile) return false;
            const bool has_posts = !tile->posts.window.is_empty();
            const double error_rad = has_posts ? sun_.error_rad(*tile) : 0;
            if (error_rad > tolerance_rad_) {
                if (left >= most) return false;  // no narrower
                width = (to - from) * std::min(0.9, 0.97 * tolerance_rad_ / error_rad);
                continue;
            }
            if (has_posts) tiles.push_back(*tile);
            if (is_last) {
                for (const SunTile& each : tiles)
                    add(each);
                return true;
            }
            // No narrower than the last one: where it is length that makes the error, width does
            // not.
            const double share = 0.97 * tolerance_rad_ / std::max(error_rad, 1e-9);
            width = (to - from) * std::clamp(share, 1.0, 1.5);
            from = to;
            begin = end;
        }
        return false;
    }

    /// A post on that diagonal of a window which all rays cross, from the side where lines of a
    /// sweep begin.
    static glm::dvec2 on_diagonal(const Window& window, const Way& way, double share) {
        glm::dvec2 shares(share);
        if (way.step.x * way.step.y > 0) (way.along_columns ? shares.x : shares.y) = 1 - share;
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
