// Houses, streets and trees in the heights of a surface model.
#include <algorithm>
#include <cmath>

#include "dem/load.h"
#include "dem/surface.h"
#include "support/support.h"

namespace relevo::dem::test_surface {
namespace {

using Kind = SurfaceKind;

constexpr int kSide = 200;

/// Posts 2 m apart, north up.
Grid grid_of(const Array2d<float>& h, double apart_m = 2) {
    return {h.width(),
            h.height(),
            {500000, apart_m, 0, 5600000, 0, -apart_m},
            geo::Crs::parse("EPSG:32632", "test")};
}

/// A slope of 1 in 20.
Array2d<float> slope() {
    Array2d<float> h(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            h.at(x, y) = static_cast<float>(100 + 0.1 * x);
    return h;
}

/// Rows of houses of 10 x 20 m with ridges, 10 m above the ground, every 24 m.
void add_town(Array2d<float>& h, int from, int end) {
    for (int top = from; top + 12 <= end; top += 12)
        for (int left = from; left + 16 <= end; left += 16) {
            const float foot = h.at(left, top);
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 10; ++x)
                    h.at(left + x, top + y) = foot + 10 - static_cast<float>(std::abs(y - 2));
        }
}

/// Crowns of 8 to 14 m, as high as wide.
void add_wood(Array2d<float>& h, int from, int end) {
    const Array2d<float> ground = h;
    for (int i = 0; i < (end - from) * (end - from) / 12; ++i) {
        const int x0 = from + i * 7919 % (end - from), y0 = from + i * 104729 / 31 % (end - from);
        const double radius = 2 + i * 31 % 17 / 10.0, high_m = 9 + i * 53 % 80 / 10.0;
        for (int y = std::max(y0 - 4, 0); y < std::min(y0 + 5, kSide); ++y)
            for (int x = std::max(x0 - 4, 0); x < std::min(x0 + 5, kSide); ++x) {
                const double off = std::hypot(x - x0, y - y0) / radius;
                if (off >= 1) continue;
                const auto top = static_cast<float>(high_m * std::sqrt(1 - off * off));
                h.at(x, y) = std::max(h.at(x, y), ground.at(x, y) + top);
            }
    }
}

/// Share of the posts of a window.
double share(const Surface& found, Kind kind, int from, int end) {
    int count = 0;
    for (int y = from; y < end; ++y)
        for (int x = from; x < end; ++x)
            count += found.kind.at(x, y) == kind ? 1 : 0;
    return count / std::pow(end - from, 2);
}

double built(const Surface& found, int from, int end) {
    return share(found, Kind::Roof, from, end) + share(found, Kind::Wall, from, end);
}

TEST(Surface, TellsHousesAndStreetsFromGround) {
    Array2d<float> h = slope();
    add_town(h, 40, 160);
    const Surface found = find_surface(h, grid_of(h));
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 10; ++x)
            EXPECT_TRUE(found.kind.at(88 + x, 88 + y) == Kind::Roof ||
                        found.kind.at(88 + x, 88 + y) == Kind::Wall)
                << x << ' ' << y;
    EXPECT_EQ(found.house.at(89, 89), found.house.at(96, 91)) << "one number a house";
    EXPECT_NE(found.house.at(89, 89), found.house.at(89 + 16, 89));
    EXPECT_EQ(found.kind.at(93, 96), Kind::Street);
    EXPECT_EQ(found.house.at(93, 96), 0);
    EXPECT_EQ(found.kind.at(5, 5), Kind::Ground);
    EXPECT_EQ(found.kind.at(190, 190), Kind::Ground);
    EXPECT_TRUE(looks_like_surface(h, grid_of(h)));
}

TEST(Surface, CrownsAreNoRoofs) {
    Array2d<float> h = slope();
    add_wood(h, 40, 160);
    const Surface found = find_surface(h, grid_of(h));
    EXPECT_LT(built(found, 40, 160), 0.03);
    EXPECT_GT(share(found, Kind::Canopy, 50, 150), 0.5);
    EXPECT_EQ(share(found, Kind::Canopy, 0, 30), 0);
    EXPECT_FALSE(looks_like_surface(h, grid_of(h)));
}

TEST(Surface, HillsCliffsAndRidgesAreGround) {
    Array2d<float> h = slope();
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            if (x > 60)
                h.at(x, y) += 40 - 0.4F * static_cast<float>(std::min(x - 60, 100));  // a crag
            h.at(x, y) += 30 * std::exp(-static_cast<float>(std::hypot(x - 150, y - 100)) / 12);
            h.at(x, y) += 12 - std::min(static_cast<float>(std::abs(y - 170)), 12.0F);
        }
    const Surface found = find_surface(h, grid_of(h));
    EXPECT_EQ(built(found, 0, kSide), 0);
    EXPECT_LT(found.share[static_cast<std::size_t>(Kind::Canopy)], 0.005);
    EXPECT_FALSE(looks_like_surface(h, grid_of(h)));
}

TEST(Surface, PostsFarApartAndVoidsHaveNone) {
    Array2d<float> h = slope();
    add_town(h, 40, 160);
    EXPECT_FALSE(looks_like_surface(h, grid_of(h, 10)));
    for (int y = 60; y < 80; ++y)
        for (int x = 60; x < 80; ++x)
            h.at(x, y) = NAN;
    const Surface found = find_surface(h, grid_of(h));
    EXPECT_EQ(share(found, Kind::Ground, 61, 79), 1);
    EXPECT_EQ(built(found, 61, 79), 0);
    EXPECT_GT(built(found, 90, 140), 0.2);
}

TEST(Surface, OfEdinburghIsACityBesideAPark) {
    SKIP_WITHOUT_TEST_DATA(folder);
    const Heightfield field = load((folder / "dem/holyroodpark.tif").string());
    const Surface found = find_surface(field.height_m, field.grid);
    int city = 0, park = 0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            city += found.house.at(x, 440 + y) != 0 ? 1 : 0;
            park += found.house.at(300 + x, 300 + y) != 0 ? 1 : 0;
        }
    EXPECT_GT(city, 1500) << "the Southside";
    EXPECT_EQ(park, 0) << "Arthur's Seat with its crags";
    EXPECT_TRUE(looks_like_surface(field.height_m, field.grid));
}

}  // namespace
}  // namespace relevo::dem::test_surface
