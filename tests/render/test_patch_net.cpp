#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/grid.h"
#include "render/patch_net.h"
#include "support/support.h"

namespace relevo::render::test_patch_net {
namespace {

/// A geographic grid: `spacing_deg` from post to post, rows running south.
PostPlace degrees_grid(double lat_deg, double lon_deg, double spacing_deg) {
    return [=](double column, double row) {
        return geo::geodetic_deg(lat_deg - row * spacing_deg, lon_deg + column * spacing_deg);
    };
}

/// Worst distance [m] from the net to exact places of posts all over the piece, at a height.
double worst_error_m(const PostPlace& place, const geo::LocalFrame& frame, double side,
                     double height_m) {
    const PatchNet net = fit_patch_net(place, frame, {0, 0}, glm::dvec2(side));
    double worst = 0;
    for (int j = 0; j <= 32; ++j) {
        for (int i = 0; i <= 32; ++i) {
            const double u = i / 32.0, v = j / 32.0;
            geo::Geodetic exact = place(u * side, v * side);
            exact.height_m = height_m;
            worst = std::max(worst, distance(net.place(u, v, height_m), frame.to_local(exact)));
        }
    }
    return worst;
}

TEST(PatchNet, PlacesPostsWithinAHundredthOfTheirSpacing) {
    struct Case {
        const char* name;
        double lat_deg, spacing_deg;
        double posts;
    };
    for (const Case& c : {Case{"1 arcsec, 64 posts", 47, 1 / 3600.0, 64},
                          Case{"1 arcsec, 256 posts", 47, 1 / 3600.0, 256},
                          Case{"3 arcsec, 256 posts", 56, 1 / 1200.0, 256},
                          Case{"3 arcsec, 256 posts, 80 north", 80, 1 / 1200.0, 256},
                          Case{"30 arcsec, 64 posts", 30, 1 / 120.0, 64},
                          Case{"2 arcmin, 64 posts", 20, 1 / 30.0, 64}}) {
        const PostPlace place = degrees_grid(c.lat_deg, 11, c.spacing_deg);
        const double half = c.posts / 2 * c.spacing_deg;
        const geo::LocalFrame frame(geo::geodetic_deg(c.lat_deg - half, 11 + half));
        // Posts are nearest to each other along the parallel.
        const double spacing_m = 111e3 * c.spacing_deg * std::cos(radians(c.lat_deg));
        const double worst = worst_error_m(place, frame, c.posts, 4000);
        fmt::print("[ accuracy ] position net, {}: worst {:.3g} m, {:.2g} of the post spacing\n",
                   c.name, worst, worst / spacing_m);
        EXPECT_LT(worst, spacing_m / 100) << c.name;
    }
}

TEST(PatchNet, APiecePartlyBesideTheGlobeIsRightWhereItHasGround) {
    const PostPlace whole = degrees_grid(47, 11, 1 / 120.0);
    const geo::LocalFrame frame(geo::geodetic_deg(46.7, 11.3));
    // Four nodes, two, one, and none have a place.
    for (const glm::dvec2 last : {glm::dvec2(40, 40), glm::dvec2(20, 40), glm::dvec2(20, 20)}) {
        const PostPlace place = [&](double column, double row) {
            return column <= last.x && row <= last.y ? whole(column, row)
                                                     : geo::Geodetic{std::nan(""), std::nan(""), 0};
        };
        const PatchNet net = fit_patch_net(place, frame, {0, 0}, glm::dvec2(64));
        double worst_m = 0;
        for (double row = 0; row <= last.y; row += 4)
            for (double column = 0; column <= last.x; column += 4) {
                geo::Geodetic exact = whole(column, row);
                exact.height_m = 4000;
                worst_m = std::max(worst_m, distance(net.place(column / 64, row / 64, 4000),
                                                     frame.to_local(exact)));
            }
        fmt::print("[ accuracy ] position net, {} x {} of 64 x 64 posts on Earth: worst {:.3g} m\n",
                   last.x, last.y, worst_m);
        EXPECT_LT(worst_m, 6.5);  // of posts 650 m apart
    }
    const PatchNet nowhere = fit_patch_net(
        [](double, double) {
            return geo::Geodetic{std::nan(""), std::nan(""), 0};
        },
        frame, {0, 0}, glm::dvec2(64));
    EXPECT_TRUE(std::isfinite(nowhere.place(0.3, 0.7, 100).x));
}

TEST(PatchNet, NeighboursAgreeAlongTheirSharedSide) {
    const PostPlace place = degrees_grid(56, -5, 1 / 1200.0);
    const geo::LocalFrame frame(geo::geodetic_deg(55.5, -4.5));
    const PatchNet west = fit_patch_net(place, frame, {0, 0}, glm::dvec2(64));
    const PatchNet east = fit_patch_net(place, frame, {64, 0}, glm::dvec2(64));
    for (double v = 0; v <= 1; v += 0.125)
        EXPECT_LT(distance(west.place(1, v, 0), east.place(0, v, 0)), 1e-6);
}

TEST(PatchNet, FollowsTheCurveOfTheEarth) {
    // 200 km east of the origin the ellipsoid has dropped by about d^2 / 2R.
    const PostPlace place = degrees_grid(46, 10, 1 / 1200.0);
    const geo::LocalFrame frame(geo::geodetic_deg(46, 10));
    const PatchNet net = fit_patch_net(place, frame, {3000, 0}, glm::dvec2(256));
    const glm::dvec3 at = net.place(0, 0, 0);
    const double drop_m = at.x * at.x / 2 / 6388000;  // radius of the prime vertical at 46 N
    EXPECT_NEAR(at.z, -drop_m, 5);
    EXPECT_NEAR(at.z, frame.to_local(place(3000, 0)).z, 1);
}

/// Worst distance [m] of posts of a DEM from where they are, over pieces at its corners, the
/// middles of its sides and its centre.
/// @param piece  posts along a piece's side
double worst_over_dem_m(const dem::Grid& grid, double piece, double height_m) {
    const geo::LocalFrame frame(grid.center());
    double worst = 0;
    for (int k = 0; k < 9; ++k) {
        const glm::dvec2 first = (glm::dvec2(grid.columns(), grid.rows()) - 1.0 - piece) *
                                 glm::dvec2(k % 3, k / 3) / 2.0;
        const PostPlace place = [&](double column, double row) {
            return grid.place(first.x + column, first.y + row);
        };
        worst = std::max(worst, worst_error_m(place, frame, piece, height_m));
    }
    return worst;
}

struct DemCase {
    const char* name;
    const char* crs;
    double x, y, spacing;  ///< of the middle, from post to post; in the CRS's units
    int posts;             ///< along a side
};

double print_worst(const DemCase& c, double piece) {
    const double half = (c.posts - 1) / 2.0 * c.spacing;
    const dem::Grid grid(c.posts, c.posts, {c.x - half, c.spacing, 0, c.y + half, 0, -c.spacing},
                         geo::Crs::parse(c.crs, "test"));
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const double worst = worst_over_dem_m(grid, piece, 4000);
    const double share = worst / std::min(spacing_m.x, spacing_m.y);
    fmt::print(
        "[ accuracy ] position net, {}, {:.0f} km, pieces of {:.0f} posts: worst {:.2g} m, "
        "{:.2g} of the post spacing\n",
        c.name, grid.extent_m().y / 1000, piece, worst, share);
    return share;
}

TEST(PatchNet, PostsOfDemsUpTo100KmAreWithinAHundredthOfTheirSpacing) {
    for (const DemCase& c :
         {DemCase{"1 arcsec at the equator", "EPSG:4326", 6.5, 0, 1 / 3600.0, 3239},
          DemCase{"1 arcsec, 47 N", "EPSG:4326", 11, 47, 1 / 3600.0, 3239},
          DemCase{"1 arcsec, 80 N", "EPSG:4326", -64, 80, 1 / 3600.0, 3225},
          DemCase{"3 arcsec across the antimeridian", "EPSG:4326", 180, -17, 1 / 1200.0, 1085},
          DemCase{"UTM, 30 m", "EPSG:32632", 500000, 5200000, 30, 3334},
          DemCase{"UTM, 1 m", "EPSG:32632", 690000, 5200000, 1, 2001},
          DemCase{"Mercator, 60 N", "EPSG:3857", 1e6, 8.4e6, 76, 2600},
          DemCase{"polar stereographic over the pole", "EPSG:3413", 0, 0, 100, 1000},
          DemCase{"Lambert, feet", "EPSG:2229", 6.4e6, 1.9e6, 100, 3280}})
        EXPECT_LT(print_worst(c, 256), 0.01) << c.name;
}

// What is drawn coarse, with the posts of its level further apart, has larger pieces.
TEST(PatchNet, BoundForDemsOf1000KmAndAt80North) {
    EXPECT_LT(print_worst({"9 arcsec, 46 N", "EPSG:4326", 10, 46, 1 / 400.0, 3600}, 256), 0.01);
    EXPECT_LT(print_worst({"9 arcsec, 80 N", "EPSG:4326", -40, 80, 1 / 400.0, 3600}, 256), 0.01);
    EXPECT_LT(print_worst({"250 m, polar stereographic", "EPSG:3413", 0, -1.1e6, 250, 4000}, 256),
              0.01);
    EXPECT_LT(print_worst({"250 m, UTM", "EPSG:32632", 500000, 5200000, 250, 4000}, 256), 0.01);
}

/// Metres up of a place as seen from another, written out: geocentric coordinates (IOGP guidance
/// note 7-2, section 4.1.1) onto the vertical of the origin.
double up_m(const geo::Geodetic& origin, const geo::Geodetic& place) {
    const auto geocentric = [](const geo::Geodetic& g) {
        constexpr double kA = 6378137, kF = 1 / 298.257223563, kE2 = kF * (2 - kF);
        const double n = kA / std::sqrt(1 - kE2 * std::pow(std::sin(g.lat_rad), 2));
        return glm::dvec3(std::cos(g.lat_rad) * std::cos(g.lon_rad) * (n + g.height_m),
                          std::cos(g.lat_rad) * std::sin(g.lon_rad) * (n + g.height_m),
                          std::sin(g.lat_rad) * (n * (1 - kE2) + g.height_m));
    };
    const glm::dvec3 up(std::cos(origin.lat_rad) * std::cos(origin.lon_rad),
                        std::cos(origin.lat_rad) * std::sin(origin.lon_rad),
                        std::sin(origin.lat_rad));
    return dot(up, geocentric(place) - geocentric(origin));
}

TEST(PatchNet, ADemOf200KmShowsTheCurveOfTheEarthWithinAMetre) {
    const dem::Grid grid(2400, 2161, {10, 1 / 1200.0, 0, 46.9, 0, -1 / 1200.0}, geo::Crs());
    EXPECT_GT(grid.extent_m().y, 199'000);
    const geo::LocalFrame frame(grid.center());
    const PostPlace place = [&](double column, double row) { return grid.place(column, row); };
    double worst_m = 0, lowest_m = 0;
    for (int first_row = 0; first_row < 2160; first_row += 240)
        for (int first_column = 0; first_column < 2400; first_column += 240) {
            const PatchNet net =
                fit_patch_net(place, frame, {first_column, first_row}, glm::dvec2(240));
            for (const glm::dvec2 at : {glm::dvec2(0, 0), glm::dvec2(0.3, 0.8), glm::dvec2(1, 1)}) {
                const geo::Geodetic post =
                    grid.place(first_column + 240 * at.x, first_row + 240 * at.y);
                const double z_m = net.place(at.x, at.y, 0).z;
                worst_m = std::max(worst_m, std::abs(z_m - up_m(grid.center(), post)));
                lowest_m = std::min(lowest_m, z_m);
            }
        }
    fmt::print(
        "[ accuracy ] curve of the Earth over 200 km: corners {:.1f} m down, worst {:.2g} m "
        "(limit 1)\n",
        -lowest_m, worst_m);
    EXPECT_LT(worst_m, 1);
    EXPECT_LT(lowest_m, -1200);  // (100^2 + 79^2) km^2 / 2 R
}

}  // namespace
}  // namespace relevo::render::test_patch_net
