#include "light/raster/beyond.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/point/doubt.h"
#include "light/point/edge_ground.h"
#include "light/point/horizon.h"
#include "light/raster/sun_field.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr int kSide = 24;  // posts that are looked from, each way
constexpr int kNear = 32;  // posts away that every post is looked at, so that ridges close by count

/// A post that is looked from.
struct Eye {
    int column, row;
    double height_m;
    geo::Geodetic place;
};

/// What of the DEM a ray meets.
struct View {
    double tangent = -kInfinity;  // of its ground
    double until_m = 0;           // where it ends
    EdgeFinder edge;
};

class Looking {
  public:
    Looking(const SunTerrain& terrain, const Window& part, const std::optional<double>& highest_m)
        : posts_(terrain.posts()), curvature_(terrain.curvature()) {
        bounds_.push_back({.highest_m = highest_beyond_m(posts_, highest_m)});
        if (!highest_m) bounds_.push_back({.highest_m = kHighestTerrain_m});
        const Window w = terrain.window_of(part);
        std::vector<float> one;
        for (int i = 0; i < kSide * kSide; ++i) {
            const int column = w.column + place(i % kSide, w.columns),
                      row = w.row + place(i / kSide, w.rows);
            const double height_m = *posts_.view({column, row, 1, 1}, one).at(column, row);
            if (!std::isnan(height_m))
                eyes_.push_back({column, row, height_m, posts_.grid().place(column, row)});
        }
        for (Bound& bound : bounds_) {
            bound.least_m.resize(eyes_.size(), kInfinity);
            bound.reach_m.resize(eyes_.size(), -kInfinity);
        }
    }

    /// Calls `look` with each of them and its number, on several threads.
    void each_eye(const std::function<void(std::size_t, const Eye&)>& look) const {
        parallel_for(0, static_cast<int>(eyes_.size()), 8, [&](int first, int last) {
            for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
                look(i, eyes_[i]);
        });
    }

    /// The posts around an eye that are looked at one by one.
    dem::Posts::View near(const Eye& eye, std::vector<float>& buffer) const {
        const dem::Grid& grid = posts_.grid();
        const int column = std::max(0, eye.column - kNear), row = std::max(0, eye.row - kNear);
        return posts_.view({column, row, std::min(grid.columns(), eye.column + kNear + 1) - column,
                            std::min(grid.rows(), eye.row + kNear + 1) - row},
                           buffer);
    }

    /// @param near         as near() has it
    /// @param way_a_metre  posts
    View look(const Eye& eye, const dem::Posts::View& near, const glm::dvec2& way_a_metre) const {
        View view;
        const double post_m = 1 / std::max(std::abs(way_a_metre.x), std::abs(way_a_metre.y));
        const dem::Grid& grid = posts_.grid();
        // Near ground is looked at post by post, far ground as far apart as a 64th of the way.
        for (double s = post_m;;) {
            const auto column = static_cast<int>(std::lround(eye.column + s * way_a_metre.x)),
                       row = static_cast<int>(std::lround(eye.row + s * way_a_metre.y));
            if (column < 0 || row < 0 || column >= grid.columns() || row >= grid.rows()) break;
            const bool is_near =
                std::max(std::abs(column - eye.column), std::abs(row - eye.row)) <= kNear;
            const double height_m = is_near ? *near.at(column, row) : posts_.thinned_m(column, row);
            if (!std::isnan(height_m)) {
                view.until_m = s;
                view.edge.add(s, height_m);
                view.tangent =
                    std::max(view.tangent, (height_m - eye.height_m) / s - curvature_ * s / 2);
            }
            s += std::max(post_m * (is_near ? 1 : posts_.thinning()), s / 64);
        }
        view.until_m = std::max(view.until_m, post_m / 2);
        return view;
    }

    /// Terrain beyond a view that stands over a tangent matters. Of one eye, one call at a time.
    void consider(std::size_t i, const View& view, double tangent) {
        const double needed_m = eyes_[i].height_m + view.until_m * tangent +
                                curvature_ * view.until_m * view.until_m / 2;
        for (Bound& bound : bounds_) {
            const double over_m = bound.highest_m - eyes_[i].height_m;
            if (!(needed_m < bound.highest_m) || !(over_m > 0)) continue;
            const double reach_m =
                (std::sqrt(tangent * tangent + 2 * curvature_ * over_m) - tangent) / curvature_;
            bound.least_m[i] = std::min(bound.least_m[i], needed_m);
            bound.reach_m[i] = std::max(bound.reach_m[i], reach_m - view.until_m);
        }
    }

    std::optional<Beyond> found() const {
        const std::optional<BeyondBound> first = found(bounds_.front());
        if (!first) return std::nullopt;
        Beyond result{*first};
        if (bounds_.size() > 1) result.earths = found(bounds_.back());
        return result;
    }

  private:
    struct Bound {
        double highest_m = 0;
        std::vector<double> least_m{}, reach_m{};  // of each eye: that matters, and how far beyond
    };

    static int place(int i, int count) { return static_cast<int>((i + 0.5) * count / kSide); }

    static std::optional<BeyondBound> found(const Bound& bound) {
        const auto touched =
            std::ranges::count_if(bound.least_m, [](double m) { return m < kInfinity; });
        if (touched == 0) return std::nullopt;
        return BeyondBound{.highest_m = bound.highest_m,
                           .share = double(touched) / double(bound.least_m.size()),
                           .least_m = std::ranges::min(bound.least_m),
                           .needed_m = std::max(0.0, std::ranges::max(bound.reach_m))};
    }

    const dem::Posts& posts_;
    double curvature_;
    std::vector<Eye> eyes_;
    std::vector<Bound> bounds_;  // the first one is what is reported
};

long percent_of(double share) {
    return std::lround(std::max(1.0, 100 * share));
}

/// The widest DEM that posts are in, and what of it is under a part of them.
struct Widest {
    const dem::Posts& posts;
    Window part;

    static Widest of(const dem::Posts& posts, const Window& part) {
        const dem::Posts* const around = posts.surroundings();
        if (!around) return {posts, part};
        const Window all{0, 0, posts.grid().columns(), posts.grid().rows()};
        return {*around, window_over(around->grid(), posts.grid(), part.is_empty() ? all : part)};
    }
};

/// Towards a sun from the middle of a DEM, posts a metre.
std::optional<glm::dvec2> way_of(const SunField& sky, const dem::Grid& grid) {
    const glm::dvec2 way = sky.step({(grid.columns() - 1) / 2, (grid.rows() - 1) / 2});
    if (!std::isfinite(way.x + way.y)) return std::nullopt;
    return way;
}

}  // namespace

std::string Beyond::text(const std::string& would) const {
    const std::string of_the_dem = earths ? " (the DEM's highest post)" : "";
    const std::string sentence = fmt::format(
        "mountains outside the DEM could {} at {} % of the posts: those above {:.0f} m, up to "
        "{:.0f} km from the edge, if none is higher than {:.0f} m{}",
        would, percent_of(share), least_m, needed_m / 1000, highest_m, of_the_dem);
    if (!earths) return sentence;
    return fmt::format(
        "{}; at {} %, up to {:.0f} km, if none is higher than {:.0f} m (the Earth's)", sentence,
        percent_of(earths->share), earths->needed_m / 1000, earths->highest_m);
}

std::string Beyond::advice() const {
    const auto values = [](double of_all) {
        const long percent = percent_of(of_all);
        return percent == 100 ? "all" : fmt::format("{} % of the", percent);
    };
    const auto km = [](const BeyondBound& of) { return std::max(1.0, of.needed_m / 1000); };
    if (!earths)
        return fmt::format(
            "mountains outside this DEM could change {} values; use a DEM {:.0f} km larger on each "
            "side or --surroundings, or bound them with --highest",
            values(share), km(*this));
    return fmt::format(
        "mountains outside this DEM could change {} values if as high as its highest post "
        "({:.0f} m), {} values if {:.0f} m; use a DEM {:.0f} or {:.0f} km larger on each side or "
        "--surroundings, or set --highest",
        values(share), highest_m, values(earths->share), earths->highest_m, km(*this), km(*earths));
}

std::optional<Beyond> terrain_beyond(const dem::Posts& posts, const Window& part,
                                     const std::vector<SunOverDem>& suns,
                                     const ShadowOptions& options,
                                     const std::optional<double>& highest_m) {
    const Widest widest = Widest::of(posts, part);
    const SunTerrain terrain(widest.posts, {options.refraction, options.air}, false);
    Looking looking(terrain, widest.part, highest_m);
    std::vector<std::pair<SunField, glm::dvec2>> skies;
    for (const SunOverDem& sun : suns) {
        const SunField sky(terrain, posts.grid().center(), sun);
        if (sky.is_night()) continue;
        if (const std::optional<glm::dvec2> way = way_of(sky, terrain.grid()))
            skies.emplace_back(sky, *way);
    }
    looking.each_eye([&](std::size_t i, const Eye& eye) {
        std::vector<float> buffer;
        const dem::Posts::View near = looking.near(eye, buffer);
        for (const auto& [sky, way] : skies) {
            const double seen_rad =
                terrain.apparent_rad(sky.at(eye.place).elevation_rad, SunTerrain::kMean);
            if (!(seen_rad > 0) || seen_rad > radians(80)) continue;
            const View view = looking.look(eye, near, way);
            if (view.tangent < std::tan(seen_rad)) looking.consider(i, view, std::tan(seen_rad));
        }
    });
    return looking.found();
}

std::optional<Beyond> terrain_beyond(const dem::Posts& posts, const Window& part,
                                     const std::vector<double>& azimuth_rad, double refraction,
                                     const std::optional<double>& highest_m) {
    const Widest widest = Widest::of(posts, part);
    const SunTerrain terrain(widest.posts, {refraction, {}}, false);
    Looking looking(terrain, widest.part, highest_m);
    std::vector<glm::dvec2> ways;
    for (const double azimuth : azimuth_rad)
        if (const std::optional<glm::dvec2> way =
                way_of(SunField(terrain, azimuth), terrain.grid()))
            ways.push_back(*way);
    looking.each_eye([&](std::size_t i, const Eye& eye) {
        std::vector<float> buffer;
        const dem::Posts::View near = looking.near(eye, buffer);
        for (const glm::dvec2& way : ways) {
            const View view = looking.look(eye, near, way);
            const Edge edge = view.edge.edge().value_or(Edge{view.until_m, eye.height_m});
            looking.consider(
                i, view,
                std::max(view.tangent, tangent_beyond(edge, eye.height_m, terrain.curvature())));
        }
    });
    return looking.found();
}

std::vector<SunOverDem> suns_of(const dem::Grid& grid, sun::Instant begin, sun::Instant end) {
    constexpr double kStep_s = 1200, kApart_s = 30 * kDay_s;
    const double length_s = end - begin;
    const geo::Geodetic place = grid.center();
    const sun::PositionTable table(begin, end);
    const sun::Observer observer(place);
    std::vector<SunOverDem> suns;
    const auto add_day = [&](double from_s) {
        for (double s = from_s; s <= std::min(length_s, from_s + kDay_s); s += kStep_s) {
            const glm::dvec3 direction = table.direction(begin + s, observer);
            suns.push_back({sun::azimuth_of(direction), sun::elevation_of(direction), 0});
        }
    };
    const double last_s = std::max(0.0, length_s - kDay_s);
    for (double from_s = 0; from_s < last_s; from_s += kApart_s)
        add_day(from_s);
    add_day(last_s);
    return suns;
}

}  // namespace relevo::light
