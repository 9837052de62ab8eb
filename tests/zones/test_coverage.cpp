// Shares of cells that outlines enclose, against clipping by hand.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "zones/coverage.h"

namespace relevo::zones::test_coverage {
namespace {

constexpr Window kAll{0, 0, 12, 9};

double share(const std::vector<double>& shares, int column, int row, const Window& window = kAll) {
    return shares[static_cast<std::size_t>((row - window.row) * window.columns + column -
                                           window.column)];
}

double sum(const std::vector<double>& shares) {
    double sum = 0;
    for (const double share : shares)
        sum += share;
    return sum;
}

std::vector<double> shares_of(const std::vector<Ring>& rings, const Window& window = kAll) {
    return coverage(even_odd_edges(rings), window);
}

Ring box(double left, double top, double right, double bottom) {
    return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

/// Area of a cell that lies in a convex ring, by Sutherland and Hodgman's clipping.
double clipped(const Ring& convex, int column, int row) {
    Ring part = box(column, row, column + 1, row + 1);
    for (std::size_t i = 0; i < convex.size(); ++i) {
        const glm::dvec2 a = convex[i], b = convex[(i + 1) % convex.size()];
        const auto side = [&](const glm::dvec2& at) {
            return (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
        };
        Ring kept;
        for (std::size_t k = 0; k < part.size(); ++k) {
            const glm::dvec2 from = part[k], to = part[(k + 1) % part.size()];
            const double s = side(from), t = side(to);
            if (s >= 0) kept.push_back(from);
            if ((s < 0) != (t < 0)) kept.push_back(from + s / (s - t) * (to - from));
        }
        part = kept;
    }
    double doubled = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
        const glm::dvec2 a = part[k], b = part[(k + 1) % part.size()];
        doubled += a.x * b.y - a.y * b.x;
    }
    return std::abs(doubled) / 2;
}

TEST(Coverage, OfConvexOutlinesIsWhatClippingLeaves) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0;
    for (int trial = 0; trial < 400; ++trial) {
        // Corners on an ellipse, which may reach beyond the window.
        const glm::dvec2 middle(14 * unit(random) - 1, 11 * unit(random) - 1);
        const glm::dvec2 radius(0.05 + 6 * unit(random), 0.05 + 5 * unit(random));
        std::vector<double> turns;
        for (int i = 0; i < 3 + trial % 6; ++i)
            turns.push_back(2 * kPi * unit(random));
        std::ranges::sort(turns);
        Ring ring;
        for (const double turn : turns)
            ring.push_back(middle + radius * glm::dvec2(std::cos(turn), std::sin(turn)));
        Ring given = ring;
        if (trial % 2 == 1) std::ranges::reverse(given);  // the direction does not matter
        const std::vector<double> shares = shares_of({given});
        for (int row = 0; row < kAll.rows; ++row)
            for (int column = 0; column < kAll.columns; ++column)
                worst = std::max(worst,
                                 std::abs(share(shares, column, row) - clipped(ring, column, row)));
    }
    fmt::print("[ accuracy ] shares of cells: worst error {:.1e}\n", worst);
    EXPECT_LT(worst, 1e-12);
}

TEST(Coverage, FollowsTheEvenOddRule) {
    // A hole, and an island in it.
    EXPECT_NEAR(sum(shares_of({box(1, 1, 9, 8), box(2.5, 2, 8, 7), box(3, 3, 4, 4.5)})),
                56 - 27.5 + 1.5, 1e-12);
    // A bow tie: corners in the order of a figure of eight.
    const std::vector<double> tie = shares_of({{{1, 1}, {5, 5}, {5, 1}, {1, 5}}});
    EXPECT_NEAR(sum(tie), 8, 1e-12);
    EXPECT_NEAR(share(tie, 1, 1), 0.5, 1e-12);
    EXPECT_NEAR(share(tie, 2, 1), 0, 1e-12);
    // A pentagram, whose level side others cross: its points alone.
    Ring star;
    for (const int corner : {0, 2, 4, 1, 3})
        star.push_back(glm::dvec2(6, 5) + 4.0 * glm::dvec2(std::sin(0.4 * kPi * corner),
                                                           -std::cos(0.4 * kPi * corner)));
    EXPECT_NEAR(sum(shares_of({star})), 16 * 0.775676752, 1e-6);
    // The same with a corner where it crosses.
    EXPECT_NEAR(sum(shares_of({{{1, 1}, {3, 3}, {5, 5}, {5, 1}, {3, 3}, {1, 5}}})), 8, 1e-12);
    // Two boxes that lie partly on each other; their upper and lower sides are one line.
    const std::vector<double> overlap = shares_of({box(0, 0, 2, 1), box(1, 0, 3, 1)});
    EXPECT_NEAR(share(overlap, 0, 0), 1, 1e-12);
    EXPECT_NEAR(share(overlap, 1, 0), 0, 1e-12);
    EXPECT_NEAR(share(overlap, 2, 0), 1, 1e-12);
    // Parts that touch, a hole that touches, a spike, and a ring that goes round twice.
    EXPECT_NEAR(sum(shares_of({box(1, 1, 3, 3), box(3, 1, 4, 3)})), 6, 1e-12);
    EXPECT_NEAR(sum(shares_of({box(1, 1, 6, 6), box(1, 2, 3, 4)})), 21, 1e-12);
    EXPECT_NEAR(sum(shares_of({{{1, 1}, {4, 1}, {4, 8}, {4, 4}, {1, 4}}})), 9, 1e-12);
    Ring twice = box(1, 1, 4, 4);
    twice.insert(twice.end(), twice.begin(), twice.begin() + 4);
    EXPECT_NEAR(sum(shares_of({twice})), 0, 1e-12);
}

TEST(Coverage, OfPartsOfAWindowIsTheSame) {
    const std::vector<Ring> rings{{{-3, 2.2}, {7.7, -4}, {15, 5.5}, {6, 12}}, box(4, 3, 6.5, 4.1)};
    const std::vector<Edge> edges = even_odd_edges(rings);
    const std::vector<double> whole = coverage(edges, kAll);
    for (const Window part : {Window{0, 0, 12, 4}, Window{3, 4, 5, 5}, Window{11, 8, 1, 1}}) {
        const std::vector<double> shares = coverage(edges, part);
        for (int row = part.row; row < part.end_row(); ++row)
            for (int column = part.column; column < part.end_column(); ++column)
                EXPECT_NEAR(share(shares, column, row, part), share(whole, column, row), 1e-12);
    }
    EXPECT_EQ(cells_of(edges, kAll), kAll);
    EXPECT_TRUE(cells_of(even_odd_edges(std::vector<Ring>{box(20, 0, 22, 3)}), kAll).is_empty());
}

TEST(Coverage, AreaIsThatOfTheOutlineEverywhere) {
    EXPECT_NEAR(area(even_odd_edges(std::vector<Ring>{box(-5, -5, 25, 15), box(0, 0, 2, 2)})), 596,
                1e-9);
    EXPECT_NEAR(
        area(even_odd_edges(std::vector<Ring>{{{1e7, 1e7}, {1e7 + 3, 1e7}, {1e7, 1e7 + 2}}})), 3,
        1e-8);
    EXPECT_TRUE(even_odd_edges(std::vector<Ring>{{{0, 1}, {5, 1}, {2, 1}}}).empty());
}

}  // namespace
}  // namespace relevo::zones::test_coverage
