// Names and symbols in a picture: none overlaps another, and the first points have the room.
#include <chrono>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "chart/marks.h"

namespace relevo::chart {
namespace {

constexpr Rect kPicture{0, 0, 1000, 700};

/// Points all over the picture and around it, with names of 0 to 30 letters.
struct Points {
    std::vector<std::string> names;
    std::vector<MarkPoint> points;

    explicit Points(int count, unsigned seed = 1) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> x(-50, 1050), y(-50, 750);
        std::uniform_int_distribution<std::size_t> length(0, 30);
        for (int i = 0; i < count; ++i)
            names.push_back(std::string(length(random), "abcdefg"[i % 7]));
        for (int i = 0; i < count; ++i)
            points.push_back({{x(random), y(random)}, names[static_cast<std::size_t>(i)]});
    }
    std::vector<PlacedMark> place(const MarkStyle& style) const {
        FreeRoom room(kPicture);
        return place_marks(points, style, room);
    }
};

/// How far apart two rectangles are along the axis on which they are further apart; negative if
/// they overlap.
double apart(const Rect& a, const Rect& b) {
    return std::max(
        {a.x - b.x - b.width, b.x - a.x - a.width, a.y - b.y - b.height, b.y - a.y - a.height});
}

std::vector<Rect> parts(const PlacedMark& mark) {
    std::vector<Rect> all;
    if (mark.box.width > 0) all.push_back(mark.box);
    if (mark.symbol.width > 0) all.push_back(mark.symbol);
    if (mark.leader_top < mark.at.y)
        all.push_back({mark.at.x, mark.leader_top, 0.1, mark.at.y - mark.leader_top});
    return all;
}

TEST(Marks, NeverOverlap) {
    for (const double leader : {0.0, 20.0})
        for (const Symbol symbol : {Symbol::None, Symbol::Dot, Symbol::Triangle})
            for (const double distance : {0.0, 4.0, 30.0}) {
                const MarkStyle style{
                    .symbol = symbol, .leader = leader, .distance = distance, .most = 2000};
                const std::vector<PlacedMark> placed = Points(3000).place(style);
                EXPECT_GT(placed.size(), 20u);
                double least = 1e9;
                for (std::size_t i = 0; i < placed.size(); ++i)
                    for (std::size_t j = 0; j < i; ++j)
                        for (const Rect& a : parts(placed[i]))
                            for (const Rect& b : parts(placed[j]))
                                least = std::min(least, apart(a, b));
                EXPECT_GE(least, distance - 1e-9) << leader << ' ' << distance;
                for (const PlacedMark& mark : placed)
                    for (const Rect& a : parts(mark)) {
                        EXPECT_GE(a.x, 0);
                        EXPECT_GE(a.y, 0);
                        EXPECT_LE(a.x + a.width, kPicture.width);
                        EXPECT_LE(a.y + a.height, kPicture.height);
                    }
            }
}

TEST(Marks, TheFirstHaveTheRoom) {
    const std::vector<MarkPoint> points{{{500, 300}, "first"}, {{502, 301}, "second"}};
    FreeRoom room(kPicture);
    const std::vector<PlacedMark> placed = place_marks(points, {}, room);
    ASSERT_EQ(placed.size(), 1u);
    EXPECT_EQ(placed[0].words, "first");
    // And of another list none where they are.
    EXPECT_TRUE(place_marks(points, {}, room).empty());
    const MarkStyle few{.most = 7};
    const std::vector<PlacedMark> some = Points(500).place(few), all = Points(500).place({});
    ASSERT_EQ(some.size(), 7u);
    for (std::size_t i = 0; i < some.size(); ++i)
        EXPECT_EQ(some[i].index, all[i].index);
}

TEST(Marks, AreTheSameEveryTimeAndNearlyTheSameAStepOn) {
    const MarkStyle style{.symbol = Symbol::Triangle, .leader = 20};
    Points points(400);
    const std::vector<PlacedMark> before = points.place(style);
    const std::vector<PlacedMark> again = points.place(style);
    ASSERT_EQ(before.size(), again.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(before[i].baseline, again[i].baseline);
    // The camera turns: all move by nearly the same way.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.1, 0.1);
    for (MarkPoint& point : points.points)
        point.at += glm::dvec2(1 + jitter(random), jitter(random));
    const std::vector<PlacedMark> after = points.place(style);
    std::size_t stayed = 0;
    for (const PlacedMark& mark : after)
        for (const PlacedMark& other : before)
            stayed += mark.index == other.index &&
                      length(mark.baseline - other.baseline - glm::dvec2(1, 0)) < 1;
    fmt::print("[ marks ] {} of {} stay where they are from a pixel to the next\n", stayed,
               before.size());
    EXPECT_GT(static_cast<double>(stayed), 0.85 * static_cast<double>(before.size()));
}

TEST(Marks, OfAMillionTakeBoundedTime) {
    const Points points(1'000'000);
    const auto began = std::chrono::steady_clock::now();
    const MarkStyle style{.symbol = Symbol::Triangle, .leader = 20, .most = 2000};
    const std::size_t placed = points.place(style).size();
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    fmt::print("[ marks ] {} of 1 000 000 placed in {:.3f} s\n", placed, took_s);
    EXPECT_GT(placed, 100u);
    EXPECT_LT(took_s, 2);
}

TEST(Marks, NamesOfAnyLettersAreDrawn) {
    const std::vector<std::string> names{
        "Großglockner",
        "\xd7\x94\xd7\xa8 \xd7\x9e\xd7\x99\xd7\xa8\xd7\x95\xd7\x9f",  // Hebrew
        "\xe5\xaf\x8c\xe5\xa3\xab\xe5\xb1\xb1",                       // Japanese
        "\xf0\x9f\x8f\x94",
        std::string(10'000, 'x'),
        "a\nb\x01",
        "broken \xff\xfe"};
    for (const std::string& name : names)
        for (const double leader : {0.0, 20.0}) {
            FreeRoom room(kPicture);
            const std::vector<MarkPoint> points{{{500, 300}, name}};
            const MarkStyle style{.leader = leader};
            const std::vector<PlacedMark> placed = place_marks(points, style, room);
            ASSERT_EQ(placed.size(), 1u) << name;
            EXPECT_LT(placed[0].box.width, 26 * style.size);
            Drawing drawing(kPicture.width, kPicture.height);
            draw_marks(placed, style, drawing);
            const image::Image8 image = to_transparent_image(drawing);
            // Nothing is outside of the boxes that are kept free.
            double outside = 0, inside = 0;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    if (image.at(x, y, 3) < 16) continue;
                    bool in = false;
                    for (const Rect& part : parts(placed[0]))
                        in = in || apart(part, {x + 0.5, y + 0.5, 0, 0}) < 2;
                    (in ? inside : outside) += 1;
                }
            EXPECT_GT(inside, 20) << name;
            if (name == names[0]) {
                EXPECT_EQ(outside, 0);
            }
        }
}

TEST(Marks, TurnedNamesAreCentredAndInsideTheirBoxes) {
    for (const double turn_deg : {-90.0, -45.0, 0.0, 20.0, 90.0}) {
        FreeRoom room(kPicture);
        const std::vector<MarkPoint> points{{{500, 300}, "1200 m", {}, turn_deg}};
        // A symbol and a leader are those of upright names.
        const MarkStyle style{.size = 24, .symbol = Symbol::Dot, .leader = 20};
        const std::vector<PlacedMark> placed = place_marks(points, style, room);
        ASSERT_EQ(placed.size(), 1u);
        EXPECT_EQ(placed[0].symbol.width, 0);
        EXPECT_EQ(placed[0].leader_top, 300);
        Drawing drawing(kPicture.width, kPicture.height);
        draw_marks(placed, style, drawing);
        const image::Image8 image = to_transparent_image(drawing);
        glm::dvec2 sum(0);
        double count = 0, outside = 0, along = 0;
        const double turn = turn_deg * 3.14159265358979 / 180;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.at(x, y, 3) < 16) continue;
                const glm::dvec2 at(x + 0.5, y + 0.5);
                sum += at;
                count += 1;
                outside += apart(placed[0].box, {at.x, at.y, 0, 0}) > 1 ? 1 : 0;
                along = std::max(
                    along, std::abs(dot(at - points[0].at, {std::cos(turn), std::sin(turn)})));
            }
        EXPECT_EQ(outside, 0) << turn_deg;
        EXPECT_LT(distance(sum / count, points[0].at), 2.5) << turn_deg;
        // The words run along the direction.
        EXPECT_NEAR(along, 0.5 * text_width("1200 m", style.size) + 0.15 * style.size, 3)
            << turn_deg;
    }
}

TEST(Marks, OfTheSameNameAreApart) {
    std::vector<MarkPoint> points;
    for (int i = 0; i < 400; ++i)
        points.push_back(
            {{20 + 48 * (i % 20), 20 + 33 * (i / 20)}, i % 2 == 0 ? "500 m" : "600 m"});
    FreeRoom room(kPicture);
    const std::vector<PlacedMark> placed =
        place_marks(points, {.size = 8, .symbol = Symbol::None, .repeat = 200}, room);
    double least = 1e9, least_of_others = 1e9;
    for (const PlacedMark& a : placed)
        for (const PlacedMark& b : placed) {
            if (a.index == b.index) continue;
            double& of = a.words == b.words ? least : least_of_others;
            of = std::min(of, distance(a.at, b.at));
        }
    EXPECT_GE(placed.size(), 16u);
    EXPECT_GE(least, 200);
    EXPECT_LT(least_of_others, 100);
}

TEST(Marks, HaveTheirOwnSymbols) {
    const std::vector<MarkPoint> points{{{100, 100}, "list's"},
                                        {{300, 100}, "own", Symbol::Triangle},
                                        {{500, 100}, "none", Symbol::None}};
    FreeRoom room(kPicture);
    const std::vector<PlacedMark> placed = place_marks(points, {.symbol = Symbol::Dot}, room);
    ASSERT_EQ(placed.size(), 3u);
    EXPECT_EQ(placed[0].kind, Symbol::Dot);
    EXPECT_EQ(placed[1].kind, Symbol::Triangle);
    EXPECT_EQ(placed[2].symbol.width, 0);
}

TEST(Marks, WithoutAPictureThereIsNoRoom) {
    FreeRoom room({0, 0, 0, 0});
    const std::vector<MarkPoint> points{{{0, 0}, "a"}, {{std::nan(""), 3}, "b"}};
    EXPECT_TRUE(place_marks(points, {}, room).empty());
    FreeRoom picture(kPicture);
    EXPECT_EQ(place_marks(points, {}, picture).size(), 0u);
}

}  // namespace
}  // namespace relevo::chart
