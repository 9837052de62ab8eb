#include "dem/surroundings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "dem/places_over.h"
#include "geo/format.h"
#include "geo/vertical_datum.h"

namespace relevo::dem {
namespace {

constexpr int kSide = 48;      // places each way at which heights are compared
constexpr double kMuch_m = 5;  // of a difference
constexpr const char* kEgm96 = "EGM96";

/// Heights of the site less those around it.
struct Differences {
    std::size_t places = 0;
    double median_m = 0;
    double scatter_m = 0;  // half of them are so near to the median
};

double median_of(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Differences differences(const Grid& grid, const Source& around,
                        const std::function<double(const geo::Geodetic&)>& height) {
    std::vector<double> all_m;
    for (int i = 0; i < kSide * kSide; ++i) {
        const geo::Geodetic place = grid.place((i % kSide + 0.5) * (grid.columns() - 1) / kSide,
                                               (i / kSide + 0.5) * (grid.rows() - 1) / kSide);
        const double difference_m = height(place) - around.height_at(place);
        if (std::isfinite(difference_m)) all_m.push_back(difference_m);
    }
    Differences found{.places = all_m.size()};
    if (all_m.empty()) return found;
    found.median_m = median_of(all_m);
    for (double& value : all_m)
        value = std::abs(value - found.median_m);
    found.scatter_m = median_of(all_m);
    return found;
}

/// @throws Error (BadInput) where a place of the site's outline is not on the other grid
void check_is_around(const Grid& around, const Grid& site, const std::string& path) {
    constexpr int kSteps = 16;
    constexpr double kNear = 1e-6;  // posts: a part of a DEM may end where that does
    for (int i = 0; i <= kSteps; ++i) {
        const double column = double(site.columns() - 1) * i / kSteps,
                     row = double(site.rows() - 1) * i / kSteps;
        for (const glm::dvec2& at : {glm::dvec2(column, 0), glm::dvec2(column, site.rows() - 1),
                                     glm::dvec2(0, row), glm::dvec2(site.columns() - 1, row)}) {
            const geo::Geodetic place = site.place(at.x, at.y);
            const glm::dvec2 post = around.post(place);
            const auto is_on = [](double position, int posts) {
                return position >= -kNear && position <= posts - 1 + kNear;
            };
            if (is_on(post.y, around.rows()) &&
                (around.columns_per_turn() || is_on(post.x, around.columns())))
                continue;
            bad_input(fmt::format(
                "surroundings: {}: end within the DEM, at {}; expected a DEM in which it lies",
                path, geo::degrees_text(place)));
        }
    }
}

std::optional<geo::VerticalCrs> vertical_of(const Source& source) {
    if (source.grid().crs().vertical()) return source.grid().crs().vertical();
    if (source.description().vertical_datum == kEgm96)
        return geo::VerticalCrs{"EGM96 height", "EPSG:5773", "metre", 1, false};
    return std::nullopt;
}

/// How heights around a site become the site's.
struct Joint {
    double shift_m = 0;  // is added to them
    std::string how;     // goes on "heights "
};

/// "raised by 0.62 m"
std::string moved_text(double shift_m) {
    if (std::abs(shift_m) < 0.005) return "as they are";
    return fmt::format("{} by {:.2f} m", shift_m > 0 ? "raised" : "lowered", std::abs(shift_m));
}

Joint joint_of(const Source& site, const Source& around, const Differences& found) {
    const std::string &here = site.description().vertical_datum,
                      &there = around.description().vertical_datum;
    const std::string scatter =
        fmt::format("half of {} places are within {:.2f} m of it", found.places, found.scatter_m);
    const std::string left =
        found.places == 0
            ? "no place has a height in both"
            : fmt::format("the median difference is {:.2f} m, {}", found.median_m, scatter);
    const auto of_site = vertical_of(site), of_around = vertical_of(around);
    if ((!here.empty() && here == there) ||
        (of_site && of_around && !of_site->code.empty() && of_site->code == of_around->code))
        return {0, fmt::format("{}, both above {}; {}", moved_text(0), here, left)};
    if (of_site && of_around)
        if (const auto step_m = geo::vertical_step_m(*of_around, *of_site, site.grid().center()))
            return {*step_m, fmt::format("{}, from {} to {} by PROJ; {}", moved_text(*step_m),
                                         there, here, left)};
    if (found.places == 0) return {0, moved_text(0) + ": " + left};
    return {found.median_m,
            fmt::format("{}, the median difference; {}", moved_text(found.median_m), scatter)};
}

void say(const Joint& joint, const Differences& found, const std::string& path,
         std::int64_t filled) {
    const std::string said = fmt::format(
        "surroundings: {}: heights {}{}", path, joint.how,
        filled > 0 ? fmt::format("; {} voids of the DEM take its heights", filled) : "");
    const bool is_far =
        std::abs(found.median_m) > kMuch_m || found.scatter_m > kMuch_m || found.places == 0;
    if (is_far)
        log::warning(said + "; are unit, vertical datum and CRS of both as they should be?");
    else
        log::info(said);
}

/// Gives posts without a height that of the surroundings there.
/// @returns how many have got one
std::int64_t fill_from(const Posts& surroundings, Heightfield& site) {
    if (statistics(site.height_m).holes == 0) return 0;
    std::atomic<std::int64_t> filled = 0;
    const PlacesOver places(site.grid, surroundings.grid(),
                            {.count = {site.height_m.width(), site.height_m.height()}});
    parallel_for(0, site.height_m.height(), 16, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < site.height_m.width(); ++column) {
                float& height_m = site.height_m.at(column, row);
                if (!std::isnan(height_m)) continue;
                const glm::dvec2 post = places(column, row);
                height_m = static_cast<float>(surroundings.height_at(post.x, post.y));
                filled += !std::isnan(height_m);
            }
    });
    if (filled > 0) site.about.statistics = statistics(site.height_m);
    return filled;
}

}  // namespace

std::shared_ptr<const Posts> load_surroundings(const Source& site, Heightfield* heights,
                                               const LoadOptions& options) {
    LoadOptions own;
    own.memory = options.memory;
    own.cached = options.cached;
    Source around = Source::open(options.surroundings, own);
    const std::string path = around.description().path;
    check_is_around(around.grid(), site.grid(), path);
    const Differences found = differences(site.grid(), around, [&](const geo::Geodetic& place) {
        if (!heights) return site.height_at(place);
        const glm::dvec2 post = site.grid().post(place);
        return heights->height_at(post.x, post.y);
    });
    const Joint joint = joint_of(site, around, found);
    around.raise(joint.shift_m, joint.how);
    const auto posts = std::make_shared<const Posts>(Posts::load(std::move(around), own));
    say(joint, found, path, heights ? fill_from(*posts, *heights) : 0);
    if (!heights)
        log::warning("surroundings: memory has no room for all of the DEM: its voids stay voids");
    return posts;
}

int rim_of(const Grid& site, const Grid& surroundings, const MemoryBudget& memory) {
    constexpr double kCells = 64, kMostPosts = 16e6;
    const glm::dvec2 ratio = surroundings.post_spacing_m() / site.post_spacing_m();
    const double columns = site.columns(), rows = site.rows();
    const auto fitting = [&](double most) {  // (columns + 2 r) (rows + 2 r) = most
        const double half = (columns + rows) / 4;
        const double r = std::sqrt(std::max(0.0, half * half - (columns * rows - most) / 4)) - half;
        return std::max(0, static_cast<int>(r));
    };
    const int wanted = std::min(static_cast<int>(std::lround(kCells * std::max(ratio.x, ratio.y))),
                                fitting(std::max(kMostPosts, 2 * columns * rows)));
    const int room = fitting(static_cast<double>(memory.whole_posts));
    if (room < wanted)
        log::warning(
            fmt::format("surroundings: memory has room for a rim of {} of {} posts around the DEM: "
                        "rasters are less exact near its edge; use a larger --memory",
                        room, wanted));
    return std::min(wanted, room);
}

Heightfield rimmed(const Posts& site) {
    const Posts& around = *site.surroundings();
    const Grid& own = site.grid();
    const int rim = site.rim();
    Affine affine = own.affine();
    affine.x0 -= rim * (affine.x_column + affine.x_row);
    affine.y0 -= rim * (affine.y_column + affine.y_row);
    const Grid grid(own.columns() + 2 * rim, own.rows() + 2 * rim, affine, own.crs());
    Heightfield field{Array2d<float>(grid.columns(), grid.rows()), grid, site.about(), 1};
    const PlacesOver places(grid, around.grid(),
                            {.count = glm::ivec2(grid.columns(), grid.rows())});
    parallel_for(0, grid.rows(), 16, [&](int first, int last) {
        std::vector<float> buffer;
        for (int row = first; row < last; ++row) {
            const bool has_site = row >= rim && row < rim + own.rows();
            const Window of_site{0, row - rim, own.columns(), 1};
            for (int column = 0; column < grid.columns(); ++column) {
                if (has_site && column == rim) column += own.columns();
                const glm::dvec2 post = places(column, row);
                field.height_m.at(column, row) =
                    static_cast<float>(around.height_at(post.x, post.y));
            }
            if (!has_site) continue;
            const float* const from = site.view(of_site, buffer).at(0, row - rim);
            std::copy_n(from, own.columns(), &field.height_m.at(rim, row));
        }
    });
    field.about.statistics = statistics(field.height_m);
    return field;
}

const char* ground_text(const Posts& posts) {
    return surroundings_text(posts, "").empty() ? "the DEM alone" : "the DEM and its surroundings";
}

std::string surroundings_text(const Posts& posts, const std::string& lead) {
    const Posts* const around = posts.surroundings();
    if (!around || around->about().joined.empty()) return {};
    return fmt::format("{}{} around the DEM: heights {}", lead, around->about().path,
                       around->about().joined);
}

}  // namespace relevo::dem
