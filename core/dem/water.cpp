#include "dem/water.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "dem/collar.h"
#include "dem/dry_land.h"
#include "dem/runs.h"

namespace relevo::dem {
namespace {

constexpr std::int64_t kLeastPosts = 64;  // of a sea or a lake
constexpr std::int64_t kSeaOneIn = 2000;  // posts of a DEM
constexpr double kFlatSea_m2 = 1e6;       // that lies at 0 inside of a DEM
constexpr float kLowestLand_m = -450;     // the shore of the Dead Sea, and a margin
constexpr float kFlat_m = 1e-3f;          // that a resampled lake's heights may differ
constexpr int kLeastRun = 5;              // posts of a row by which a lake is found
constexpr double kLeastLake_m2 = 1e4;
constexpr double kClosed = 0.95;  // of a lake's rim
constexpr float kStep_m = 0.05f;  // heights that are stored in larger ones are terraced
constexpr double kSteep = 0.25;   // of a lake's rim, where heights are terraced
// Of a large lake whose heights were averaged and then stored in steps: a plain's terraces have as
// much rim below them as above. In the Alps of AW3D30 lakes have 0.69 to 1 of their rim above them
// and 24 to 110 of rim squared a post, flats of plains up to 0.57, or 150 and more.
constexpr std::int64_t kLargePosts = 900;
constexpr double kLargeClosed = 0.65, kCompact = 120;
constexpr int kFar = 4;           // posts behind its shore, where land has risen by two steps
constexpr double kRisesOn = 0.4;  // of the shore
// A lake that lies on two sheets of a map may have heights that differ by a rounding.
constexpr float kSeam_m = 0.02f;
constexpr double kSeam = 0.25;  // of a lake's rim, at most
// Resampling with cubic kernels lowers the shore of a lake below it. Behind it land rises, on 0.81
// of the shore of Lake Garda, and is lower on 0.02. Of a plain's terrace it is higher on one half.
constexpr double kRingedHigher = 0.7, kRingedLower = 0.1;

class WaterFinder {
  public:
    WaterFinder(const Array2d<float>& heights_m, const Grid& grid)
        : h_(heights_m), dry_land_(grid) {
        const glm::dvec2 spacing_m = grid.post_spacing_m();
        post_m2_ = spacing_m.x * spacing_m.y;
    }

    Water run() {
        find_sea();
        find_lakes();
        if (water_.sea_posts + water_.lake_posts > 0) water_.kind = std::move(kind_);
        return std::move(water_);
    }

  private:
    struct Component {
        std::int64_t posts = 0, zeros = 0, in_depression = 0;
        float lowest_m = std::numeric_limits<float>::max();
        bool open = false;  // to the edge or a hole
    };

    bool is_hole(int column, int row) const { return std::isnan(h_.at(column, row)); }

    /// Whether a run touches the edge of the DEM or a hole.
    bool opens(const Run& run) const {
        if (run.first == 0 || run.last == h_.width() - 1 || run.row == 0 ||
            run.row == h_.height() - 1)
            return true;
        if (is_hole(run.first - 1, run.row) || is_hole(run.last + 1, run.row)) return true;
        for (const int row : {run.row - 1, run.row + 1})
            for (int column = run.first; column <= run.last; ++column)
                if (is_hole(column, row)) return true;
        return false;
    }

    void find_sea() {
        Runs runs(h_.height());
        for (int row = 0; row < h_.height(); ++row) {
            runs.begin_row();
            const float* const h = h_.row(row).data();
            const auto may_be_sea = [&](int column) {
                return h[column] <= 0 && !dry_land_.is_dry(column, row, h[column]);
            };
            for (int column = 0; column < h_.width(); ++column) {
                if (!may_be_sea(column)) continue;
                const int first = column;
                while (column + 1 < h_.width() && may_be_sea(column + 1))
                    ++column;
                runs.add(row, first, column, [](int) { return true; });
            }
        }
        std::vector<Component> components(static_cast<std::size_t>(runs.size()));
        for (int i = 0; i < runs.size(); ++i)
            measure(runs.at(i), components[static_cast<std::size_t>(runs.root(i))]);
        std::vector<WaterKind> kinds;
        for (const Component& component : components)
            kinds.push_back(component.posts > 0 ? sea_kind(component) : WaterKind::None);
        for (int i = 0; i < runs.size(); ++i) {
            const Run& run = runs.at(i);
            const WaterKind kind = kinds[static_cast<std::size_t>(runs.root(i))];
            if (kind == WaterKind::None) continue;
            std::fill_n(&kind_of_posts().at(run.first, run.row), run.last - run.first + 1, kind);
            if (kind != WaterKind::SeaFloor) continue;
            // What is exactly 0 has been measured on the surface.
            for (int column = run.first; column <= run.last; ++column)
                if (h_.at(column, run.row) == 0)
                    kind_of_posts().at(column, run.row) = WaterKind::Sea;
        }
    }

    void measure(const Run& run, Component& component) const {
        const float* const h = h_.row(run.row).data();
        component.posts += run.last - run.first + 1;
        for (int column = run.first; column <= run.last; ++column) {
            component.zeros += h[column] == 0;
            component.lowest_m = std::min(component.lowest_m, h[column]);
        }
        const Depression* const box = dry_land_.at(run.first, run.row);
        if (box && !box->on_coast) component.in_depression += run.last - run.first + 1;
        component.open = component.open || opens(run);
    }

    WaterKind sea_kind(const Component& found) {
        const auto posts = static_cast<double>(found.posts);
        const bool flat = static_cast<double>(found.zeros) >= 0.9 * posts;
        const bool enough = found.posts >= std::max(kLeastPosts, std::ssize(h_) / kSeaOneIn);
        const bool is_sea = found.lowest_m < kLowestLand_m || (found.open && enough) ||
                            (flat && enough && posts * post_m2_ >= kFlatSea_m2);
        if (!is_sea) return WaterKind::None;
        // Zeros around a raster that was turned or cut are no sea.
        if (flat && found.open && is_collar(0)) return WaterKind::None;
        // Below the lowest land of a depression is the floor of its lake, at a level that is not 0.
        if (2 * found.in_depression > found.posts) {
            water_.lake_posts += found.posts;
            ++water_.lakes;
            return WaterKind::Lake;
        }
        water_.sea_posts += found.posts;
        water_.lowest_sea_m = std::min(water_.lowest_sea_m, double{found.lowest_m});
        constexpr float kNoise_m = -10;  // of radar over water
        if (static_cast<double>(found.zeros) < 0.05 * posts && found.lowest_m > kLowestLand_m)
            water_.assumptions.push_back(fmt::format(
                "{} connected posts at or below 0 m, down to {:.1f} m, are drawn as sea: they "
                "reach the edge of the DEM or a void; --disable sea draws land",
                found.posts, found.lowest_m));
        if (found.lowest_m >= kNoise_m || flat) return WaterKind::Sea;
        water_.has_sea_floor = true;
        return WaterKind::SeaFloor;
    }

    /// Whether what is open at the edge and of one height is left from turning or cutting.
    bool is_collar(float height_m) {
        if (!looked_for_collar_) collar_ = find_collar(h_);
        looked_for_collar_ = true;
        return collar_ && same(collar_->height_m, height_m);
    }

    static bool same(float a, float b) { return std::abs(a - b) <= kFlat_m; }

    void find_lakes() {
        Runs runs(h_.height());
        for (int row = 0; row < h_.height(); ++row) {
            runs.begin_row();
            const float* const h = h_.row(row).data();
            const float* const above = row > 0 ? h_.row(row - 1).data() : h;
            for (int column = 0; column + kLeastRun <= h_.width();) {
                const int first = column++;
                // Almost all posts end here.
                if (!same(h[first], h[first + 1]) ||
                    (!kind_.empty() && kind_.at(first, row) != WaterKind::None))
                    continue;
                while (column < h_.width() && same(h[first], h[column]))
                    ++column;
                if (column - first >= kLeastRun)
                    runs.add(row, first, column - 1, [&](int c) { return same(h[c], above[c]); });
            }
        }
        std::vector<std::int64_t> posts(static_cast<std::size_t>(runs.size()));
        for (int i = 0; i < runs.size(); ++i)
            posts[static_cast<std::size_t>(runs.root(i))] += runs.at(i).last - runs.at(i).first + 1;
        // What long runs alone do not make up by half is no lake.
        for (int i = 0; i < runs.size(); ++i)
            if (2 * posts[static_cast<std::size_t>(i)] >= kLeastPosts)
                try_lake(runs.at(i).first, runs.at(i).row);
    }

    /// What is around a flat.
    struct Rim {
        std::vector<float> rises;           // where it is higher
        std::vector<float> far_rises;       // kFar posts further out, straight on
        std::vector<float> far_from_lower;  // the same behind posts that are lower
        std::int64_t lower = 0, edge = 0, seam = 0;
        float deepest_m = 0;  // how far it is lower

        double higher() const { return static_cast<double>(rises.size()); }
        double all() const { return higher() + static_cast<double>(lower); }
    };

    /// Adds a post to the rim. @param far  further out  @param level  of the flat [m]
    void add(float rise, const glm::ivec2& far, float level, Rim& rim) const {
        if (rise < 0 && rise >= -kSeam_m) {
            ++rim.seam;
            return;
        }
        if (rise > 0) {
            rim.rises.push_back(rise);
        } else {
            ++rim.lower;
            rim.deepest_m = std::max(rim.deepest_m, -rise);
        }
        if (far.x >= 0 && far.y >= 0 && far.x < h_.width() && far.y < h_.height() &&
            !is_hole(far.x, far.y))
            (rise > 0 ? rim.far_rises : rim.far_from_lower).push_back(h_.at(far.x, far.y) - level);
    }

    /// Looks at all that is connected to a post and of its height, and at what is around that.
    void try_lake(int column, int row) {
        if (seen_.empty()) seen_ = Array2d<std::uint8_t>(h_.width(), h_.height(), 0);
        if (seen_.at(column, row)) return;
        const float level = h_.at(column, row);
        std::vector<glm::ivec2> posts{{column, row}};
        seen_.at(column, row) = 1;
        Rim rim;
        for (std::size_t i = 0; i < posts.size(); ++i) {
            for (const glm::ivec2 step :
                 {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
                const glm::ivec2 at = posts[i] + step;
                if (at.x < 0 || at.y < 0 || at.x >= h_.width() || at.y >= h_.height() ||
                    is_hole(at.x, at.y)) {
                    ++rim.edge;
                    continue;
                }
                const float rise = h_.at(at.x, at.y) - level;
                if (std::abs(rise) <= kFlat_m) {
                    if (seen_.at(at.x, at.y)) continue;
                    seen_.at(at.x, at.y) = 1;
                    posts.push_back(at);
                } else {
                    add(rise, at + kFar * step, level, rim);
                }
            }
        }
        if (static_cast<double>(rim.seam) > kSeam * (rim.all() + static_cast<double>(rim.seam)))
            rim.lower += rim.seam;
        if (!is_lake(std::ssize(posts), rim) || (rim.edge > 0 && is_collar(level))) return;
        for (const glm::ivec2& post : posts)
            kind_of_posts().at(post.x, post.y) = WaterKind::Lake;
        water_.lake_posts += std::ssize(posts);
        ++water_.lakes;
    }

    bool is_lake(std::int64_t posts, const Rim& rim) const {
        const auto size = static_cast<double>(posts);
        if (posts < kLeastPosts || size * post_m2_ < kLeastLake_m2 || rim.rises.empty())
            return false;
        // Of a flat that the DEM cuts through, enough has to be seen.
        if (rim.all() < std::sqrt(size) || rim.all() < static_cast<double>(rim.edge)) return false;
        const float step = *std::ranges::min_element(rim.rises);
        const bool terraced = step >= kStep_m;
        const bool closed = rim.higher() >= kClosed * rim.all();
        if (closed && !terraced) return true;
        const auto steep =
            std::ranges::count_if(rim.rises, [&](float rise) { return rise > 1.5f * step; });
        if (closed && static_cast<double>(steep) >= kSteep * rim.higher()) return true;
        // Shores that were averaged rise by a step and waver by one, and then rise on.
        const auto rises_on =
            std::ranges::count_if(rim.far_rises, [&](float rise) { return rise > 1.5f * step; });
        const bool is_large =
            terraced && posts >= kLargePosts && rim.all() * rim.all() <= kCompact * size;
        return is_large &&
               (is_ringed(rim, step) ||
                (static_cast<double>(rises_on) >= kRisesOn * rim.higher() &&
                 rim.deepest_m < 1.5f * step && rim.higher() >= kLargeClosed * rim.all()));
    }

    /// Whether land rises all around behind a shore that may be lower than the flat.
    static bool is_ringed(const Rim& rim, float step) {
        std::int64_t higher = 0, lower = 0;
        for (const std::vector<float>* rises : {&rim.far_rises, &rim.far_from_lower})
            for (const float rise : *rises) {
                higher += rise > 1.5f * step;
                lower += rise < -1.5f * step;
            }
        return static_cast<double>(higher) >= kRingedHigher * rim.all() &&
               static_cast<double>(lower) <= kRingedLower * rim.all();
    }

    const Array2d<float>& h_;
    DryLand dry_land_;
    std::optional<Collar> collar_;
    bool looked_for_collar_ = false;
    double post_m2_ = 0;
    /// Of all posts, made when there is the first water.
    Array2d<WaterKind>& kind_of_posts() {
        if (kind_.empty()) kind_ = Array2d<WaterKind>(h_.width(), h_.height(), WaterKind::None);
        return kind_;
    }

    Array2d<WaterKind> kind_;
    Array2d<std::uint8_t> seen_;
    Water water_;
};

}  // namespace

double Water::sea_rim_share() const {
    if (kind.empty()) return 0;
    int rim = 0, sea = 0;
    for (int row = 0; row < kind.height(); ++row) {
        const bool ends = row == 0 || row == kind.height() - 1;
        for (int column = 0; column < kind.width(); ++column) {
            if (!ends && column > 0 && column < kind.width() - 1) continue;
            const WaterKind at = kind.at(column, row);
            ++rim;
            sea += at == WaterKind::Sea || at == WaterKind::SeaFloor;
        }
    }
    return static_cast<double>(sea) / rim;
}

double Water::sea_floor_share() const {
    if (!has_sea_floor || kind.empty()) return 0;
    const auto floor = std::count(kind.data(), kind.data() + kind.size(), WaterKind::SeaFloor);
    return static_cast<double>(floor) / static_cast<double>(kind.size());
}

Water find_water(const Array2d<float>& heights_m, const Grid& grid) {
    return WaterFinder(heights_m, grid).run();
}

}  // namespace relevo::dem
