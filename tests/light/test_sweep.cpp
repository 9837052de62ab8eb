#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/sweep/kernels.h"
#include "light/sweep/sweep.h"
#include "support/support.h"

namespace relevo::light::test_sweep {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
constexpr float kNone = -std::numeric_limits<float>::infinity();

using Heights = Array2d<float>;

Heights heights_of(int columns, int rows, const std::function<double(int, int)>& height_m) {
    Heights heights(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            heights.at(column, row) = static_cast<float>(height_m(column, row));
    return heights;
}

/// A sun over a plane or round map, by its azimuth from the top of the grid, clockwise.
struct MapSun {
    double azimuth_deg, elevation_deg;
    glm::dvec2 spacing_m{30, 30};
    double curvature = 0;

    glm::dvec2 direction() const {
        // Exact for the compass rose.
        const auto part = [](double deg) {
            const double turned = std::remainder(deg, 360);
            return std::abs(turned) == 90 ? 0.0 : std::cos(radians(turned));
        };
        return {part(azimuth_deg - 90), -part(azimuth_deg)};
    }
    SweepSun over(const Heights& heights) const {
        return sun_over_map(spacing_m, direction(), radians(elevation_deg),
                            {(heights.width() - 1) / 2.0, (heights.height() - 1) / 2.0}, curvature);
    }
};

Heights edge_of(const Heights& heights, const SweepSun& sun, const Window& window,
                float floor_m = Sweep::kNoFloor_m) {
    Heights edge(window.columns, window.rows);
    Sweep(heights.data(), heights.width(), heights.height(), heights.width())
        .each_shadow(sun, {window}, floor_m, [&](const SweepRun& run) {
            std::copy_n(run.found, run.count,
                        &edge.at(run.column - window.column, run.row - window.row));
        });
    return edge;
}
Heights edge_of(const Heights& heights, const SweepSun& sun) {
    return edge_of(heights, sun, {0, 0, heights.width(), heights.height()});
}

/// The same for one post in double precision: its own ray over all crossings with rows and columns,
/// heights linear from post to post.
/// @param highest_m  of all; edges below the post's own height minus a metre are not looked for
double marched_edge_m(const Heights& heights, const MapSun& map, int column, int row,
                      double highest_m) {
    const SweepSun sun = map.over(heights);
    const double tangent = sun.tangent_at(column, row);
    const double a_metre = map.curvature * (1 + sun.tangent * sun.tangent);
    double edge_m = kNone;
    const double least_m =
        std::isnan(heights.at(column, row)) ? -1e9 : heights.at(column, row) - 1.0;
    const auto crossing = [&](double c, double r, bool on_row) {
        const double s = std::hypot((c - column) * map.spacing_m.x, (r - row) * map.spacing_m.y);
        const double at = on_row ? c : r, last = (on_row ? heights.width() : heights.height()) - 1;
        if (at < -1e-9 || at > last + 1e-9) return false;
        const double fall = tangent * s + a_metre * s * s / 2;
        if (tangent > 0 && highest_m - fall < std::max(edge_m, least_m)) return false;
        const double near = std::round(at), low = std::min(std::floor(at), last - 1);
        const auto height = [&](double k) {
            return double{on_row ? heights.at(static_cast<int>(k), static_cast<int>(r))
                                 : heights.at(static_cast<int>(c), static_cast<int>(k))};
        };
        const double h = std::abs(at - near) < 1e-6
                             ? height(near)
                             : height(low) + (at - low) * (height(low + 1) - height(low));
        if (!std::isnan(h)) edge_m = std::max(edge_m, h - fall);
        return true;
    };
    const glm::dvec2 way = sun.ray.first;
    for (int r = row + (way.y > 0 ? 1 : -1);
         way.y != 0 && r >= 0 && r<heights.height(); r += way.y> 0 ? 1 : -1)
        if (!crossing(column + (r - row) / way.y * way.x, r, true)) break;
    for (int c = column + (way.x > 0 ? 1 : -1);
         way.x != 0 && c >= 0 && c<heights.width(); c += way.x> 0 ? 1 : -1)
        if (!crossing(c, row + (c - column) / way.x * way.y, false)) break;
    return edge_m;
}

/// @return the posts of a window
Heights marched_edges(const Heights& heights, const MapSun& sun, const Window& window) {
    Heights edges(window.columns, window.rows);
    const double highest_m = dem::statistics(heights).max_m;
    parallel_for(0, window.rows, 1, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < window.columns; ++column)
                edges.at(column, row) = static_cast<float>(marched_edge_m(
                    heights, sun, window.column + column, window.row + row, highest_m));
    });
    return edges;
}

struct Difference {
    int posts = 0;      // that have a height
    int differ = 0;     // lit in one and not in the other
    int shaded = 0;     // of these, those that the march lights
    int far_off = 0;    // of these, those more than a post away from the true line
    float worst_m = 0;  // of the margin, where they differ
};

Difference compare(const Heights& heights, const Heights& edge, const Heights& truth) {
    const auto lit = [&](const Heights& of, int c, int r) {
        return heights.at(c, r) >= of.at(c, r);
    };
    Difference found;
    for (int r = 0; r < heights.height(); ++r)
        for (int c = 0; c < heights.width(); ++c) {
            if (std::isnan(heights.at(c, r))) continue;
            ++found.posts;
            if (lit(edge, c, r) == lit(truth, c, r)) continue;
            ++found.differ;
            found.shaded += lit(truth, c, r);
            found.worst_m = std::max(found.worst_m, std::abs(heights.at(c, r) - truth.at(c, r)));
            bool beside = false;  // the true line runs between this post and one next to it
            for (int y = std::max(0, r - 1); y <= std::min(heights.height() - 1, r + 1); ++y)
                for (int x = std::max(0, c - 1); x <= std::min(heights.width() - 1, c + 1); ++x)
                    beside = beside || lit(truth, x, y) != lit(truth, c, r);
            found.far_off += !beside;
        }
    return found;
}

const std::vector<double> kAzimuths{0,   22.5,  44.9,  45,    45.1, 67.5,  89.9,
                                    90,  112.5, 135,   170,   180,  202.5, 224.9,
                                    225, 247.5, 270.1, 292.5, 315,  337.5};

/// Shares of posts that a sweep and a march of every post disagree about, for suns of all azimuths.
void compare_all(const std::string& name, const Heights& heights, const glm::dvec2& spacing_m,
                 const Window& window) {
    Heights inside(window.columns, window.rows);
    for (int row = 0; row < window.rows; ++row)
        for (int column = 0; column < window.columns; ++column)
            inside.at(column, row) = heights.at(window.column + column, window.row + row);
    for (const double elevation_deg : {2.0, 5.0, 10.0, 20.0, 35.0, 60.0}) {
        std::vector<double> shares;
        double worst_m = 0;
        long posts = 0, differ = 0, shaded = 0, far_off = 0;
        for (const double azimuth_deg : kAzimuths) {
            const MapSun sun{azimuth_deg, elevation_deg, spacing_m, 0.87 / 6371000};
            const Difference found = compare(inside, edge_of(heights, sun.over(heights), window),
                                             marched_edges(heights, sun, window));
            shares.push_back(100.0 * found.differ / found.posts);
            worst_m = std::max(worst_m, double{found.worst_m});
            posts += found.posts;
            differ += found.differ;
            shaded += found.shaded;
            far_off += found.far_off;
        }
        test::print_accuracy(
            fmt::format(
                "{}, sun at {} degrees: of {} posts {} lit otherwise than by a march, {} "
                "of them shaded, {} not beside the true line; margins there up to {:.2f} m; "
                "shares by azimuth",
                name, elevation_deg, posts, differ, shaded, far_off, worst_m),
            shares, "%", 0.3);
        EXPECT_LT(*std::max_element(shares.begin(), shares.end()), 0.3);
        EXPECT_LE(far_off, differ / 50 + 2);
    }
}

TEST(Sweep, ShadesAsAMarchOfEveryPostDoes) {
    const Heights& heights = test::bundled("jacksboro.tif").height_m;
    compare_all("jacksboro", heights, {75, 92}, {150, 120, 150, 150});
}

TEST(Sweep, ShadesRealMountainsAsAMarchOfEveryPostDoes) {
    SKIP_WITHOUT_TEST_DATA(data);
    compare_all("bigtujunga",
                dem::load((data / "dem" / "srtm_bigtujunga30m_utm11.tif").string()).height_m,
                {30, 30}, {500, 200, 150, 150});
}

/// The least and the largest of what b is more than a, where either is no less than `least_m`.
void expect_near(const Heights& a, const Heights& b, double tolerance_m, double least_m) {
    ASSERT_EQ(a.size(), b.size());
    double worst_m = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!(a.data()[i] >= least_m || b.data()[i] >= least_m)) continue;
        worst_m = std::max(worst_m, std::abs(double{a.data()[i]} - b.data()[i]));
    }
    EXPECT_LE(worst_m, tolerance_m);
}

TEST(Sweep, AThinWallBetweenNearRowsAndFarOnesShades) {
    // Two posts, between which the rays of the posts four and five rows behind them pass.
    constexpr int kAt = 20;
    for (const bool along_columns : {false, true})
        for (const int side : {-1, 1})
            for (const int aside : {-4, -3, -2, -1, 1, 2, 3, 4}) {
                const Heights heights = heights_of(41, 41, [&](int c, int r) {
                    if (along_columns) std::swap(c, r);
                    return c == kAt && (r == kAt || r == kAt + side) ? 100 : 0;
                });
                const glm::dvec2 way(-aside, -4.5 * side);  // from the post to the sun
                glm::ivec2 post(kAt + aside, kAt + 5 * side);
                MapSun map{degrees(std::atan2(way.x, -way.y)), 10, {30, 30}, 0};
                if (along_columns) {
                    map.azimuth_deg = degrees(std::atan2(way.y, -way.x));
                    std::swap(post.x, post.y);
                }
                EXPECT_NEAR(edge_of(heights, map.over(heights)).at(post.x, post.y),
                            marched_edge_m(heights, map, post.x, post.y, 100), 1e-3)
                    << along_columns << " " << side << " " << aside;
            }
}

TEST(Sweep, WallCastsAShadowOfItsHeightOverTheTangent) {
    // 100 m high, along a column; the sun in the east and the north-east.
    const Heights wall =
        heights_of(200, 120, [](int column, int) { return column == 150 ? 100 : 0; });
    for (const double azimuth_deg : {90.0, 45.0, 60.0, 100.0, 135.0}) {
        const MapSun sun{azimuth_deg, 10, {20, 30}};
        const Heights edge = edge_of(wall, sun.over(wall));
        const double across = std::sin(radians(azimuth_deg));
        double worst_m = 0;
        for (int column = 130; column < 150; ++column) {
            const double way_m = (150 - column) * 20 / across;
            worst_m = std::max(
                worst_m, std::abs(edge.at(column, 60) - (100 - way_m * std::tan(radians(10)))));
        }
        EXPECT_LT(worst_m, 0.001) << azimuth_deg;
        EXPECT_NEAR(edge.at(170, 60), edge.at(180, 60), 0.001) << "the side of the sun is level";
        EXPECT_LT(edge.at(170, 60), 0);
    }
}

/// Share of posts on which the edge and the formula disagree, and how far off the others are.
void expect_shade(const Heights& heights, const MapSun& sun,
                  const std::function<bool(double x_m, double y_m)>& shaded, double most_share) {
    const Heights edge = edge_of(heights, sun.over(heights));
    int differ = 0;
    for (int row = 0; row < heights.height(); ++row)
        for (int column = 0; column < heights.width(); ++column) {
            const double x_m = (column - (heights.width() - 1) / 2) * sun.spacing_m.x;
            const double y_m = ((heights.height() - 1) / 2 - row) * sun.spacing_m.y;
            differ += shaded(x_m, y_m) != (heights.at(column, row) < edge.at(column, row));
        }
    const double share = differ / double(heights.size());
    fmt::print("[ accuracy ] shade of a body, azimuth {}: {:.3f} % of posts differ (limit {})\n",
               sun.azimuth_deg, 100 * share, 100 * most_share);
    EXPECT_LE(share, most_share);
}

TEST(Sweep, ConeShadesTheTriangleBehindIt) {
    constexpr double kRadius_m = 600, kHeight_m = 500;
    const glm::dvec2 spacing{10, 14};
    const Heights cone = heights_of(401, 301, [&](int column, int row) {
        const double r_m = std::hypot((column - 200) * spacing.x, (150 - row) * spacing.y);
        return std::max(0.0, kHeight_m * (1 - r_m / kRadius_m));
    });
    for (const double azimuth_deg : {0.0, 30.0, 45.0, 77.0, 90.0, 200.0, 291.0}) {
        const MapSun sun{azimuth_deg, 20, spacing};
        const double tip_m = kHeight_m / std::tan(radians(20));
        const double sine = kRadius_m / tip_m;
        const glm::dvec2 to_sun = sun.direction();
        expect_shade(
            cone, sun,
            [&](double x_m, double y_m) {
                // Along and across the way from the sun; the tangents from the tip of the shadow to
                // the foot, and on the cone itself the lines where they touch, up to the top.
                const double along = -(x_m * to_sun.x - y_m * to_sun.y);
                const double across = std::abs(x_m * -to_sun.y - y_m * to_sun.x);
                const double touch = kRadius_m * sine;
                const double foot_across = kRadius_m * std::sqrt(1 - sine * sine);
                if (std::hypot(along, across) < kRadius_m)
                    return across * touch < along * foot_across;
                return along >= touch && along <= tip_m &&
                       across < (tip_m - along) * sine / std::sqrt(1 - sine * sine);
            },
            0.004);
    }
}

TEST(Sweep, PyramidFacesAreLitByTheirSlope) {
    // 30 degrees steep towards the four sides: a face turned from the sun is in the shade where the
    // sun is lower than the face is steep that way.
    const Heights pyramid = heights_of(201, 201, [](int column, int row) {
        const double from_m = 10.0 * std::max(std::abs(column - 100), std::abs(row - 100));
        return 1000 - from_m * std::tan(radians(30));
    });
    for (const double elevation_deg : {29.9, 30.1}) {
        const Heights edge = edge_of(pyramid, MapSun{180, elevation_deg, {10, 10}}.over(pyramid));
        EXPECT_EQ(pyramid.at(100, 40) < edge.at(100, 40), elevation_deg < 30);  // north
        EXPECT_GE(pyramid.at(100, 160), edge.at(100, 160));                     // south
        EXPECT_GE(pyramid.at(150, 100), edge.at(150, 100));                     // east: grazed
    }
}

TEST(Sweep, FlatGroundIsLitByAnySunOverIt) {
    const Heights plain = heights_of(300, 200, [](int, int) { return 1234; });
    for (const double azimuth_deg : kAzimuths)
        for (const double elevation_deg : {0.01, 1.0, 45.0, 89.999, 90.0}) {
            const Heights edge =
                edge_of(plain, MapSun{azimuth_deg, elevation_deg, {30, 20}}.over(plain));
            EXPECT_LE(*std::max_element(edge.begin(), edge.end()), 1234);
        }
}

TEST(Sweep, SunBelowShadesGroundThatIsNotTheFirst) {
    const Heights plain = heights_of(300, 200, [](int, int) { return 500; });
    const Heights edge = edge_of(plain, MapSun{90, -0.5}.over(plain));
    for (int column = 0; column < 299; ++column)
        EXPECT_GT(edge.at(column, 100), 500) << column;
    EXPECT_EQ(edge.at(299, 100), kNone) << "the sun's side of the grid";
    EXPECT_NEAR(edge.at(0, 100), 500 + 299 * 30 * std::tan(radians(0.5)), 0.01);
}

TEST(Sweep, ZenithLeavesNoShade) {
    const Heights& heights = test::bundled("jacksboro.tif").height_m;
    const Heights edge = edge_of(heights, MapSun{123, 90, {75, 92}}.over(heights));
    EXPECT_LT(*std::max_element(edge.begin(), edge.end()), -10000);
}

TEST(Sweep, TurnsWithTheGround) {
    const Heights all = test::bundled("jacksboro.tif").height_m;
    // Odd numbers: a post is in the middle, which lines are counted from.
    const int columns = 403, rows = 343;
    const Heights heights = heights_of(columns, rows, [&](int c, int r) { return all.at(c, r); });
    const glm::dvec2 spacing{75, 92};
    const Heights mirrored =
        heights_of(columns, rows, [&](int c, int r) { return heights.at(columns - 1 - c, r); });
    const Heights flipped =
        heights_of(columns, rows, [&](int c, int r) { return heights.at(c, rows - 1 - r); });
    const Heights turned =
        heights_of(rows, columns, [&](int c, int r) { return heights.at(r, c); });
    for (const double azimuth_deg : {0.0, 20.0, 45.0, 71.0, 90.0, 110.0, 205.0}) {
        const MapSun sun{azimuth_deg, 6, spacing, 0.87 / 6371000};
        const Heights edge = edge_of(heights, sun.over(heights));
        const auto edge_under = [&](const Heights& ground, double azimuth,
                                    const glm::dvec2& posts) {
            return edge_of(ground, MapSun{azimuth, 6, posts, sun.curvature}.over(ground));
        };
        const Heights a = edge_under(mirrored, -azimuth_deg, spacing);
        expect_near(
            edge, heights_of(columns, rows, [&](int c, int r) { return a.at(columns - 1 - c, r); }),
            0.01, 200);
        const Heights b = edge_under(flipped, 180 - azimuth_deg, spacing);
        expect_near(edge,
                    heights_of(columns, rows, [&](int c, int r) { return b.at(c, rows - 1 - r); }),
                    0.01, 200);
        const Heights d = edge_under(turned, 270 - azimuth_deg, {spacing.y, spacing.x});
        expect_near(edge, heights_of(columns, rows, [&](int c, int r) { return d.at(r, c); }), 0.01,
                    200);
    }
}

TEST(Sweep, HoldsTheSameBitsForAnyWidthOfVectorsAndAnyWindow) {
    const Heights& heights = test::bundled("jacksboro.tif").height_m;
    for (const double azimuth_deg : {0.0, 33.0, 90.0, 160.0, 250.0, 359.0}) {
        const SweepSun sun = MapSun{azimuth_deg, 4, {75, 92}, 0.87 / 6371000}.over(heights);
        const Heights whole = edge_of(heights, sun);
        for (const int floats : {1, 4, 8}) {
            set_widest_vector(floats);
            EXPECT_EQ(whole, edge_of(heights, sun)) << floats;
        }
        set_widest_vector(kVectorFloats);
        const Window window{37, 101, 201, 99};
        const Heights part = edge_of(heights, sun, window);
        for (int row = 0; row < window.rows; ++row)
            for (int column = 0; column < window.columns; ++column) {
                const float expected = whole.at(window.column + column, window.row + row);
                // Ground that is too far away to shade a window is left out.
                if (expected < 200) continue;
                ASSERT_EQ(part.at(column, row), expected) << column << " " << row;
            }
    }
}

TEST(Sweep, RaysAlongTheBorderHaveTheSameBitsForAnyWindow) {
    // Where a grid shows rays as bent, the line beside a post of the border may have met ground
    // before it left the grid: too far off to shade a window, but not the whole grid. The line on
    // the other side of the post has met the wall.
    const Heights heights =
        heights_of(403, 64, [](int column, int) { return column == 270 ? 3000 : 0; });
    const float floor_m = -300;
    const auto edge_of_window = [&](const SweepSun& sun, const Window& window) {
        return edge_of(heights, sun, window, floor_m);
    };
    const Window whole{0, 0, heights.width(), heights.height()};
    const Window part{300, 0, 90, heights.height()};
    for (const auto& [reference, turn, bend] :
         {std::array{386.0, 7e-7, 1.3e-9}, std::array{254.0, 1.6e-7, 4.8e-9},
          std::array{378.0, -2e-6, 1.4e-9}, std::array{384.0, 1.9e-5, 1.8e-11}}) {
        SweepSun sun = MapSun{270, 12, {75, 92}, 0.87 / 6371000}.over(heights);
        sun.ray.reference = {reference, 31};
        sun.ray.first.y = turn;
        sun.ray.second.y = bend;
        const Heights all = edge_of_window(sun, whole), some = edge_of_window(sun, part);
        for (int row = 0; row < part.rows; ++row)
            for (int column = 0; column < part.columns; ++column)
                ASSERT_EQ(some.at(column, row), all.at(part.column + column, row))
                    << reference << ": " << column << " " << row;
    }
}

TEST(Sweep, ARayThatTurnsBackBeforeItsGroundIsFollowedFromWhereItComes) {
    // Wherever the ray turns among the rows that are followed together.
    for (int turn = 40; turn < 110; turn += 3) {
        const int wall = turn + 5;
        const Heights heights =
            heights_of(60, 200, [&](int, int row) { return row == wall ? 500.0 : 0.0; });
        SweepSun sun;
        sun.ray.reference = {30, wall + 25.0};
        sun.ray.first = {0, -0.01};
        sun.ray.second = {0, 1e-4 / (2 * (sun.ray.reference.y - turn - 0.3))};
        sun.tangent = 0.1;
        ASSERT_TRUE(std::isnan(sun.ray.distance_m(turn - 1))) << turn;
        const Window window{0, wall + 10, 60, 30};
        const Heights edge = edge_of(heights, sun, window);
        for (int row = 0; row < window.rows; ++row) {
            const double way_m = sun.ray.distance_m(wall) - sun.ray.distance_m(window.row + row);
            EXPECT_NEAR(edge.at(30, row), 500 - sun.tangent * way_m, 0.01) << turn << ", " << row;
        }
    }
}

TEST(Sweep, HolesNeitherShadeNorSpoilWhatIsBesideThem) {
    // A ridge with a gap that is a hole: the sun shines through it.
    const auto ridge = [](bool gap) {
        return heights_of(120, 90, [=](int column, int row) {
            return column != 80 ? 0.0F : gap && row >= 40 && row < 50 ? kHole : 100.0F;
        });
    };
    const Heights whole = ridge(false), holed = ridge(true);
    const SweepSun sun = MapSun{90, 10}.over(whole);
    const Heights a = edge_of(whole, sun), b = edge_of(holed, sun);
    for (int row = 0; row < 90; ++row) {
        const bool open = row >= 40 && row < 50;
        EXPECT_EQ(b.at(70, row) > 0, !open) << row;
        if (!open) {
            EXPECT_EQ(a.at(70, row), b.at(70, row)) << row;
        }
    }
    const Heights none = heights_of(50, 40, [](int, int) { return kHole; });
    for (const float edge_m : edge_of(none, MapSun{70, 5}.over(none)))
        EXPECT_EQ(edge_m, kNone);
}

TEST(Sweep, OneRowOrOneColumnIsGroundToo) {
    for (const double azimuth_deg : {0.0, 90.0, 100.0, 215.0}) {
        const MapSun sun{azimuth_deg, 10};
        const Heights row =
            heights_of(60, 1, [](int column, int) { return column == 30 ? 50 : 0; });
        const Heights edge = edge_of(row, sun.over(row));
        EXPECT_EQ(edge.at(29, 0) > 0, azimuth_deg == 90) << azimuth_deg;
        const Heights column = heights_of(1, 60, [](int, int r) { return r == 30 ? 50 : 0; });
        EXPECT_EQ(edge_of(column, sun.over(column)).at(0, 31) > 0, azimuth_deg == 0) << azimuth_deg;
    }
}

}  // namespace
}  // namespace relevo::light::test_sweep
