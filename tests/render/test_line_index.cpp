// The index of lines, read as shaders/lib/lines.glsl reads it, against distances to all segments.

#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "render/line_index.h"
#include "support/support.h"

namespace relevo::render::test_line_index {
namespace {

constexpr double kSpacing_m = 10;

LineIndexOptions options(int side_posts) {
    return {.size_posts = glm::ivec2(side_posts), .metres_per_post = [](const glm::dvec2&) {
                return glm::dmat2(glm::dvec2(kSpacing_m, 0), glm::dvec2(0, -kSpacing_m));
            }};
}

dem::PlacedLine line_of(std::vector<glm::dvec2> posts, int number) {
    dem::PlacedLine line{.posts = std::move(posts), .value = 7.5 * number, .number = number};
    double along_m = 0;
    for (std::size_t i = 0; i < line.posts.size(); ++i) {
        if (i > 0) along_m += kSpacing_m * distance(line.posts[i], line.posts[i - 1]);
        line.along_m.push_back(along_m);
    }
    return line;
}

/// Wandering lines around the middle of a DEM.
std::vector<dem::PlacedLine> wandering(int lines, int vertices, double step, double side,
                                       double turn) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    std::normal_distribution<double> normal;
    std::vector<dem::PlacedLine> result;
    for (int i = 0; i < lines; ++i) {
        glm::dvec2 at(share(random) * side, share(random) * side);
        double heading = 6.28 * share(random);
        std::vector<glm::dvec2> posts;
        for (int k = 0; k < vertices; ++k) {
            posts.push_back(at);
            heading += turn * normal(random);
            const bool leaves =
                at != glm::clamp(at, glm::dvec2(0.05 * side), glm::dvec2(0.95 * side));
            if (leaves) heading = std::atan2(0.5 * side - at.y, 0.5 * side - at.x);
            at += step * glm::dvec2(std::cos(heading), std::sin(heading));
        }
        result.push_back(line_of(posts, i));
    }
    return result;
}

struct Nearest {
    double posts = 1e30;  ///< distance
    double along_m = 0;
    int line = -1;
};

void take(Nearest& nearest, const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b,
          double along_m, int line) {
    const glm::dvec2 way = b - a;
    const double t = glm::clamp(dot(p - a, way) / std::max(dot(way, way), 1e-30), 0.0, 1.0);
    const double away = distance(p, a + t * way);
    if (away < nearest.posts) nearest = {away, along_m + t * kSpacing_m * length(way), line};
}

Nearest brute_force(const std::vector<dem::PlacedLine>& lines, const glm::dvec2& p) {
    Nearest nearest;
    for (const dem::PlacedLine& line : lines)
        for (std::size_t i = 0; i + 1 < line.posts.size(); ++i)
            take(nearest, p, line.posts[i], line.posts[i + 1], line.along_m[i], line.number);
    return nearest;
}

/// What shaders/lib/lines.glsl does, in double precision.
class Reader {
  public:
    explicit Reader(const LineIndex& index) : texels_(index.texels) {}

    /// @param segments  number in the cell
    Nearest find(const glm::dvec2& p, double reach, int* segments = nullptr) const {
        const glm::vec4 head = texel(0);
        if (head.x < head.y) return {};
        int node = find_node(p, static_cast<int>(std::ceil(std::log2(2 * reach))));
        if (segments) *segments = node ? static_cast<int>(texel(node).x) : 0;
        if (node == 0) return {};
        const int count = static_cast<int>(texel(node).x);
        const glm::dvec2 here = from(p, texel(node + 1));
        Nearest nearest;
        for (int i = 0; i < count; ++i) {
            const glm::vec4 ends = texel(node + 4 + i), two = texel(node + 4 + count + i / 2);
            take(nearest, here, {ends.x, ends.y}, {ends.z, ends.w}, i % 2 ? two.z : two.x,
                 static_cast<int>(i % 2 ? two.w : two.y));
        }
        return nearest;
    }

    float value(int line) const { return texel(static_cast<int>(texel(0).w) + line).x; }

  private:
    const glm::vec4& texel(int address) const { return texels_[static_cast<std::size_t>(address)]; }
    static glm::dvec2 from(const glm::dvec2& p, const glm::vec4& corner) {
        return p - glm::dvec2(corner.x, corner.y) - glm::dvec2(corner.z, corner.w);
    }

    int find_node(const glm::dvec2& p, int level) const {
        const int top = static_cast<int>(texel(0).x), base = static_cast<int>(texel(0).y);
        const int table = std::clamp(level, base, top);
        const glm::vec4 size = texel(2 + 2 * (top - table));
        const glm::dvec2 cell =
            glm::floor(from(p, texel(1 + 2 * (top - table))) * std::exp2(-table));
        if (cell.x < 0 || cell.y < 0 || cell.x >= size.x || cell.y >= size.y) return 0;
        int node = static_cast<int>(texel(static_cast<int>(size.z + cell.y * size.x + cell.x)).x);
        while (node != 0 && texel(node).y == 0 && texel(node).z > static_cast<float>(level)) {
            const glm::dvec2 half = from(p, texel(node + 1)) * std::exp2(1.0 - texel(node).z);
            node = static_cast<int>(texel(node + 3)[(half.x < 1 ? 0 : 1) + (half.y < 1 ? 0 : 2)]);
        }
        return node;
    }

    const std::vector<glm::vec4>& texels_;
};

TEST(LineIndex, HasTheDistancesThatAllSegmentsGive) {
    constexpr int kSide = 1000;
    const auto lines = wandering(30, 400, 2.7, kSide, 0.4);
    const LineIndex index = make_line_index(lines, options(kSide));
    EXPECT_LT(index.accuracy_m, 0.01);
    const Reader reader(index);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-3, kSide + 3);
    double sum = 0;
    int most = 0;
    for (const double reach : {0.001, 0.05, 0.4, 3.0, 15.0}) {
        double worst = 0, worst_along_m = 0;
        int within = 0;
        for (int i = 0; i < 3000; ++i) {
            // Near a line, for there are few such places.
            const dem::PlacedLine& line = lines[random() % lines.size()];
            glm::dvec2 p = line.posts[random() % line.posts.size()];
            p += glm::dvec2(place(random), place(random)) * (2 * reach / kSide) - reach;
            int segments = 0;
            const Nearest found = reader.find(p, reach, &segments), truth = brute_force(lines, p);
            sum += segments;
            most = std::max(most, segments);
            if (segments == 1023) continue;  // some are dropped
            if (truth.posts > reach) {
                ASSERT_GT(found.posts, 0.99 * reach);
                continue;
            }
            ++within;
            worst = std::max(worst, std::abs(found.posts - truth.posts));
            if (found.line == truth.line)
                worst_along_m = std::max(worst_along_m, std::abs(found.along_m - truth.along_m));
        }
        fmt::print(
            "[ accuracy ] reach {} posts: {} places within, worst {:.2g} of the reach, "
            "along {:.2g} m\n",
            reach, within, worst / reach, worst_along_m);
        EXPECT_GT(within, 500);
        // A cell has a side of 2 to 4 reaches, and its lines are simplified to 1 / 2048 of that.
        EXPECT_LT(worst, std::max(4 * reach, 0.25) / 2048 * 1.001 + 2e-5);
    }
    fmt::print("[ cost ] {:.1f} segments in a cell on average, {} at most; {} KiB\n",
               sum / (5 * 3000), most, index.texels.size() / 64);
    EXPECT_LT(most, 1024);
}

TEST(LineIndex, IsExactWhereFewSegmentsAreNear) {
    // A thousandth of a pixel is 0.001 / 3 of a reach of three pixels.
    constexpr int kSide = 4000;
    const auto lines = wandering(12, 30, 100, kSide, 0.3);
    const LineIndex index = make_line_index(lines, options(kSide));
    const Reader reader(index);
    std::mt19937 random(2);
    for (const double reach : {0.01, 1.0, 30.0})
        for (int i = 0; i < 2000; ++i) {
            const dem::PlacedLine& line = lines[random() % lines.size()];
            const std::size_t k = random() % (line.posts.size() - 1);
            const glm::dvec2 p = 0.3 * line.posts[k] + 0.7 * line.posts[k + 1] +
                                 reach * glm::dvec2(random() % 1000, random() % 1000) / 1000.0 -
                                 0.5 * reach;
            const Nearest truth = brute_force(lines, p);
            if (truth.posts > reach) continue;
            EXPECT_NEAR(reader.find(p, reach).posts, truth.posts, 1e-4 * reach + 2e-5);  // 0.2 mm
        }
}

TEST(LineIndex, HasTheAttributes) {
    auto lines = wandering(3, 10, 5, 100, 0.3);
    lines[1].value = std::nan("");
    const LineIndex index = make_line_index(lines, options(100));
    const Reader reader(index);
    EXPECT_EQ(reader.value(0), 0);
    EXPECT_EQ(reader.value(1), kNoLineValue);
    EXPECT_EQ(reader.value(2), 15);
}

TEST(LineIndex, StaysWithinItsTexels) {
    const auto lines = wandering(200, 500, 1.0, 300, 0.5);
    LineIndexOptions few = options(300);
    const LineIndex whole = make_line_index(lines, few);
    few.max_texels = whole.texels.size() / 4;
    const LineIndex coarse = make_line_index(lines, few);
    EXPECT_LE(coarse.texels.size(), few.max_texels);
    EXPECT_GT(coarse.accuracy_m, whole.accuracy_m);
    fmt::print("[ accuracy ] {} texels: {:.2g} m; {} texels: {:.2g} m, {} dropped\n",
               whole.texels.size(), whole.accuracy_m, coarse.texels.size(), coarse.accuracy_m,
               coarse.dropped);
}

TEST(LineIndex, TakesWhatIsDegenerate) {
    const auto build = [](std::vector<glm::dvec2> posts) {
        return make_line_index({line_of(std::move(posts), 0)}, options(100));
    };
    EXPECT_NEAR(Reader(build({{5, 5}, {5, 5}})).find({5, 6}, 2).posts, 1, 1e-6);
    EXPECT_NEAR(Reader(build({{-1e7, 50}, {1e7, 50}})).find({50, 49.5}, 2).posts, 0.5, 1e-5);
    EXPECT_EQ(build({{500, 500}, {600, 600}}).texels.size(), 1U);
    EXPECT_EQ(make_line_index({}, options(100)).texels.size(), 1U);
}

TEST(LineIndex, TakesTwoThousandLinesOnOnePlace) {
    std::vector<dem::PlacedLine> lines;
    for (int i = 0; i < 2000; ++i)
        lines.push_back(line_of({{10, 10}, {90, 80}}, i));
    const LineIndex index = make_line_index(lines, options(100));
    EXPECT_GT(index.dropped, 0U);
    EXPECT_NEAR(Reader(index).find({50, 45.5}, 1).posts, brute_force(lines, {50, 45.5}).posts,
                1e-3);
}

}  // namespace
}  // namespace relevo::render::test_line_index
