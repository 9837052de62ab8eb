#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "light/fields.h"
#include "light/sky.h"
#include "support/support.h"

namespace relevo::light {
namespace {

constexpr int kColumns = 420, kRows = 390;
constexpr float kNobody = std::numeric_limits<float>::quiet_NaN();

/// Mountains over 1.4 degrees of longitude at 78 degrees north, some 80 m from post to post, the
/// grid being turned.
dem::Heightfield turned_degrees() {
    constexpr double kAcross = 1.0 / 300, kUp = 1.0 / 1400, kTurned = radians(20);
    const double c = std::cos(kTurned), s = std::sin(kTurned);
    return test::field_of(kColumns, kRows, {11, kAcross * c, kAcross * s, 78, kUp * s, -kUp * c},
                          "EPSG:4326", [](int column, int row) {
                              return 900 + 500 * std::sin(column / 9.0) * std::cos(row / 7.0) +
                                     300 * std::sin((column + 2 * row) / 23.0);
                          });
}

/// A sun over the grid, and what bands find of it.
struct Found {
    SunSky sky;
    SunBands bands;
    std::vector<float> edge_m;
    std::vector<int> band, times;  // of each post: the last one that had it, and how many

    Found(const DemSky& dem, const SunOverDem& sun)
        : sky(dem, sun), bands(*sky.bands(whole(dem.grid()), kSunTolerance_rad)) {}

    static std::size_t index(int column, int row) {
        return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }

    SweepSun sun_of(std::size_t at) const { return sky.sun(bands.tiles[at], sky.first_level(), 0); }

    void sweep(const Sweep& over, const SweepWindow& part) {
        edge_m.assign(std::size_t{kColumns} * kRows, kNobody);
        band.assign(edge_m.size(), -1);
        times.assign(edge_m.size(), 0);
        Sweep::Blocks::Sun moment{bands.over(part)};
        for (std::size_t k = 0; k < moment.bands.size(); ++k)
            moment.bands[k].suns = {{sun_of(k)}};
        Sweep::Blocks blocks(over, {moment}, part, sky.dem().floor_m(), sky.dem().curvature());
        while (blocks.next())
            for (std::size_t k = 0; k < moment.bands.size(); ++k)
                blocks.each_edge(0, k, 0, [&](const SweepRun& run, const float* const*) {
                    for (int i = 0; i < run.count; ++i) {
                        const std::size_t at = run.along_column ? index(run.line, run.first + i)
                                                                : index(run.first + i, run.line);
                        edge_m[at] = run.found[i];
                        band[at] = static_cast<int>(k);
                        ++times[at];
                    }
                });
    }
};

/// Where the rays of a path go at a post, on the ground.
glm::dvec2 way_at(const SunSky& sky, const SweepSun& sun, int column, int row) {
    const SweepSun path = sky.along_columns() ? sun.transposed() : sun;
    const double s = path.distance_m(sky.along_columns() ? column : row);
    const auto slope = [s](double first, double second, double third) {
        return (third / 2 * s + second) * s + first;
    };
    return glm::normalize(glm::dvec2(slope(sun.towards.column, sun.bend.column, sun.twist.column),
                                     slope(sun.towards.row, sun.bend.row, sun.twist.row)) *
                          sky.dem().spacing_m());
}

struct Errors {
    std::vector<double> way, elevation_deg, edge_m;  // way: as share of what is allowed
};

/// Against the ray through a post itself.
void compare_post(const Found& found, const Sweep& sweep, int column, int row, Errors& errors) {
    const SweepWindow post{column, row, 1, 1};
    const SweepSun own = found.sky.sun(*found.sky.tile(post), found.sky.first_level(), 0);
    const std::size_t at = Found::index(column, row);
    const SweepSun sun = found.sun_of(static_cast<std::size_t>(found.band[at]));
    const glm::dvec2 a = way_at(found.sky, own, column, row),
                     b = way_at(found.sky, sun, column, row);
    // A tenth of a post is, wherever the sun's shade ends.
    const double reach_m = found.sky.reach_m(std::atan(own.tangent_at(column, row)));
    const double allowed_rad =
        std::max(kSunTolerance_rad, found.sky.dem().widest_spacing_m() / 10 / reach_m);
    errors.way.push_back(std::abs(std::asin(a.x * b.y - a.y * b.x)) / allowed_rad);
    errors.elevation_deg.push_back(degrees(
        std::abs(std::atan(own.tangent_at(column, row)) - std::atan(sun.tangent_at(column, row)))));
    float edge_m = 0;
    sweep.each_edge(
        own, post, [&](const SweepRun& run) { edge_m = run.found[0]; }, Sweep::kMostLanes,
        found.sky.dem().floor_m());
    errors.edge_m.push_back(std::abs(double{edge_m} - double{found.edge_m[at]}));
}

double mean(const std::vector<double>& numbers) {
    double sum = 0;
    for (const double number : numbers)
        sum += number;
    return sum / static_cast<double>(numbers.size());
}

double quantile(std::vector<double> numbers, double share) {
    std::sort(numbers.begin(), numbers.end());
    return numbers[static_cast<std::size_t>(share * static_cast<double>(numbers.size() - 1))];
}

TEST(Bands, EveryPostHasTheEdgeOfItsOwnRay) {
    const dem::Heightfield field = turned_degrees();
    const dem::Posts posts(field);
    const DemSky dem(posts, {});
    const Sweep sweep = sweep_over(posts);
    std::mt19937 random(1);
    Errors errors;
    for (const double azimuth_deg : {10.0, 80.0, 140.0, 200.0, 265.0, 330.0})
        for (const double elevation_deg : {4.0, 12.0, 35.0}) {
            Found found(dem, {radians(azimuth_deg), radians(elevation_deg), 0});
            EXPECT_GT(found.bands.tiles.size(), 2U) << azimuth_deg;
            found.sweep(sweep, whole(posts.grid()));
            ASSERT_TRUE(std::all_of(found.times.begin(), found.times.end(),
                                    [](int times) { return times == 1; }))
                << azimuth_deg << " " << elevation_deg;
            for (int i = 0; i < 40; ++i)
                compare_post(found, sweep, static_cast<int>(random() % kColumns),
                             static_cast<int>(random() % kRows), errors);
        }
    fmt::print(
        "[ accuracy ] bands, {} posts against rays of their own: azimuth mean {:.2f} of what is "
        "allowed, worst "
        "{:.2f}, elevation mean {:.4f}, worst {:.4f}; edges median {:.2f} m, 99 % within {:.1f}\n",
        errors.edge_m.size(), mean(errors.way), quantile(errors.way, 1), mean(errors.elevation_deg),
        quantile(errors.elevation_deg, 1), quantile(errors.edge_m, 0.5),
        quantile(errors.edge_m, 0.99));
    EXPECT_LE(mean(errors.way), 0.6);
    EXPECT_LE(quantile(errors.way, 1), 1.6);
    EXPECT_LE(quantile(errors.elevation_deg, 1), 0.045);
    EXPECT_LE(quantile(errors.edge_m, 0.5), 0.3);
    EXPECT_LE(quantile(errors.edge_m, 0.99), 3);
}

TEST(Bands, APartHasTheBitsOfTheWhole) {
    const dem::Heightfield field = turned_degrees();
    const dem::Posts posts(field);
    const DemSky dem(posts, {});
    const Sweep sweep = sweep_over(posts);
    const SweepWindow part{101, 57, 150, 131};
    for (const double azimuth_deg : {10.0, 80.0, 140.0, 200.0, 265.0, 330.0})
        for (const double elevation_deg : {-0.5, 3.0, 20.0}) {
            Found all(dem, {radians(azimuth_deg), radians(elevation_deg), 0}), some = all;
            all.sweep(sweep, whole(posts.grid()));
            some.sweep(sweep, part);
            int others = 0;
            for (int row = part.row; row < part.row + part.rows; ++row)
                for (int column = part.column; column < part.column + part.columns; ++column) {
                    const std::size_t at = Found::index(column, row);
                    others += some.times[at] != 1 || some.edge_m[at] != all.edge_m[at];
                }
            EXPECT_EQ(others, 0) << azimuth_deg << " " << elevation_deg;
        }
}

}  // namespace
}  // namespace relevo::light
